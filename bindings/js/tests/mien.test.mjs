// The wrapper in Node, on the demo clip. MIEN_WASM names the module; models and clip are the repository's.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {readFileSync} from 'node:fs';
import {test} from 'node:test';
import {fields, structBytes} from '../layout.js';
import {MienError, controlsByName, loadMien} from '../mien.js';
import {vocabularies} from '../vocabularies.js';

const root = new URL('../../../', import.meta.url).pathname;
const model = name => readFileSync(`${root}models/${name}.mien`);
const mien = await loadMien(readFileSync(process.env.MIEN_WASM ?? `${root}build/wasm/tracker/mien.wasm`));
const files = ['basenet', 'proposal', 'hifinet', 'audionet'].map(model);
const weights = mien.createWeights(files);
const width = 640, height = 480, frameNs = 1e9 / 30;

const ffmpeg = (...options) =>
  execFileSync('ffmpeg', ['-v', 'error', '-i', `${root}tests/data/demo.mp4`, ...options, '-'], {maxBuffer: 1 << 30});
const frames = (format, bytes, count) => {
  const all = ffmpeg('-frames:v', String(count), '-pix_fmt', format, '-f', 'rawvideo');
  return Array.from({length: count}, (_, i) => new Uint8Array(all.buffer, all.byteOffset + i * bytes, bytes));
};
const truth = (() => {
  const [header, ...rows] = readFileSync(`${root}tests/data/demo_truth.csv`, 'utf8').trim().split('\n').map(line => line.split(','));
  return name => rows.map(row => Number(row[header.indexOf(name)]));
})();

function correlation(a, b) {
  const mean = values => values.reduce((sum, value) => sum + value, 0) / values.length;
  const [ma, mb] = [mean(a), mean(b)];
  const product = (p, q, mp, mq) => p.reduce((sum, value, i) => sum + (value - mp) * (q[i] - mq), 0);
  return product(a, b, ma, mb) / Math.sqrt(product(a, a, ma, ma) * product(b, b, mb, mb));
}

test('names are in the order of the C API', () => {
  assert.equal(mien.controlNames.length, 52);
  assert.equal(mien.controlNames[mien.control.jawOpen], 'jawOpen');
  assert.deepEqual(mien.stageNames, ['proposal', 'warp', 'encoder', 'heads', 'decoders', 'sound']);
  assert.equal(mien.landmarkCount, 175);
  const groups = Object.values(mien.landmarkGroups);
  assert.equal(groups.length, 21);
  assert.equal(groups.reduce((next, {first, count}) => (assert.equal(first, next), next + count), 0), 175);
  const types = readFileSync(`${root}bindings/js/mien.d.ts`, 'utf8');
  const declared = type => [...types.match(new RegExp(`type ${type} =([^;]*)`))[1].matchAll(/'(\w+)'/g)].map(([, name]) => name);
  assert.deepEqual(declared('ControlName'), mien.controlNames);
  assert.deepEqual(declared('LandmarkGroupName'), Object.keys(mien.landmarkGroups));
});

// Values of the module, of the names that it supports.
function moduleValues(vocabulary, {controls, supportedControls}) {
  const {exports} = mien, count = exports.mien_vocabulary_size(vocabulary), address = mien.allocate(4 * (52 + count));
  new Float32Array(mien.memory.buffer, address, 52).set(controls);
  assert.equal(exports.mien_vocabulary_values(vocabulary, address, address + 208, count), 0);
  const values = [...new Float32Array(mien.memory.buffer, address + 208, count)], supported = exports.mien_vocabulary_supported(vocabulary, supportedControls);
  mien.release(address);
  const names = values.map((value, i) => [mien.text(exports.mien_vocabulary_name(vocabulary, i)), value]);
  return Object.fromEntries(names.filter((_, i) => supported >> BigInt(i) & 1n));
}

