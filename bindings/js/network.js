// Custom networks of mien.h.
import {MienError} from './error.js';
import {number} from './layout.js';

// Input and output are views of the module's memory; request them again after each creation of an object.
export class Network {
  constructor(mien, config) {
    this.mien = mien;
    this.handle = 0;
    this.owned = [];
    try {
      this.create(config);
    } catch (error) {
      this.destroy();
      throw error;
    }
  }

  create({weights, name = null, height = 0, width = 0, cpuMask}) {
    const {mien} = this, struct = mien.struct('network_config');
    const named = name === null ? {address: 0} : mien.load(new TextEncoder().encode(name + '\0'));
    try {
      if (!weights?.address) throw new MienError('weights: missing (expected the result of createWeights)', -1);
      this.shapeAddress = mien.allocate(16);
      this.owned.push(this.shapeAddress);
      struct.fill({cpuMask: 'cpu_mask', height: 'height', width: 'width'}, {cpuMask, height, width});
      struct.set('weights', weights.address());
      struct.set('name', named.address);
      this.handle = mien.create('mien_network_create', struct.address);
    } finally {
      for (const spent of [struct.address, named.address]) mien.release(spent);
    }
  }

  view(address) {
    const [height, width, channels] = new Int32Array(this.mien.memory.buffer, this.shapeAddress, 3);
    const interleaved = channels <= 4 && height * width > 1 && address === this.inputAddress;
    const floats = height * width * (interleaved ? channels : (channels + 7 & ~7));
    return {data: new Float32Array(this.mien.memory.buffer, address, floats), shape: {height, width, channels}};
  }

  checkOpen() { if (!this.handle) throw new MienError('the network was destroyed', -1); }

  input() {
    this.checkOpen();
    this.inputAddress = this.mien.exports.mien_network_input(this.handle, this.shapeAddress);
    return this.view(this.inputAddress);
  }

  run() { this.mien.check(this.mien.exports.mien_network_run(this.handle)); }
  outputCount() { return this.mien.exports.mien_network_output_count(this.handle); }

  output(index) {
    this.checkOpen();
    const address = this.mien.exports.mien_network_output(this.handle, number('i32', index, 'index'), this.shapeAddress);
    if (!address) throw new MienError(`index: no such output (got ${index})`, -3);
    return this.view(address);
  }

  reset() { this.mien.exports.mien_network_reset(this.handle); }

  destroy() {
    if (this.handle) this.mien.exports.mien_network_destroy(this.handle);
    for (const address of this.owned) this.mien.release(address);
    this.handle = 0;
    this.owned = [];
  }
}
