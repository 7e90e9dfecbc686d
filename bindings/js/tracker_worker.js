// A tracker in a worker. Its methods are those of Tracker, and return promises.
import {MienError} from './error.js';
import {absolute} from './files.js';
import {timeOf, transferable} from './frames.js';

const methods = ['pushAudio', 'advance', 'getResult', 'faceCount', 'getFace', 'setLod', 'setAudioOffset', 'setMix', 'captureNeutral', 'saveNeutral',
                 'loadNeutral', 'reset'];

export async function createTrackerWorker({worker = undefined, folder = undefined, ...config} = {}) {
  const thread = worker ?? new Worker(new URL('./mien-worker.js', import.meta.url), {type: 'module'});
  const tracker = new TrackerWorker(thread);
  try {
    tracker.version = await tracker.call('create', [{...config, folder: folder && absolute(folder)}]);
    return tracker;
  } catch (error) {
    tracker.destroy();
    throw error;
  }
}

class TrackerWorker {
  constructor(worker) {
    this.worker = worker;
    this.calls = new Map();
    this.count = 0;
    worker.onmessage = ({data}) => this.settle(data);
    worker.onerror = ({message}) => this.end(`worker: ${message ?? 'its file could not be loaded'}`);
  }

  call(method, args, transfer = []) {
    return new Promise((resolve, reject) => {
      if (this.ended) throw new MienError(this.ended, -1);
      this.worker.postMessage({id: ++this.count, method, args}, transfer);
      this.calls.set(this.count, {resolve, reject});
    });
  }

  settle({id, value, error}) {
    const {resolve, reject} = this.calls.get(id);
    this.calls.delete(id);
    if (error) reject(new MienError(error.message, error.status)); else resolve(value);
  }

  end(why) {
    this.ended ??= why;
    for (const {reject} of this.calls.values()) reject(new MienError(why, -1));
    this.calls.clear();
  }

  async track(source, ptsNs = timeOf(source)) {
    const {frame, transfer} = await transferable(source, ptsNs);
    return this.call('track', [frame, ptsNs], transfer);
  }

  connectAudio(port) { return this.call('connectAudio', [port], [port]); }

  destroy() {
    this.worker.terminate();
    this.end('the tracker was destroyed');
  }
}

for (const method of methods) TrackerWorker.prototype[method] = function forward(...args) { return this.call(method, args); };
