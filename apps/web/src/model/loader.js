// Loads GLB and VRM files, also with meshopt, Draco and KTX2, whose decoders are fetched when a file needs them.
import {VRMLoaderPlugin} from '@pixiv/three-vrm';
import {MeshoptDecoder} from 'three/examples/jsm/libs/meshopt_decoder.module.js';
import {DRACOLoader} from 'three/examples/jsm/loaders/DRACOLoader.js';
import {GLTFLoader} from 'three/examples/jsm/loaders/GLTFLoader.js';
import {KTX2Loader} from 'three/examples/jsm/loaders/KTX2Loader.js';

const decoder = name => new URL(`decoders/${name}`, document.baseURI);

async function bytesOf(name) {
  const response = await fetch(decoder(name));
  if (!response.ok) throw new Error(`${name}: ${response.status}`);
  return response.arrayBuffer();
}

// Both start workers of files (decoders.mjs) instead of text.
class Meshes extends DRACOLoader {
  _initDecoder() {
    this.workerSourceURL = decoder('draco_worker.js').href;
    this.decoderPending ??= bytesOf('draco_decoder.wasm').then(wasmBinary => { this.decoderConfig.wasmBinary = wasmBinary; });
    return this.decoderPending;
  }
}

class Textures extends KTX2Loader {
  init() {
    this.transcoderPending ??= bytesOf('basis_transcoder.wasm').then(transcoderBinary => this.workerPool.setWorkerCreator(() => {
      const worker = new Worker(decoder('ktx2_worker.js'));
      worker.postMessage({type: 'init', config: this.workerConfig, transcoderBinary});
      return worker;
    }));
    return this.transcoderPending;
  }
}

export async function loadModel(bytes, renderer) {
  const meshes = new Meshes(), textures = new Textures().detectSupport(renderer);
  try {
    const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder).setDRACOLoader(meshes).setKTX2Loader(textures);
    loader.register(parser => new VRMLoaderPlugin(parser));
    return await loader.parseAsync(bytes, '');
  } finally {
    for (const each of [meshes, textures]) each.dispose();
  }
}
