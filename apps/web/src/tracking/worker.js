// Runs the tracker in a worker: images and audio in, results out. For a comparison of two levels of detail, two
// trackers get the same input.
import {readFile, urlsIn} from '../../../../bindings/js/files.js';
import {FrameReader} from '../../../../bindings/js/frames.js';
import {loadMien} from '../../../../bindings/js/module.js';

const modelNames = ['basenet', 'proposal', 'hifinet', 'audionet'];
const reader = new FrameReader();
let mien, weights, trackers = [];
let failed = false;

async function load({folder}) {
  const urls = urlsIn(folder);
  const [loaded, ...models] = await Promise.all([loadMien(urls.module), ...modelNames.map(name => readFile(urls[name]))]);
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
  calibrate() { for (const tracker of trackers) tracker.captureNeutral(); },
  reset() { for (const tracker of trackers) tracker.reset(); },
};

function pushAudio({samples, sampleRate, timeMs}) {
  for (const tracker of trackers) tracker.pushAudio(samples, {sampleRate}, toNs(timeMs));
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
