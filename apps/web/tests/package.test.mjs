// The npm package in Chromium, without a bundler: sources of images, the worker, and audio.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdirSync, mkdtempSync, rmSync, statSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {pack} from './package.mjs';
import {clip, openStudio} from './page.mjs';

const site = mkdtempSync(join(tmpdir(), 'mien-')), installed = join(site, 'node_modules');
let studio, page, bytes;

before(async () => {
  mkdirSync(join(installed, 'mien'), {recursive: true});
  bytes = statSync(pack(join(installed, 'mien'))).size;
  for (const [file, ...options] of [['face.png'], ['face.i420', '-pix_fmt', 'yuv420p', '-f', 'rawvideo']]) {
    execFileSync('ffmpeg', ['-v', 'error', '-ss', '4', '-i', clip, '-frames:v', '1', ...options, join(site, file)]);
  }
  writeFileSync(join(site, 'index.html'), '<script type="importmap">{"imports": {"mien": "./node_modules/mien/mien.js"}}</script><video muted></video>');
  studio = await openStudio(site);
  page = await studio.browser.newPage();
  await page.goto(studio.url);
  await page.evaluate(async () => {
    window.mien = await import('mien');
    const video = document.querySelector('video');
    video.srcObject = await navigator.mediaDevices.getUserMedia({video: true, audio: true});
    await video.play();
    const image = new Image();
    image.src = 'face.png';
    await image.decode();
    const draw = canvas => {
      const context = canvas.getContext('2d');
      context.drawImage(image, 0, 0);
      return {canvas, pixels: context.getImageData(0, 0, 640, 480)};
    };
    const {canvas, pixels} = draw(Object.assign(document.createElement('canvas'), {width: 640, height: 480}));
    const {canvas: offscreen} = draw(new OffscreenCanvas(640, 480)), planes = await (await fetch('face.i420')).arrayBuffer();
    window.sources = {
      pixels, canvas, offscreen, image, bitmap: await createImageBitmap(image), drawn: new VideoFrame(canvas, {timestamp: 5000}),
      captured: new VideoFrame(planes, {format: 'I420', codedWidth: 640, codedHeight: 480, timestamp: 7000, colorSpace: {matrix: 'smpte170m', fullRange: false}}),
      raw: {format: 'i420', width: 640, height: 480, data: new Uint8Array(planes)}};
    window.trackers = {here: await window.mien.createTracker({lod: 1}), worker: await window.mien.createTrackerWorker({lod: 1})};
  });
});
after(async () => {
  await studio?.close();
  rmSync(site, {recursive: true});
});

test('the package has at most 6 MB', () => assert.ok(bytes <= 6e6, `${bytes} bytes`));

