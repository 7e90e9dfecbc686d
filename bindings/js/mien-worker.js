// Runs a tracker in a worker for createTrackerWorker: {id, method, args} in, {id, value} or {id, error} out, in sequence.
import {createTracker} from './create_tracker.js';

let tracker;
const methods = {
  async create(config) {
    tracker = await createTracker(config);
    return tracker.mien.version;
  },
  async track(frame, ptsNs) {
    try {
      return await tracker.track(frame, ptsNs);
    } finally {
      frame.close?.();
    }
  },
};

async function answer({id, method, args}) {
  try {
    postMessage({id, value: await (methods[method] ?? tracker[method].bind(tracker))(...args)});
  } catch ({message, status}) {
    postMessage({id, error: {message, status}});
  }
}

let last = Promise.resolve();
onmessage = ({data}) => { last = last.then(() => answer(data)); };
