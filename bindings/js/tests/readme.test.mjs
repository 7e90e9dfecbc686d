// Runs the examples for Node of the READMEs and of apps/examples in a project that has installed the package.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {copyFileSync, cpSync, mkdtempSync, openSync, rmSync, symlinkSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, test} from 'node:test';
import {fileURLToPath} from 'node:url';

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

install();
decode('face.rgba', '-frames:v', '1', '-pix_fmt', 'rgba', '-f', 'rawvideo');
const codeBlocks = (...page) => execFileSync(join(root, 'tests/docs/code_blocks.py'), page, {encoding: 'utf8'});

for (const [page, ...block] of [['README.md', 'js', '1'], ['bindings/js/README.md', 'js', '2']]) {
  test(`the example of ${page} tracks the face of an image`, () => {
    writeFileSync(join(project, 'example.mjs'), codeBlocks(page, ...block));
    const output = execFileSync(process.execPath, ['example.mjs'], {cwd: project, encoding: 'utf8', stdio: [openSync(join(project, 'face.rgba')), 'pipe', 'inherit']});
    assert.match(output, /^tracking jawOpen [01](\.\d+)?(e-\d+)?( -?\d\S*)?\n$/);
  });
}

test('apps/examples tracks an image, and rejects other files', () => {
  decode('face.ppm', '-ss', '4', '-frames:v', '1');
  copyFileSync(join(root, 'apps/examples/js/jaw_open.mjs'), join(project, 'jaw_open.mjs'));
  const run = file => execFileSync(process.execPath, ['jaw_open.mjs', file], {cwd: project, encoding: 'utf8', stdio: 'pipe'});
  const [, value] = run('face.ppm').match(/^jawOpen (\d\.\d\d)\n$/);
  assert.ok(value > 0.2, value);
  assert.throws(() => run('jaw_open.mjs'), /not a binary PPM/);
});
