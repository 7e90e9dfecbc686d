// The page's interface to the tracker: sends images while the worker keeps up, and drops the others.

export class Tracking {
  constructor({onReady, onResults, onError}) {
    this.worker = new Worker(new URL('worker.js', document.baseURI), {type: 'module'});
    this.busy = 0;
    this.dropped = 0;
    const handlers = {
      ready: message => onReady(message),
      results: message => {
        this.busy = Math.max(0, this.busy - 1);
        onResults(message);
      },
      error: ({message}) => {
        this.busy = 0;
        onError(message);
      }};
    this.worker.onmessage = ({data}) => handlers[data.type](data);
    this.worker.onerror = event => onError(event.message || 'the tracker could not be started');
    this.worker.postMessage({type: 'load', folder: document.baseURI});
  }

  // At most two images are in progress; further ones are dropped.
  get idle() { return this.busy < 2; }

  push(frame, timeMs) {
    if (!this.idle) {
      ++this.dropped;
      frame.close?.();
      return;
    }
    ++this.busy;
    this.worker.postMessage({type: 'frame', frame, timeMs}, [frame]);
  }

  advance(timeMs) {
    if (!this.idle) return;
    ++this.busy;
    this.worker.postMessage({type: 'advance', timeMs});
  }

  setLevels(levels) { this.worker.postMessage({type: 'levels', levels}); }
  connectAudio(port) { this.worker.postMessage({type: 'audio', port}, [port]); }
  calibrate() { this.worker.postMessage({type: 'calibrate'}); }
  reset() { this.worker.postMessage({type: 'reset'}); }
}
