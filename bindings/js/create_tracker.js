// Creates a tracker with the files of this package.
import {readFile, urls, urlsIn} from './files.js';
import {loadMien} from './module.js';

export async function createTracker({folder, ...config} = {}) {
  const from = folder ? urlsIn(folder) : urls, names = ['basenet', 'proposal'];
  if (config.maxLod !== 1) names.push('hifinet');
  if (config.audio !== false) names.push('audionet');
  const [mien, ...files] = await Promise.all([loadMien(from.module), ...names.map(name => readFile(from[name]))]);
  const weights = mien.createWeights(files);
  try {
    return mien.createTracker({lod: 0, ...config, weights});
  } finally {
    weights.destroy();  // the tracker keeps what it uses
  }
}
