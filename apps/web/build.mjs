// Builds the page in dist/: node build.mjs WASM_FILE
import {createHash} from 'node:crypto';
import {cp, mkdir, readFile, readdir, rm, stat, writeFile} from 'node:fs/promises';
import {bundled} from './bundle.mjs';
import {writeDecoders} from './decoders.mjs';

const here = new URL('.', import.meta.url).pathname, root = new URL('../..', import.meta.url).pathname;
const out = here + 'dist/';
const wasm = process.argv[2] ?? root + 'build/wasm-page/tracker/mien.wasm';
const plain = ['index.html', 'theme.css', 'style.css', 'icon.svg', 'manifest.webmanifest'];

async function bundle(entries, options = {}) {
  for (const {path, text} of await bundled(entries, {outdir: out, format: 'esm', ...options})) await writeFile(path, text);
}

async function listFiles(folder, prefix = '') {
  const entries = await readdir(folder, {withFileTypes: true});
  const lists = entries.map(entry => (entry.isDirectory() ? listFiles(`${folder}${entry.name}/`, `${prefix}${entry.name}/`) : [prefix + entry.name]));
  return (await Promise.all(lists)).flat().sort();
}

async function licences() {
  const names = ['three', '@pixiv/three-vrm'];
  const texts = names.map(async name => `${name}\n\n${await readFile(`${here}node_modules/${name}/LICENSE`, 'utf8')}`);
  const decoders = `Draco, Basis Universal (decoders)\n\n${await readFile(root + 'LICENSE', 'utf8')}`;
  return [...await Promise.all(texts), decoders].join('\n\n');
}

const onDemand = file => file.startsWith('decoders/');

await rm(out, {recursive: true, force: true});
await mkdir(out + 'models', {recursive: true});
await bundle(['src/page.js'], {splitting: true, chunkNames: 'part-[hash]'});
await bundle(['src/tracking/worker.js', '../../bindings/js/mien-worklet.js'], {entryNames: '[name]'});
for (const file of plain) await cp(here + file, out + file);
for (const name of ['basenet', 'proposal', 'hifinet', 'audionet']) await cp(`${root}models/${name}.mien`, `${out}models/${name}.mien`);
await cp(wasm, out + 'mien.wasm');
await writeDecoders(out + 'decoders/');
await writeFile(out + 'licences.txt', await licences());

const files = await listFiles(out), hash = createHash('sha256');
for (const file of files) hash.update(file).update(await readFile(out + file));
await bundle(['src/service_worker.js'], {
  format: 'iife', entryNames: '[name]',
  define: {FILES: JSON.stringify(['./', ...files.filter(file => file !== 'index.html' && !onDemand(file))]), VERSION: JSON.stringify(hash.digest('hex').slice(0, 16))}});

const size = async names => (await Promise.all(names.map(async name => (await stat(out + name)).size))).reduce((a, b) => a + b, 0);
const all = await listFiles(out);
console.log(`${out}: ${await size(all.filter(file => !onDemand(file)))} bytes, and ${await size(all.filter(onDemand))} of decoders that some avatars need`);
