// Runs the tracker in a worker: images and audio in, results out. For a comparison of two levels of detail, two
// trackers get the same input.
import {loadMien} from '../../../../bindings/js/mien.js';
import {FrameReader} from './frame_reader.js';

const modelNames = ['basenet', 'proposal', 'hifinet', 'audionet'];
const reader = new FrameReader();
let mien, weights, trackers = [];
let soundOffsetMs = 0;  // from the audio clock to the video clock
let failed = false;

async function fetched(url) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status}`);
  return response.arrayBuffer();
}

async function load({folder}) {
  const [loaded, ...models] = await Promise.all([
    loadMien(new URL('mien.wasm', folder)), ...modelNames.map(name => fetched(new URL(`models/${name}.mien`, folder)))]);
  mien = loaded;
  weights = mien.createWeights(models);
  setLevels({levels: [0]});
  postMessage({type: 'ready', version: mien.version, controlNames: mien.controlNames, stageNames: mien.stageNames});
}

// Existing trackers keep their face; new ones start with a detection.
function setLevels({levels}) {
  while (trackers.length > levels.length) trackers.pop().destroy();
  levels.forEach((lod, i) => {
    if (trackers[i]) trackers[i].setLod(lod);
    else trackers.push(mien.createTracker({weights, lod, budgetMs: 10}));
  });
}

function report(timeMs, action) {
  const results = trackers.map(tracker => {
    const began = performance.now();
    action(tracker);
    return {...tracker.getResult(), tookMs: performance.now() - began};
  });
  postMessage({type: 'results', timeMs, results});
}

const toNs = ms => Math.round(ms * 1e6);

const handlers = {
  load,
  levels: setLevels,
  async frame({frame, timeMs}) {
    let image;
    try {
      image = await reader.read(frame);
    } finally {
      frame.close?.();
    }
    report(timeMs, tracker => tracker.pushVideo(image, toNs(timeMs)));
  },
  advance({timeMs}) { report(timeMs, tracker => tracker.advance(toNs(timeMs))); },
  audio({port}) { port.onmessage = ({data}) => guarded(() => pushAudio(data)); },
  soundOffset({offsetMs}) { soundOffsetMs = offsetMs; },
  calibrate() { for (const tracker of trackers) tracker.captureNeutral(); },
  reset() { for (const tracker of trackers) tracker.reset(); },
};

function pushAudio({samples, sampleRate, timeMs}) {
  for (const tracker of trackers) tracker.pushAudio(samples, {sampleRate}, toNs(timeMs + soundOffsetMs));
}

async function guarded(action) {
  if (failed) return;
  try {
    await action();
  } catch (error) {
    failed = !mien;  // nothing works without the module
    postMessage({type: 'error', message: error.message});
  }
}

// Handles messages in sequence: the next image would otherwise overwrite the memory of the current one, and be tracked
// first.
let last = Promise.resolve();
onmessage = ({data}) => { last = last.then(() => guarded(() => handlers[data.type](data))); };
