// Runs the unchanged example of the README in a project that has installed the package. Provides a document and fetch
// for files, which pages have and Node lacks, with an image of the demo clip and a tenth of a second of its audio.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {copyFileSync, cpSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, test} from 'node:test';
import {fileURLToPath, pathToFileURL} from 'node:url';

const root = fileURLToPath(new URL('../../../', import.meta.url));
const project = mkdtempSync(join(tmpdir(), 'mien-'));
after(() => rmSync(project, {recursive: true}));

function install() {
  const installed = join(project, 'node_modules/mien');
  cpSync(join(root, 'bindings/js'), installed, {recursive: true});
  copyFileSync(process.env.MIEN_WASM ?? join(root, 'build/wasm/tracker/mien.wasm'), join(installed, 'mien.wasm'));
  symlinkSync(join(root, 'models'), join(installed, 'models'));
}

function decode(file, ...options) {
  execFileSync('ffmpeg', ['-v', 'error', '-i', join(root, 'tests/data/demo.mp4'), ...options, join(project, file)]);
}

const page = `import {readFileSync} from 'node:fs';
globalThis.document = {baseURI: '${pathToFileURL(project)}/'};
globalThis.fetch = async url => new Response(readFileSync(url));
const imageData = {width: 640, height: 480, data: new Uint8ClampedArray(readFileSync('frame.rgba'))};
const samples = new Float32Array(new Uint8Array(readFileSync('sound.f32')).buffer), timeNs = 0;
`;

test('the example tracks the face of an image', () => {
  install();
  decode('frame.rgba', '-frames:v', '1', '-pix_fmt', 'rgba', '-f', 'rawvideo');
  decode('sound.f32', '-vn', '-t', '0.1', '-f', 'f32le', '-ac', '1', '-ar', '48000');
  const [, example] = readFileSync(join(root, 'bindings/js/README.md'), 'utf8').match(/```js\n([^]*?)```/);
  writeFileSync(join(project, 'example.mjs'), page + example);
  const said = execFileSync(process.execPath, ['example.mjs'], {cwd: project, encoding: 'utf8'});
  assert.match(said, /^tracking jawOpen [01](\.\d+)?(e-\d+)? -?\d/);
});

test('the example of the repository tracks the face of an image in Node', () => {
  decode('face.rgba', '-frames:v', '1', '-pix_fmt', 'rgba', '-f', 'rawvideo');
  const [, example] = readFileSync(join(root, 'README.md'), 'utf8').match(/```js\n([^]*?)```/);
  writeFileSync(join(project, 'repository.mjs'), example);
  const said = execFileSync(process.execPath, ['repository.mjs'], {cwd: project, encoding: 'utf8'});
  assert.match(said, /^tracking jawOpen [01](\.\d+)?(e-\d+)?\n$/);
});
