// Runs the unchanged examples of the READMEs and of apps/examples in a project that has installed the package. Provides a
// document and fetch for files, which pages have and Node lacks, with an image of the demo clip and a tenth of a second of
// its audio.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {copyFileSync, cpSync, mkdtempSync, rmSync, symlinkSync, writeFileSync} from 'node:fs';
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

const codeBlocks = (...page) => execFileSync(join(root, 'tests/docs/code_blocks.py'), page, {encoding: 'utf8'});

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
  writeFileSync(join(project, 'example.mjs'), page + codeBlocks('bindings/js/README.md', 'js'));
  const said = execFileSync(process.execPath, ['example.mjs'], {cwd: project, encoding: 'utf8'});
  assert.match(said, /^tracking jawOpen [01](\.\d+)?(e-\d+)? -?\d/);
});

test('the example of the repository tracks the face of an image in Node', () => {
  decode('face.rgba', '-frames:v', '1', '-pix_fmt', 'rgba', '-f', 'rawvideo');
  writeFileSync(join(project, 'repository.mjs'), codeBlocks('README.md', 'js'));
  const said = execFileSync(process.execPath, ['repository.mjs'], {cwd: project, encoding: 'utf8'});
  assert.match(said, /^tracking jawOpen [01](\.\d+)?(e-\d+)?\n$/);
});

test('apps/examples tracks an image, and rejects other files', () => {
  decode('face.ppm', '-ss', '4', '-frames:v', '1');
  copyFileSync(join(root, 'apps/examples/js/jaw_open.mjs'), join(project, 'jaw_open.mjs'));
  const run = file => execFileSync(process.execPath, ['jaw_open.mjs', file], {cwd: project, encoding: 'utf8', stdio: 'pipe'});
  const [, value] = run('face.ppm').match(/^jawOpen (\d\.\d\d)\n$/);
  assert.ok(value > 0.2, value);
  assert.throws(() => run('jaw_open.mjs'), /not a binary PPM/);
});
