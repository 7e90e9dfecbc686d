// Loads GLB and VRM files, also with meshopt, and with Draco and KTX2 where their decoders are available.
import {VRMLoaderPlugin} from '@pixiv/three-vrm';
import {MeshoptDecoder} from 'three/examples/jsm/libs/meshopt_decoder.module.js';
import {GLTFLoader} from 'three/examples/jsm/loaders/GLTFLoader.js';

const compressions = {KHR_draco_mesh_compression: 'Draco', KHR_texture_basisu: 'KTX2'};

function requireNoDecoder(bytes) {
  const text = new TextDecoder().decode(new Uint8Array(bytes, 20, new DataView(bytes).getUint32(12, true)));
  const {extensionsRequired = []} = JSON.parse(text), found = extensionsRequired.find(name => name in compressions);
  if (found) throw new Error(`compressed with ${compressions[found]}, whose decoder is too large for this page; mien's web page shows the file`);
}

/** `makeDecoders`: of decoders.js; undefined: without decoders. */
export async function loadModel(bytes, renderer, makeDecoders) {
  const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder), decoders = makeDecoders?.(renderer);
  if (decoders) loader.setDRACOLoader(decoders.meshes).setKTX2Loader(decoders.textures);
  else requireNoDecoder(bytes);
  loader.register(parser => new VRMLoaderPlugin(parser));
  try {
    return await loader.parseAsync(bytes, '');
  } finally {
    for (const each of Object.values(decoders ?? {})) each.dispose();
  }
}
