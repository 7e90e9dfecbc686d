// Tests the page as people use it.
import assert from 'node:assert/strict';
import {readFileSync, readdirSync, statSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {bestCorrelation, readTruth} from './correlation.mjs';
import {clip, dist, following, openPage, openStudio, spareDrawing, truthFile, until} from './page.mjs';

const require = createRequire(import.meta.url);
let studio;
before(async () => { studio = await openStudio(); });
after(() => studio?.close());

test('the page has at most 6.3 MB, with weights and without decoders, which some avatars need', () => {
  const bytes = readdirSync(dist, {recursive: true}).filter(name => !name.startsWith('decoders')).map(name => statSync(join(dist, name))).filter(info => info.isFile())
    .reduce((sum, info) => sum + info.size, 0);
  assert.ok(bytes <= 6.3e6, `${bytes} bytes`);
});

test("the avatar's jaw follows the clip's, from camera and microphone", async t => {
  const {page, context, complaints, requests} = await openPage(studio);
  await page.click('#camera');
  await following(page);
  await spareDrawing(page);
  await page.selectOption('#level', '4');
  // The position of the avatar's lower lip in each image: how far its middle has moved down.
  const samples = await page.evaluate(() => new Promise(done => {
    const {avatar} = window.page.first, {vertices, mesh} = avatar.head;
    const lip = vertices.findIndex(v => !v.inner && v.t < 0.01 && v.sine < -0.999), samples = [];
    document.addEventListener('mien-results', ({detail}) => {
      window.page.first.draw(performance.now());
      samples.push([detail.timeMs, vertices[lip].at[1] - mesh.positions[lip * 3 + 1]]);
      if (detail.timeMs - samples[0][0] > 16500) done(samples);
    });
  }));
  const {correlation, lagMs} = bestCorrelation(samples, readTruth(truthFile, 'jawOpen'));
  t.diagnostic(`correlation ${correlation.toFixed(3)} over ${samples.length} images in 16.5 s, clip started ${Math.round(lagMs)} ms into its loop`);
  assert.ok(correlation > 0.8, `correlation ${correlation}`);
  assert.deepEqual(complaints, []);
  assert.ok(requests.every(url => url.startsWith(studio.url) || url.startsWith('blob:')), requests.join(' '));
  await context.close();
});

test('a face drawn with fewer pixels has soft edges', async () => {
  const {page, context} = await openPage(studio);
  const filters = await page.evaluate(() => [0, 3].map(step => {
    const {first} = window.page;
    first.quality.change(step, performance.now(), false);
    first.resize();
    return first.canvas.style.filter;
  }));
  assert.deepEqual(filters, ['', 'blur(0.9px)']);
  await context.close();
});

test('audio of the microphone gives voice activity', async () => {
  const {page, context} = await openPage(studio);
  await page.click('#camera');
  await following(page);
  await until(page, () => new Promise(done => document.addEventListener('mien-results',
    ({detail}) => done(detail.results[0].voiceActivity > 0.5), {once: true})), 30);
  await context.close();
});

test('two levels are shown beside each other', async () => {
  const {page, context, complaints} = await openPage(studio);
  await page.click('#camera');
  await following(page);
  await spareDrawing(page);
  await page.selectOption('#level', '4');
  await page.check('#compare');
  await until(page, () => document.getElementById('caption-a').textContent.startsWith('level 4') &&
    document.getElementById('caption-b').textContent.startsWith('level 1'));
  await page.uncheck('#compare');
  assert.ok(await page.isHidden('#face-b'));
  assert.deepEqual(complaints, []);
  await context.close();
});

test('calibration is announced and ends', async () => {
  const {page, context} = await openPage(studio);
  await page.click('#camera');
  await following(page);
  await spareDrawing(page);
  await page.click('#calibrate');
  await until(page, () => document.getElementById('status').textContent.startsWith('Calibrating'));
  await following(page);
  await context.close();
});

test('recordings can be saved as curves, Live Link Face and glTF', async () => {
  const {page, context, complaints} = await openPage(studio);
  await page.click('#camera');
  await following(page);
  await spareDrawing(page);
  await page.click('#record');
  await until(page, () => window.page.recording.frames.length > 30, 60);
  await page.click('#record');
  const saved = {};
  for (const format of ['csv', 'llf', 'glb']) {
    const [download] = await Promise.all([page.waitForEvent('download'), page.click(`[data-format=${format}]`)]);
    saved[format] = readFileSync(await download.path());
  }
  const frames = await page.evaluate(() => window.page.recording.frames.length);
  assert.ok(frames > 30, `${frames} frames`);
  await checkCurves(saved, frames);
  await checkGlb(saved, frames);
  assert.deepEqual(complaints, []);
  await context.close();
});

const table = bytes => bytes.toString().trim().split('\n').map(line => line.split(','));

// Both tables have every frame and the same values of the jaw.
async function checkCurves({csv, llf}, frames) {
  const [curveNames, ...curves] = table(csv), [liveNames, ...live] = table(llf);
  const truthNames = readFileSync(truthFile, 'utf8').split('\n')[0].trim().split(',');
  assert.deepEqual(curveNames.slice(16), truthNames.filter(name => curveNames.includes(name) && name !== 'frame').slice(0, 52));
  assert.equal(liveNames.length, 63);
  assert.deepEqual(liveNames.slice(17, 19), ['JawRight', 'JawLeft']);
  assert.equal(curves.length, frames);
  assert.equal(live.length, frames);
  const column = (names, rows, name) => rows.map(row => Number(row[names.indexOf(name)]));
  const jaw = column(curveNames, curves, 'jawOpen'), liveJaw = column(liveNames, live, 'JawOpen');
  jaw.forEach((value, i) => assert.ok(Math.abs(value - liveJaw[i]) < 1e-6));
  const times = column(curveNames, curves, 't_ms');
  assert.ok(times.every((time, i) => i === 0 ? time === 0 : time > times[i - 1]));
  for (const row of live) assert.match(row[0], /^\d\d:\d\d:\d\d:\d\d\.\d{3}$/);
}

// The avatar, whose weights are the numbers of the curves.
async function checkGlb({csv, glb}, frames) {
  const {issues, info} = await require('gltf-validator').validateBytes(new Uint8Array(glb));
  assert.equal(issues.numErrors + issues.numWarnings, 0, JSON.stringify(issues.messages));
  assert.equal(info.animationCount, 1);
  assert.ok(info.totalTriangleCount > 6000, `${info.totalTriangleCount} triangles`);
  const {GLTFLoader} = await import('three/examples/jsm/loaders/GLTFLoader.js');
  const {animations: [animation], scene} = await new GLTFLoader().parseAsync(new Uint8Array(glb).buffer, '');
  const weights = animation.tracks.find(({name}) => name.endsWith('morphTargetInfluences'));
  const {morphTargetDictionary: targets} = scene.getObjectByName('face'), [names, ...rows] = table(csv);
  assert.equal(weights.times.length, frames);
  for (const [name, target] of Object.entries(targets)) {
    rows.forEach((row, i) => assert.equal(weights.values[i * 52 + target], Math.fround(row[names.indexOf(name)]), `${name} of frame ${i}`));
  }
}

test('a video file replaces the camera', async () => {
  const {page, context, complaints} = await openPage(studio);
  await page.setInputFiles('#file', clip);
  await following(page);
  assert.deepEqual(complaints, []);
  await context.close();
});

test('audio alone moves the mouth', async () => {
  const {page, context, complaints} = await openPage(studio);
  await page.setInputFiles('#file', studio.microphone);
  await until(page, () => document.getElementById('status').textContent === 'Audio only');
  await until(page, () => window.page.first.face.controls.jawOpen > 0.1, 30);
  assert.ok(await page.isHidden('#preview'));
  assert.deepEqual(complaints, []);
  await context.close();
});

// The camera stays pending until the page's `grant` is called; `tracks` are those that it returns.
const holdCamera = page => page.evaluate(() => {
  const {mediaDevices} = navigator, give = mediaDevices.getUserMedia.bind(mediaDevices);
  const granted = new Promise(done => { window.grant = done; });
  window.tracks = [];
  mediaDevices.getUserMedia = async wish => {
    await granted;
    const stream = await give(wish);
    window.tracks.push(...stream.getTracks());
    return stream;
  };
});
const liveTracks = page => page.evaluate(() => window.tracks.filter(({readyState}) => readyState === 'live').length);

test('a file that is opened while the browser asks for the camera plays, and the camera is released', async () => {
  const {page, context, complaints} = await openPage(studio);
  await holdCamera(page);
  await page.click('#camera');
  assert.ok(await page.isDisabled('#camera'));
  await page.setInputFiles('#file', clip);
  await following(page);
  await page.evaluate(() => window.grant());
  await until(page, () => window.tracks.length === 2 && window.tracks.every(({readyState}) => readyState === 'ended'));
  await following(page);
  assert.ok(await page.evaluate(() => !window.page.source.video.srcObject && !window.page.source.video.paused));
  await page.click('#stop');
  await until(page, () => document.getElementById('status').textContent === 'Stopped.');
  assert.ok(await page.isEnabled('#camera'));
  assert.deepEqual(complaints, []);
  await context.close();
});

test('denying the camera while a file plays changes nothing', async () => {
  const {page, context, complaints} = await openPage(studio);
  await page.evaluate(() => {
    const refused = new Promise((_, refuse) => { window.refuse = () => refuse(new DOMException('', 'NotAllowedError')); });
    navigator.mediaDevices.getUserMedia = () => refused;
  });
  await page.click('#camera');
  await page.setInputFiles('#file', clip);
  await following(page);
  await page.evaluate(() => window.refuse());
  await following(page);
  assert.ok(await page.isVisible('#stop'));
  assert.deepEqual(complaints, []);
  await context.close();
});

test('of two cameras opened at the same time the later one stays, and Stop ends it', async () => {
  const {page, context, complaints} = await openPage(studio);
  await holdCamera(page);
  await page.evaluate(() => {
    for (let i = 0; i < 2; ++i) window.page.open(() => window.page.source.openCamera());
    window.grant();
  });
  await following(page);
  await until(page, () => window.tracks.length === 4);
  assert.equal(await liveTracks(page), 2);
  await page.click('#stop');
  assert.equal(await liveTracks(page), 0);
  assert.deepEqual(complaints, []);
  await context.close();
});

test('of two files opened at the same time the later one gives each image once', async () => {
  const {page, context, complaints} = await openPage(studio);
  await page.evaluate(() => {
    const {sound} = window.page.source, listen = sound.listen.bind(sound);
    const granted = new Promise(done => { window.grant = done; });
    sound.listen = async (...what) => {  // the first one waits here
      sound.listen = listen;
      window.held = true;
      await granted;
      return listen(...what);
    };
  });
  await page.setInputFiles('#file', clip);
  await until(page, () => window.held);
  await page.evaluate(() => { document.getElementById('file').value = ''; });  // the same file is no change
  await page.setInputFiles('#file', clip);
  await following(page);
  const times = await page.evaluate(() => new Promise(done => {
    const {tracking} = window.page, push = tracking.push.bind(tracking), times = [];
    window.grant();
    tracking.push = (frame, timeMs) => {
      times.push(timeMs);
      push(frame, timeMs);
      if (times.length === 40) done(times);
    };
  }));
  assert.equal(new Set(times).size, times.length);
  assert.deepEqual(complaints, []);
  await context.close();
});

test('an unusable file is rejected with a message', async () => {
  const {page, context} = await openPage(studio);
  await page.setInputFiles('#file', {name: 'note.mp4', mimeType: 'video/mp4', buffer: Buffer.from('no video')});
  await until(page, () => document.getElementById('error').textContent.includes('note.mp4: this browser cannot play it'));
  await page.setInputFiles('#model', {name: 'head.glb', mimeType: '', buffer: Buffer.from('not a head, but more than 20 bytes')});
  await until(page, () => document.getElementById('error').textContent.includes('head.glb: not a binary glTF file'));
  await page.click('#camera');
  await following(page);
  assert.ok(await page.isVisible('#error'), 'until it is dismissed');
  await page.click('#error button');
  assert.ok(await page.isHidden('#error'));
  await context.close();
});

test('the page works offline after it was loaded', async () => {
  const {page, context, complaints} = await openPage(studio);
  await page.evaluate(() => navigator.serviceWorker.ready.then(() => new Promise(done => {
    if (navigator.serviceWorker.controller) done();
    navigator.serviceWorker.addEventListener('controllerchange', done);
  })));
  await context.setOffline(true);
  await page.reload();
  await until(page, () => !document.getElementById('camera').disabled);
  await page.click('#camera');
  await following(page);
  assert.deepEqual(complaints, []);
  await context.close();
});

for (const colorScheme of ['light', 'dark']) {
  for (const [device, viewport] of [['desktop', {width: 1280, height: 860}], ['phone', {width: 390, height: 844}]]) {
    test(`axe finds no serious problem: ${colorScheme}, ${device}`, async () => {
      const {page, context} = await openPage(studio, {colorScheme, viewport, bypassCSP: true});
      await page.click('#camera');
      await following(page);
      await spareDrawing(page);
      await page.check('#compare');
      await page.click('summary');
      await page.evaluate(readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8'));
      const {violations} = await page.evaluate(() => window.axe.run());
      const found = violations.map(({id, impact, nodes}) => `${impact} ${id}: ${nodes.map(node => node.html).slice(0, 3).join(' ')}`);
      assert.deepEqual(found.filter(text => /^(serious|critical)/.test(text)), []);
      assert.deepEqual(found, []);
      const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
      assert.ok(overflow <= 0, `${overflow} pixels too wide`);
      await context.close();
    });
  }
}