test('controls by name equal those of the module in all vocabularies', () => {
  const tracker = mien.createTracker({weights, lod: 2}), [data] = frames('rgba', width * height * 4, 1);
  tracker.pushVideo({width, height, data}, 0);
  const real = tracker.getResult(), parts = real.supportedVisemes;
  assert.ok(parts && real.visemes.some((value, i) => i > 0 && value > 0));
  for (let round = 0; round < 200; ++round) {
    const controls = Float32Array.from({length: 52}, (_, i) => (i * 37 + round * 101) % 64 / 63);
    const supportedControls = round ? 2n ** 52n - 1n & ~(0x1234567n << BigInt(round % 24)) : real.supportedControls;
    const result = round ? {...real, controls, supportedControls} : real;
    for (const [i, name] of Object.keys(vocabularies).entries()) {
      if (round && name === 'visemes') continue;  // of the tracker
      const found = controlsByName(result, name), expected = moduleValues(i, result);
      assert.deepEqual(Object.keys(found).sort(), Object.keys(expected).sort(), `${name} ${round}`);
      for (const [key, value] of Object.entries(expected)) assert.ok(Math.abs(found[key] - value) < 1e-6, `${name}.${key}: ${found[key]} is not ${value}`);
    }
  }
  assert.throws(() => controlsByName(real, 'faceit'), /^MienError: vocabulary: unknown \(got 'faceit', expected arkit, mediapipe, roblox, vrm0, vrm1, visemes\)/);
  tracker.destroy();
});

test('video and audio move the jaw', () => {
  const tracker = mien.createTracker({weights, lod: 4}), count = 120;
  const sound = ffmpeg('-f', 'f32le', '-ac', '1', '-ar', '16000', '-vn');
  const samples = new Float32Array(sound.buffer.slice(sound.byteOffset, sound.byteOffset + sound.length));
  const jaw = frames('nv12', width * height * 3 / 2, count).map((data, i) => {
    const from = Math.round(i * 16000 / 30), to = Math.round((i + 1) * 16000 / 30);
    tracker.pushAudio(samples.subarray(from, to), {sampleRate: 16000}, from / 16000 * 1e9);
    tracker.pushVideo({format: 'nv12', width, height, data, fullRange: false}, i * frameNs);
    return tracker.getResult();
  });
  const last = jaw.at(-1);
  assert.equal(last.status, 'tracking');
  assert.equal(last.lod, 4);
  assert.equal(last.frames, BigInt(count));
  assert.ok(last.stageNs.encoder > 0, 'stages are timed');
  assert.ok(correlation(jaw.map(({controls}) => controls[mien.control.jawOpen]), truth('jawOpen').slice(0, count)) > 0.8);
  tracker.destroy();
});

test('formats of the same image give the same result', () => {
  const results = [['rgba', 'rgba', 4], ['i420', 'yuv420p', 1.5], ['bgra', 'bgra', 4]].map(([format, pixels, bytes]) => {
    const tracker = mien.createTracker({weights, lod: 1});
    frames(pixels, width * height * bytes, 5).forEach((data, i) =>
      tracker.pushVideo({format, width, height, data, fullRange: false}, i * frameNs));
    const {status, box} = tracker.getResult();
    tracker.destroy();
    assert.equal(status, 'tracking');
    return box;
  });
  for (const box of results) box.forEach((value, i) => assert.ok(Math.abs(value - results[0][i]) < 3, `${value} and ${results[0][i]}`));
});

test('only the region is read', () => {
  const track = region => {
    const tracker = mien.createTracker({weights, lod: 1});
    frames('rgba', width * height * 4, 5).forEach((data, i) => tracker.pushVideo({width, height, data, region}, i * frameNs));
    const result = tracker.getResult();
    tracker.destroy();
    return result;
  };
  const {box} = track();
  const inside = track([box[0] - 40, box[1] - 40, box[2] + 80, box[3] + 80].map(Math.round));
  box.forEach((value, i) => assert.ok(Math.abs(value - inside.box[i]) < 5, `${value} and ${inside.box[i]}`));
  assert.equal(track([0, 0, 40, 40]).status, 'searching');
});

test('struct layouts match the header', {skip: !process.env.MIEN_C_API32 && 'MIEN_C_API32 is not set'}, () => {
  const facts = readFileSync(process.env.MIEN_C_API32, 'utf8').split('\n').map(line => line.split(' '));
  const declared = Object.fromEntries(facts.filter(([kind]) => kind === 'field' || kind === 'struct').map(([, name, value]) => [name, Number(value)]));
  for (const [struct, members] of Object.entries(fields)) {
    assert.equal(structBytes[struct], declared[`mien_${struct}`], struct);
    for (const [member, [offset]] of Object.entries(members)) assert.equal(offset, declared[`mien_${struct}.${member}`], `${struct}.${member}`);
  }
});

