// Measures the additional time of a frame through mien.js: pushVideo and getResult compared with direct calls of
// mien_tracker_push_video and mien_tracker_get_result on images in the module's memory. Prints a table.
// usage: node overhead.mjs MODULE.wasm CLIP [ROUNDS]      uses the repository's weights
import {execFileSync} from 'node:child_process';
import {readFileSync} from 'node:fs';
import {loadMien} from '../mien.js';

const [modulePath, clip, rounds = '15'] = process.argv.slice(2);
const root = new URL('../../../', import.meta.url).pathname;
const model = name => readFileSync(`${root}models/${name}.mien`);
const files = ['basenet', 'proposal', 'hifinet'].map(model);
const mien = await loadMien(readFileSync(modulePath));
const width = 640, height = 480, count = 60, frameNs = 1e9 / 30;
const formats = {rgba: 4, nv12: 1.5};  // bytes of a pixel

function framesOf(format) {
  const bytes = width * height * formats[format], size = `${width}:${height}`;
  const all = execFileSync('ffmpeg', ['-v', 'error', '-i', clip, '-frames:v', String(count), '-vf', `scale=${size}`, '-pix_fmt', format,
    '-f', 'rawvideo', '-'], {maxBuffer: 1 << 30});
  return Array.from({length: count}, (_, i) => new Uint8Array(all.buffer, all.byteOffset + i * bytes, bytes));
}

// Times of the frames, ms, and the sum of all controls.
function through(tracker, format, frames) {
  let sum = 0;
  const times = frames.map((data, i) => {
    const begin = performance.now();
    tracker.pushVideo({format, width, height, data}, i * frameNs);
    const {controls} = tracker.getResult();
    const end = performance.now();
    sum += controls.reduce((a, b) => a + b, 0);
    return end - begin;
  });
  return {times, sum};
}

// The same through direct calls of the module; `addresses` are those of the frames in its memory.
function direct(tracker, format, frames, addresses) {
  const {mien_tracker_push_video: push, mien_tracker_get_result: get} = mien.exports, luma = width * height;
  let sum = 0;
  const times = frames.map((_, i) => {
    tracker.image.set('planes', addresses[i], 0);
    if (format === 'nv12') tracker.image.set('planes', addresses[i] + luma, 1);
    const time = BigInt(Math.round(i * frameNs)), begin = performance.now();
    mien.check(push(tracker.handle, tracker.image.address, time));
    mien.check(get(tracker.handle, tracker.result.address));
    const end = performance.now();
    sum += tracker.result.get('controls').reduce((a, b) => a + b, 0);
    return end - begin;
  });
  return {times, sum};
}

function compare(lod, format) {
  const frames = framesOf(format), bytes = frames[0].byteLength;
  const addresses = frames.map(data => {
    const address = mien.allocate(bytes);
    new Uint8Array(mien.memory.buffer).set(data, address);
    return address;
  });
  const tracker = mien.createTracker({weights: mien.createWeights(files), lod}), fastest = {through: [], direct: []}, sums = new Set();
  for (let round = 0; round <= Number(rounds); ++round) {  // the first, which compiles, does not count
    for (const [name, run] of [['through', through], ['direct', direct]]) {
      tracker.reset();
      const {times, sum} = run(tracker, format, frames, addresses);
      sums.add(sum.toFixed(3));
      if (round > 0) fastest[name] = times.map((time, i) => Math.min(time, fastest[name][i] ?? Infinity));
    }
  }
  if (sums.size !== 1) throw new Error(`results differ: ${[...sums]}`);
  tracker.destroy();
  for (const address of addresses) mien.release(address);
  const mean = values => values.reduce((a, b) => a + b, 0) / values.length;
  const c = mean(fastest.direct), js = mean(fastest.through);
  return `| ${lod} | ${format} | ${c.toFixed(3)} | ${js.toFixed(3)} | ${(js - c).toFixed(3)} |`;
}

console.log('| level | image | calls of the module, ms | `pushVideo` and `getResult`, ms | difference, ms |');
console.log('|---|---|---|---|---|');
for (const lod of [1, 4]) for (const format of Object.keys(formats)) console.log(compare(lod, format));
