// The example of bindings/js/README.md in a new project: builds of Vite, webpack and esbuild, and Vite's development server, in Chromium.
// Also builds the example in React, with its types.
import assert from 'node:assert/strict';
import {execFileSync, spawn, spawnSync} from 'node:child_process';
import {cpSync, mkdirSync, mkdtempSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {serve} from '../serve.mjs';
import {executable} from './browser.mjs';
import {pack, root} from './package.mjs';
import {openStudio, until} from './page.mjs';

const folder = mkdtempSync(join(tmpdir(), 'mien-')), project = join(folder, 'project');
const run = (command, options = {}) => execFileSync('bash', ['-c', command], {cwd: project, encoding: 'utf8', stdio: 'pipe', ...options});
const codeBlocks = (...page) => execFileSync(join(root, 'tests/docs/code_blocks.py'), page, {encoding: 'utf8'});
const quiet = '--ignore-scripts --no-audit --no-fund --loglevel=error';
const builds = codeBlocks('bindings/js/README.md', 'sh').trim().split('\n').filter(line => line.startsWith('npx '));
const [major, minor] = process.versions.node.split('.').map(Number);
const missing = [spawnSync('npm', ['--version']).error && 'npm', !executable && 'Chromium', major + minor / 100 < 20.19 && 'Node 20.19 for Vite'].filter(Boolean);
const options = {skip: missing.length > 0 && `NOT TESTED: needs ${missing.join(', ')}`};
let studio;

before(async () => {
  if (options.skip) return;
  for (const path of [project, join(folder, 'package')]) mkdirSync(path);
  for (const name of ['package.json', 'package-lock.json']) cpSync(join(root, 'apps/web/tests/bundlers', name), join(project, name));
  run(`npm ci ${quiet} && npm install --offline ${quiet} ${pack(join(folder, 'package'))}`);
  writeFileSync(join(project, 'index.html'), codeBlocks('bindings/js/README.md', 'html', '1'));
  writeFileSync(join(project, 'main.js'), codeBlocks('bindings/js/README.md', 'js', '1'));
  studio = await openStudio(project);
});
after(async () => {
  await studio?.close();
  rmSync(folder, {recursive: true});
});

async function checkPage(url) {
  const page = await studio.browser.newPage(), errors = [];
  page.on('pageerror', error => errors.push(error.message));
  page.on('response', response => response.status() >= 400 && !response.url().endsWith('favicon.ico') && errors.push(`${response.status()} ${response.url()}`));
  await page.goto(url);
  await page.click('button');
  const shown = condition => until(page, condition, 30, 'output').catch(error => assert.fail(`${error.message} ${errors}`));
  await shown(() => document.querySelector('output').value === 'tracking');
  await shown(() => document.querySelector('meter').value > 0.2);
  assert.deepEqual(errors, []);
  await page.close();
}

async function checkBuild(command, cwd = project) {
  rmSync(join(cwd, 'dist'), {recursive: true, force: true});
  run(command, {cwd});
  const {server, url} = await serve(join(cwd, 'dist'));
  try {
    await checkPage(url);
  } finally {
    server.close();
  }
}

for (const build of builds) test(build, options, () => checkBuild(build));

test('Vite, webpack and esbuild are tested', () => {
  assert.deepEqual(builds.map(build => build.split(' ')[1]), ['vite', 'webpack', 'esbuild']);
});

test("Vite's development server", options, async () => {
  const server = spawn(process.execPath, ['node_modules/vite/bin/vite.js', '--host', '127.0.0.1', '--port', '0'], {cwd: project, env: {...process.env, NO_COLOR: '1'}});
  try {
    const url = await new Promise((done, failed) => {
      server.stdout.on('data', text => /http:\S+/.test(text) && done(String(text).match(/http:\S+/)[0]));
      server.on('exit', code => failed(new Error(`vite ended with ${code}`)));
    });
    await checkPage(url.replace('127.0.0.1', 'localhost'));
  } finally {
    server.kill();
  }
});

// The content of Vite's template for React.
const template = {
  'index.html': '<!doctype html><div id="root"></div><script type="module" src="/main.tsx"></script>',
  'main.tsx': `import {StrictMode} from 'react';
import {createRoot} from 'react-dom/client';
import App from './App.tsx';
createRoot(document.getElementById('root')!).render(<StrictMode><App /></StrictMode>);`,
  'vite.config.js': `import react from '@vitejs/plugin-react';
export default {plugins: [react()]};`,
  'tsconfig.json': `{"compilerOptions": {"target": "es2023", "module": "esnext", "moduleResolution": "bundler", "jsx": "react-jsx", "strict": true, "noEmit": true,
  "allowImportingTsExtensions": true, "noUnusedLocals": true, "types": []}, "include": ["*.tsx"]}`,
};

test('the example in React has correct types, and tracks', options, async () => {
  const cwd = join(project, 'react');
  cpSync(join(root, 'apps/examples/js/react'), cwd, {recursive: true});
  for (const [name, text] of Object.entries(template)) writeFileSync(join(cwd, name), text);
  await checkBuild('npx tsc && npx vite build', cwd);
});