test('errors have a status', () => {
  const fails = (status, action) => assert.throws(action, error => error instanceof MienError && error.status === status, `status ${status}`);
  fails(-20, () => mien.createWeights([files[0], new Uint8Array(4096)]));
  assert.throws(() => mien.createWeights([files[0], new Uint8Array(4096)]), /^MienError: files\[1\]: byte 0, magic: the weights are not a .mien file/);
  assert.throws(() => mien.createTracker({weights, maxFaces: 9}), /max_faces: a value is out of range \(got 9, expected 1..8\)/);
  fails(-1, () => mien.createTracker({}));
  fails(-25, () => mien.createTracker({weights: mien.createWeights([files[1]])}));
  const tracker = mien.createTracker({weights, audio: false, maxLod: 1});
  fails(-60, () => tracker.pushVideo({format: 'cmyk', width, height, data: new Uint8Array(4)}, 0));
  fails(-63, () => tracker.pushVideo({width, height, data: new Uint8Array(100)}, 0));
  fails(-62, () => tracker.pushVideo({width, height, planes: [new Uint8Array(width * height * 4)], rowStrideBytes: [width]}, 0));
  const apart = bytes => ({
    format: 'i420', width: 8, height: 2, chromaPixelStrideBytes: 4, rowStrideBytes: [8, 13, 13],
    planes: [new Uint8Array(16), new Uint8Array(bytes), new Uint8Array(bytes)]});  // four samples of U, 4 bytes apart
  fails(-63, () => tracker.pushVideo(apart(12), 0));
  tracker.pushVideo(apart(13), 0);
  fails(-61, () => tracker.pushVideo({width: 0, height: 0, data: new Uint8Array(0)}, 0));
  fails(-9, () => tracker.pushAudio(new Float32Array(160), {sampleRate: 16000}, 0));
  fails(-7, () => tracker.setLod(4));
  fails(-80, () => tracker.loadNeutral(new Uint8Array(448)));
  tracker.destroy();
  const hearing = mien.createTracker({weights});
  fails(-3, () => hearing.setMix('nothing', 1, 1));
  hearing.setMix('jawOpen', 1, 0);
  hearing.destroy();
});

test('numbers out of range and arrays of another type are rejected', () => {
  const fails = (status, action) => assert.throws(action, error => error instanceof MienError && error.status === status, `${status}: ${action}`);
  const far = 2 ** 32, data = new Uint8Array(64 * 48 * 4), image = {width: 64, height: 48, data};
  for (const option of ['lod', 'maxFaces', 'cpuMask', 'loseAfterFrames']) fails(-3, () => mien.createTracker({weights, [option]: far + 1}));
  fails(-3, () => mien.createTracker({weights, maxFaces: 1.5}));
  fails(-3, () => mien.createTracker({weights, maxFaces: 'many'}));
  fails(-1, () => mien.createWeights(['models/basenet.mien']));
  fails(-1, () => mien.createTracker({weights: files}));
  const tracker = mien.createTracker({weights, lod: 1});
  for (const samples of [new Uint8Array(640), new Float64Array(160), new Int32Array(160), [0, 0, 0], new DataView(new ArrayBuffer(640)), null]) {
    fails(-66, () => tracker.pushAudio(samples, {sampleRate: 16000}, 0));
  }
  const samples = new Float32Array(160);
  fails(-3, () => tracker.pushAudio(samples, {sampleRate: far + 16000}, 0));
  fails(-68, () => tracker.pushAudio(samples, {sampleRate: 16000, channels: 0}, 0));
  fails(-3, () => tracker.pushAudio(samples, {sampleRate: 16000, channels: 0.5}, 0));
  tracker.pushAudio(samples, {sampleRate: 16000}, 0);
  for (const time of [NaN, Infinity, 1e19, -1e19, 2n ** 63n, '0']) {
    fails(-3, () => tracker.pushVideo(image, time));
    fails(-3, () => tracker.pushAudio(samples, {sampleRate: 16000}, time));
    fails(-3, () => tracker.advance(time));
    fails(-3, () => tracker.setAudioOffset(time));
  }
  fails(-3, () => tracker.setLod(far + 1));
  fails(-3, () => tracker.getFace(far));
  fails(-3, () => tracker.setMix(far, 1, 1));
  for (const size of [NaN, 1.5, far + 64, '64']) fails(-3, () => tracker.pushVideo({...image, width: size}, 0));
  fails(-61, () => tracker.pushVideo({...image, width: -64, height: -48}, 0));
  fails(-3, () => tracker.pushVideo({...image, region: [0, 0, far + 64, 48]}, 0));
  fails(-3, () => tracker.pushVideo({...image, region: Array(200).fill(0)}, 0));
  fails(-3, () => tracker.pushVideo({...image, rotation: far}, 0));
  fails(-63, () => tracker.pushVideo({...image, data: new Float32Array(64 * 48)}, 0));
  fails(-63, () => tracker.pushVideo({...image, data: undefined, planes: []}, 0));
  fails(-3, () => tracker.pushVideo({...image, planes: [data], rowStrideBytes: [NaN]}, 0));
  fails(-3, () => tracker.pushVideo({...image, planes: [data], rowStrideBytes: []}, 0));
  const planes = [data, data, data];
  fails(-62, () => tracker.pushVideo({format: 'i420', width: 64, height: 48, planes, chromaPixelStrideBytes: -1}, 0));
  tracker.pushVideo(image, 0);
  assert.equal(tracker.getResult().frames, 1n);
  tracker.destroy();
});

