// Writes the workers that decode Draco and KTX2: three's code for workers after that of the decoders. Three itself starts them from text,
// which the page's policy forbids.
import {cp, mkdir, readFile, writeFile} from 'node:fs/promises';
import {KTX2Loader} from 'three/examples/jsm/loaders/KTX2Loader.js';

const jsm = new URL('node_modules/three/examples/jsm/', import.meta.url);
const read = name => readFile(new URL(name, jsm), 'utf8');

async function dracoWorker() {
  const [, body] = (await read('loaders/DRACOLoader.js')).match(/\nfunction DRACOWorker\(\) \{\n(.*?)\n\}\n/s);
  return `${await read('libs/draco/gltf/draco_wasm_wrapper.js')}\n${body}`;
}

async function ktx2Worker() {
  const constants = ['EngineFormat', 'EngineType', 'TranscoderFormat', 'BasisFormat'].map(name => `const _${name} = ${JSON.stringify(KTX2Loader[name])};`);
  const [, body] = KTX2Loader.BasisWorker.toString().match(/\{(.*)\}/s);
  return [...constants, await read('libs/basis/basis_transcoder.js'), body].join('\n');
}

export async function writeDecoders(folder) {
  await mkdir(folder, {recursive: true});
  await writeFile(folder + 'draco_worker.js', await dracoWorker());
  await writeFile(folder + 'ktx2_worker.js', await ktx2Worker());
  for (const wasm of ['libs/draco/gltf/draco_decoder.wasm', 'libs/basis/basis_transcoder.wasm']) await cp(new URL(wasm, jsm), folder + wasm.split('/').at(-1));
}
