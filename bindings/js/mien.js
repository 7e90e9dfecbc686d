// mien for JavaScript. Runs in pages, workers and Node, without dependencies. mien.d.ts documents the API.
export {applyToMorphs, applyToVRM} from './avatars.js';
export {createTracker} from './create_tracker.js';
export {MienError} from './error.js';
export {listen} from './listen.js';
export {loadMien} from './module.js';
export {Network} from './network.js';
export {Tracker} from './tracker.js';
export {createTrackerWorker} from './tracker_worker.js';
export {Weights} from './weights.js';
export {controlsByName} from './vocabularies.js';