test('use after destroy is an error', () => {
  const gone = action => assert.throws(action, error => error instanceof MienError && error.status === -1);
  const tracker = mien.createTracker({weights, lod: 1});
  tracker.destroy();
  tracker.destroy();
  gone(() => tracker.pushVideo({width: 1, height: 1, data: new Uint8Array(4)}, 0));
  gone(() => tracker.pushAudio(new Float32Array(1), {sampleRate: 16000}, 0));
  for (const call of ['getResult', 'reset', 'captureNeutral', 'saveNeutral']) gone(() => tracker[call]());
  gone(() => tracker.getFace(0));
  const network = mien.createNetwork({weights: mien.createWeights([files[3]])});
  network.destroy();
  network.destroy();
  gone(() => network.input());
  gone(() => network.run());
  gone(() => network.output(0));
});

test('a neutral face is captured, saved and loaded', () => {
  const tracker = mien.createTracker({weights, lod: 2}), [data] = frames('rgba', width * height * 4, 1);
  tracker.captureNeutral();
  for (let i = 0; i < 70; ++i) tracker.pushVideo({width, height, data}, i * frameNs);
  const {file, captured} = tracker.saveNeutral();
  assert.equal(file.length, 448);
  assert.equal(captured, 2);
  const other = mien.createTracker({weights, lod: 2});
  other.loadNeutral(file);
  assert.deepEqual(other.saveNeutral().file, file);
  for (const one of [tracker, other]) one.destroy();
});

test('a bundle holds all files, and trackers keep their weights', () => {
  const bundle = mien.createWeights([Buffer.concat([files[1], files[0]])]);
  const tracker = mien.createTracker({weights: bundle});
  bundle.destroy();
  bundle.destroy();
  assert.throws(() => mien.createTracker({weights: bundle}), MienError);
  const [data] = frames('rgba', width * height * 4, 1);
  tracker.pushVideo({width, height, data}, 0);
  assert.equal(tracker.getResult().status, 'tracking');
  tracker.destroy();
});

test('trackers release their memory', () => {
  const pages = () => mien.memory.buffer.byteLength;
  mien.createTracker({weights, lod: 4}).destroy();
  const before = pages();
  for (let i = 0; i < 10; ++i) mien.createTracker({weights, lod: 4}).destroy();
  assert.equal(pages(), before);
});

test('networks of a weight file run', () => {
  const network = mien.createNetwork({weights: mien.createWeights([files[3]])});
  const {data, shape} = network.input();
  assert.equal(shape.channels, 130);
  data.fill(0.1);
  network.run();
  assert.ok(network.output(0).data.some(value => value !== 0));
  assert.throws(() => network.output(99), MienError);
  network.destroy();
});
