// Without a camera or a permission, the page says what to do.
import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {serve} from '../serve.mjs';
import {launch} from './browser.mjs';
import {dist, openPage, until} from './page.mjs';

let site;
before(async () => { site = await serve(dist); });
after(() => site.server.close());

// Chromium has no devices here, or those that these options imitate.
const imitated = '--use-fake-device-for-media-stream', allowed = '--use-fake-ui-for-media-stream';
const noCamera = 'no camera was found; connect a camera, then press Camera again, or load a video';

async function pressCamera(flags, prepare = () => {}) {
  const browser = await launch(flags);
  try {
    const {page} = await openPage({browser, url: site.url});
    await page.evaluate(prepare);
    await page.click('#camera');
    await until(page, () => !document.getElementById('error').hidden, 30);
    await until(page, () => document.getElementById('status').textContent !== 'Opening …');
    return {error: await page.textContent('#error p'), status: await page.textContent('#status'), stops: await page.isVisible('#stop')};
  } finally {
    await browser.close();
  }
}

test('without camera and microphone', async () => {
  assert.deepEqual(await pressCamera([]), {error: noCamera, status: 'Stopped.', stops: false});
});

test('with a microphone alone, which moves the mouth', async () => {
  const {error, status, stops} = await pressCamera([imitated + '=device-count=0', allowed]);
  assert.deepEqual({error, status, stops}, {error: noCamera, status: 'Audio only, without camera', stops: true});
});

test('without a permission', async () => {
  const {error, status} = await pressCamera([imitated]);
  assert.equal(error, "the browser may not use the camera; allow it in the address bar, or in the system's privacy settings, then press Camera again");
  assert.equal(status, 'Stopped.');
});

test('while another program uses the camera', async () => {
  const {error} = await pressCamera([], () => {
    navigator.mediaDevices.getUserMedia = () => Promise.reject(new DOMException('', 'NotReadableError'));
  });
  assert.equal(error, 'the camera does not start; close other programs that use it, then press Camera again');
});

test('on a page that is not secure', async () => {
  const {error} = await pressCamera([], () => Object.defineProperty(navigator, 'mediaDevices', {value: undefined}));
  assert.equal(error, 'this page must not use a camera here; open it with https, or on localhost');
});

test('after the camera was disconnected', async () => {
  const {error, status} = await pressCamera([imitated, allowed], () => {
    const {source} = window.page, start = source.start.bind(source);
    source.start = async mine => {
      await start(mine);
      setTimeout(() => source.stream.getVideoTracks()[0].dispatchEvent(new Event('ended')));
    };
  });
  assert.equal(error, 'the camera was disconnected; connect it again, then press Camera');
  assert.equal(status, 'Stopped.');
});