for (const where of ['here', 'worker']) {
  test(`a tracker ${where} tracks all sources alike, twice`, async () => {
    const results = await page.evaluate(async where => {
      const tracker = window.trackers[where], results = {};
      for (const [name, source] of Object.entries({...window.sources, ...window.sources})) {
        for (const _ of [1, 2]) {
          await tracker.reset();
          const before = performance.now(), {status, controls, ptsNs} = await tracker.track(source);
          results[name] = {status, controls: [...controls], timeMs: Number(ptsNs) / 1e6, before, after: performance.now()};
        }
      }
      return results;
    }, where);
    for (const [name, {status, controls, timeMs, before, after}] of Object.entries(results)) {
      const difference = Math.max(...controls.map((value, i) => Math.abs(value - results.pixels.controls[i])));
      assert.equal(status, 'tracking', name);
      assert.ok(difference < 0.05, `${name}: controls differ by ${difference}`);
      const expected = {drawn: 5, captured: 7}[name];
      if (expected) assert.equal(timeMs, expected, name); else assert.ok(timeMs >= before - 0.01 && timeMs <= after + 0.01, `${name}: ${before} ${timeMs} ${after}`);
    }
  });

  test(`a tracker ${where} follows a video, and images in the order of the calls`, async () => {
    const {status, times} = await page.evaluate(async where => {
      const tracker = window.trackers[where], video = document.querySelector('video');
      await tracker.reset();
      const sources = [video, window.sources.pixels, video, window.sources.canvas];
      const results = await Promise.all(sources.map((source, i) => tracker.track(source, i * 4e7)));
      return {status: results.at(-1).status, times: results.map(({ptsNs}) => Number(ptsNs))};
    }, where);
    assert.equal(status, 'tracking');
    assert.deepEqual(times, [0, 4e7, 8e7, 12e7]);
  });

  test(`a tracker ${where} describes wrong sources`, async () => {
    const messages = await page.evaluate(async where => {
      const closed = new VideoFrame(window.sources.canvas, {timestamp: 0}), bitmap = await createImageBitmap(window.sources.canvas);
      for (const each of [closed, bitmap]) each.close();
      const wrong = {
        nothing: undefined, none: null, text: 'face', element: document.body, video: document.createElement('video'), image: new Image(),
        canvas: new OffscreenCanvas(0, 4), closed, bitmap, short: {width: 4, height: 4, data: new Uint8Array(4)}};
      const errorOf = async source => window.trackers[where].track(source).then(() => 'no error', error => `${error.name} ${error.status}: ${error.message}`);
      const pairs = Object.entries(wrong).map(async ([name, source]) => [name, await errorOf(source)]);
      return Object.fromEntries(await Promise.all(pairs));
    }, where);
    const expected = 'expected a video, VideoFrame, ImageBitmap, canvas, image, ImageData, or {format, width, height, data}';
    assert.deepEqual(messages, {
      nothing: `MienError -1: source: wrong type (got Undefined, ${expected})`, none: `MienError -1: source: wrong type (got null, ${expected})`,
      text: `MienError -1: source: wrong type (got String, ${expected})`, element: `MienError -1: source: wrong type (got HTMLBodyElement, ${expected})`,
      video: 'MienError -61: source: the video has no image yet', image: 'MienError -61: source: the image is not loaded',
      canvas: 'MienError -61: source: no pixels (got 0 x 4)', closed: 'MienError -61: source: the VideoFrame was closed',
      bitmap: 'MienError -61: source: the ImageBitmap was closed', short: 'MienError -63: a plane has 4 bytes, less than its rows'});
  });

  test(`a tracker ${where} gets the microphone until it is stopped`, async () => {
    const {voices, later} = await page.evaluate(async where => {
      const tracker = await window.mien[where === 'here' ? 'createTracker' : 'createTrackerWorker']({lod: 1});
      const video = document.querySelector('video'), {context, stop} = await window.mien.listen(tracker, video.srcObject);
      const voice = async () => {
        await new Promise(next => video.requestVideoFrameCallback(next));
        return (await tracker.track(video)).voiceActivity;
      };
      const voices = [];
      while (voices.length < 300 && !voices.some(value => value > 0.5)) voices.push(await voice());
      stop();
      return {voices, later: context.state};
    }, where);
    assert.ok(voices.at(-1) > 0.5, voices.join(' '));
    assert.equal(later, 'closed');
  });
}

test('errors of the worker have a status, and end with it', async () => {
  const messages = await page.evaluate(async () => {
    const {createTrackerWorker, listen, MienError} = window.mien;
    const caught = promise => promise.then(() => 'no error', error => `${error instanceof MienError} ${error.status}: ${error.message}`);
    const tracker = await createTrackerWorker({audio: false, maxLod: 1});
    const errors = [await caught(tracker.setLod(4)), await caught(createTrackerWorker({maxFaces: 9})), await caught(createTrackerWorker({folder: 'nowhere'}))];
    const {stop} = await listen(tracker, document.querySelector('video').srcObject);
    while (errors.length < 4) {
      const error = await caught(tracker.track(window.sources.canvas));
      if (error !== 'no error') errors.push(error);
    }
    stop();
    const pending = caught(tracker.track(window.sources.canvas));
    tracker.destroy();
    errors.push(await pending, await caught(tracker.getResult()), await caught(createTrackerWorker({worker: new Worker('nothing.js', {type: 'module'})})));
    return errors;
  });
  for (const [i, text] of [/^true -7: /, /^true .*max_faces: /, /^true undefined: .*nowhere\/.*: 404 /, /^true -9: /, /^true -1: the tracker was destroyed/,
                           /^true -1: the tracker was destroyed/, /^true -1: worker: its file could not be loaded/].entries()) assert.match(messages[i], text);
});
