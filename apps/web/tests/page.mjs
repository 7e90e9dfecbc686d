// The built page in a browser whose camera and microphone play the demo clip in a loop.
import {execFileSync} from 'node:child_process';
import {existsSync, mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {serve} from '../serve.mjs';
import {launch} from './browser.mjs';

const root = new URL('../../..', import.meta.url).pathname;
export const clip = join(root, 'tests/data/demo.mp4');
export const truthFile = join(root, 'tests/data/demo_truth.csv');
export const dist = new URL('../dist/', import.meta.url).pathname;

export async function openStudio(site = dist) {
  if (!existsSync(site)) throw new Error('apps/web/dist is missing: scripts/web.sh build');
  const folder = mkdtempSync(join(tmpdir(), 'mien-web-'));
  const camera = join(folder, 'camera.mjpeg'), microphone = join(folder, 'microphone.wav');
  const ffmpeg = (...options) => execFileSync('ffmpeg', ['-v', 'error', '-y', '-i', clip, ...options]);
  ffmpeg('-an', '-c:v', 'mjpeg', '-q:v', '2', camera);
  ffmpeg('-vn', '-ar', '48000', microphone);
  const browser = await launch([
    '--use-fake-device-for-media-stream', '--use-fake-ui-for-media-stream', `--use-file-for-fake-video-capture=${camera}`,
    `--use-file-for-fake-audio-capture=${microphone}`, '--autoplay-policy=no-user-gesture-required']);
  const {server, url} = await serve(site);
  return {
    browser, url, microphone,
    async close() {
      await browser.close();
      server.close();
      rmSync(folder, {recursive: true});
    }};
}

// A page that collects its log and its requests.
export async function openPage({browser, url}, options = {}) {
  const context = await browser.newContext({viewport: {width: 1280, height: 860}, ...options});
  const page = await context.newPage(), complaints = [], requests = [];
  page.on('console', message => {
    // Chromium without a graphics card logs this for every canvas.
    if (!message.text().includes('GPU stall due to ReadPixels')) complaints.push(`${message.type()}: ${message.text()}`);
  });
  page.on('pageerror', error => complaints.push(`error: ${error.message}`));
  context.on('request', request => requests.push(request.url()));
  await page.goto(url);
  await until(page, () => !document.getElementById('camera').disabled);
  return {context, page, complaints, requests};
}

// Waits until `condition`, a function of the page, returns true. (Playwright's own needs eval, which the page forbids.)
export async function until(page, condition, seconds = 15, status = '#status') {
  for (const end = Date.now() + seconds * 1000; Date.now() < end;) {
    if (await page.evaluate(condition)) return;
    await new Promise(done => setTimeout(done, 50));
  }
  throw new Error(`not within ${seconds} s: ${condition}; the page shows "${await page.textContent(status)}"`);
}

// Computes faces but does not draw them, until drawAgain: without a graphics card, drawing takes processor time that the tracker needs.
export const spareDrawing = page => page.evaluate(() => {
  const renderer = Object.getPrototypeOf(window.page.first.avatar.renderer), {draw} = renderer;
  renderer.draw = () => {};
  window.drawAgain = () => { renderer.draw = draw; };
});

export const following = page => until(page, () => document.getElementById('status').textContent.startsWith('Tracking'), 40);
