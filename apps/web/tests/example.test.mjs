// The page of apps/examples, in a folder that has installed the package.
import assert from 'node:assert/strict';
import {copyFileSync, mkdirSync, mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {pack, root} from './package.mjs';
import {openStudio, until} from './page.mjs';

const site = mkdtempSync(join(tmpdir(), 'mien-'));
let studio;
before(async () => {
  const installed = join(site, 'node_modules/mien');
  mkdirSync(installed, {recursive: true});
  pack(installed);
  copyFileSync(join(root, 'apps/examples/js/index.html'), join(site, 'index.html'));
  studio = await openStudio(site);
});
after(async () => {
  await studio?.close();
  rmSync(site, {recursive: true});
});

test("the page shows the camera's jawOpen", async () => {
  const page = await studio.browser.newPage(), errors = [];
  page.on('pageerror', error => errors.push(error.message));
  await page.goto(studio.url);
  await until(page, () => document.getElementById('status').textContent === 'tracking');
  await until(page, () => document.getElementById('meter').value > 0.2, 30);
  assert.deepEqual(errors, []);
});

test('a page without a camera shows why', async () => {
  const page = await studio.browser.newPage();
  await page.addInitScript(() => { navigator.mediaDevices.getUserMedia = () => Promise.reject(new Error('no camera')); });
  await page.goto(studio.url);
  await until(page, () => document.getElementById('status').textContent === 'no camera');
});
