// Weights of mien.h.
import {MienError} from './error.js';

const maxFiles = 8;  // MIEN_MAX_WEIGHT_FILES

// Opened weight files. Trackers and networks share them, and keep what they use after destroy.
export class Weights {
  // `files`: ArrayBuffers or views of them; each a weight file, a packed one, or a bundle of several, in any order.
  constructor(mien, files) {
    this.mien = mien;
    this.handle = 0;
    if (files.length > maxFiles) throw new MienError(`files: too many (got ${files.length}, expected ${maxFiles} at most)`, -3);
    const struct = mien.struct('weights_config'), loaded = [];
    try {
      struct.set('copy', 1);
      files.forEach((file, i) => {
        if (!file) throw new MienError(`files: element ${i} is missing`, -1);
        const {address, bytes} = mien.load(file);
        loaded.push(address);
        struct.set('files', address, i);
        struct.set('file_bytes', bytes, i);
      });
      this.handle = mien.create('mien_weights_create', struct.address, i => `files[${i}]`);
    } finally {
      for (const address of [struct.address, ...loaded]) mien.release(address);
    }
  }

  // The address for an object that uses them.
  address() {
    if (!this.handle) throw new MienError('the weights were destroyed', -1);
    return this.handle;
  }

  destroy() {
    if (this.handle) this.mien.exports.mien_weights_destroy(this.handle);
    this.handle = 0;
  }
}
