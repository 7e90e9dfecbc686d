// The functions of mien.h on the WebAssembly module.
import {MienError} from './error.js';
import {readFile, urls} from './files.js';
import {Struct, structBytes} from './layout.js';
import {Network} from './network.js';
import {Tracker} from './tracker.js';
import {Weights} from './weights.js';

const alignment = 64;  // MIEN_ALIGNMENT

async function compile(source) {
  if (source instanceof WebAssembly.Module) return source;
  if (source instanceof ArrayBuffer || ArrayBuffer.isView(source)) return WebAssembly.compile(source);
  return WebAssembly.compile(await readFile(source));
}

// Functions that the module imports.
function host(memoryOf) {
  const clock_time_get = (_clock, _precision, address) => {
    new DataView(memoryOf().buffer).setBigUint64(address, BigInt(Math.round(performance.now() * 1e6)), true);
    return 0;
  };
  return {
    wasi_snapshot_preview1: {clock_time_get, proc_exit(code) { throw new MienError(`the module ended with ${code}`); }},
    env: {emscripten_notify_memory_growth() {}}};
}

// `source`: URL of mien.wasm, a Response with it, its bytes, or the compiled module.
export async function loadMien(source = urls.module) {
  let memory;
  const {exports} = await WebAssembly.instantiate(await compile(source), host(() => memory));
  ({memory} = exports);
  exports._initialize();
  return new Mien(exports);
}

export class Mien {
  constructor(exports) {
    this.exports = exports;
    this.memory = exports.memory;
    for (const name of Object.keys(structBytes)) this.checkLayout(name);
    const names = (count, of) => Array.from({length: count}, (_, i) => this.text(of(i)));
    this.version = this.text(exports.mien_version());
    this.controlNames = names(exports.mien_control_count(), exports.mien_control_name);
    this.control = Object.freeze(Object.fromEntries(this.controlNames.map((name, i) => [name, i])));
    this.landmarkGroups = Object.freeze(Object.fromEntries(this.readLandmarkGroups()));
    this.stageNames = names(6, exports.mien_stage_name);
    this.landmarkCount = exports.mien_landmark_count();
  }

  // [name, {first, count}] of each group.
  readLandmarkGroups() {
    const groups = [], first = this.allocate(4);
    for (let group = 0, name; (name = this.text(this.exports.mien_landmark_group_name(group))) !== null; ++group) {
      const count = this.exports.mien_landmark_group_range(group, first);
      groups.push([name, Object.freeze({first: new DataView(this.memory.buffer).getInt32(first, true), count})]);
    }
    this.release(first);
    return groups;
  }

  checkLayout(name) {
    const address = this.allocate(structBytes[name]);
    this.exports[`mien_${name}_default`](address);
    const bytes = new Struct(this.memory, name, address).get('struct_size');
    this.release(address);
    if (bytes !== structBytes[name]) throw new MienError(`mien.wasm is of another version: its mien_${name} has ${bytes} bytes, not ${structBytes[name]}`);
  }

  createWeights(files) { return new Weights(this, files); }
  createTracker(config) { return new Tracker(this, config); }
  createNetwork(config) { return new Network(this, config); }

  // Internal: the module's memory. Release takes the address from allocate.
  allocate(bytes) {
    const block = this.exports.malloc(bytes + alignment + 4);
    if (!block) throw new MienError('out of memory', -6);
    const address = (block + 4 + alignment - 1) & ~(alignment - 1);
    new DataView(this.memory.buffer).setUint32(address - 4, block, true);
    return address;
  }

  release(address) { if (address) this.exports.free(new DataView(this.memory.buffer).getUint32(address - 4, true)); }

  struct(name) {
    const address = this.allocate(structBytes[name]);
    this.exports[`mien_${name}_default`](address);
    return new Struct(this.memory, name, address);
  }

  // Copies bytes into the module; null is address 0.
  load(source) {
    if (!source) return {address: 0, bytes: 0};
    if (!(source instanceof ArrayBuffer || ArrayBuffer.isView(source))) throw new MienError('bytes: wrong type (expected an ArrayBuffer or a view of one)', -1);
    const data = source instanceof ArrayBuffer ? new Uint8Array(source) : new Uint8Array(source.buffer, source.byteOffset, source.byteLength);
    const address = this.allocate(data.length);
    new Uint8Array(this.memory.buffer).set(data, address);
    return {address, bytes: data.length};
  }

  text(address) {
    if (!address) return null;
    const bytes = new Uint8Array(this.memory.buffer, address);
    return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)).slice());
  }

  // Calls a function that creates an object from a struct, and returns its address. `nameOf`: names a weight file.
  create(name, config, nameOf = () => '') {
    const detail = this.struct('error_detail'), handle = this.allocate(4), bytes = 256, line = this.allocate(bytes);
    try {
      const status = this.exports[name](config, handle, detail.address);
      if (status === 0) return new DataView(this.memory.buffer).getUint32(handle, true);
      this.exports.mien_error_message(detail.address, line, bytes);
      const file = detail.get('file'), named = file >= 0 ? nameOf(file) : '';
      throw new MienError(named ? `${named}: ${this.text(line)}` : this.text(line), status);
    } finally {
      for (const address of [detail.address, handle, line]) this.release(address);
    }
  }

  check(status) {
    if (status !== 0) throw new MienError(this.text(this.exports.mien_status_string(status)), status);
  }
}
