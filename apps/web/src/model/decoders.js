// Decodes Draco and KTX2 with decoders that are fetched when a file needs them.
import {DRACOLoader} from 'three/examples/jsm/loaders/DRACOLoader.js';
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

export const makeDecoders = renderer => ({meshes: new Meshes(), textures: new Textures().detectSupport(renderer)});
