// A tracker of mien.h.
import {MienError} from './error.js';
import {FrameReader, timeOf} from './frames.js';
import {number, outOfRange} from './layout.js';

const alignment = 64;  // MIEN_ALIGNMENT
const imageFormats = {gray8: 0, rgb: 1, bgr: 2, rgba: 3, bgra: 4, nv12: 5, nv21: 6, i420: 7};
const faceStatus = ['searching', 'tracking', 'lost'];
const visemes = {vocabulary: 5, count: 15};  // MIEN_VOCABULARY_VISEMES
const defaultMask = 0xffffffff;  // MIEN_CPU_ALL
// MIEN_ERROR_*
const wrong = {argument: -1, format: -60, size: -61, stride: -62, plane: -63, samples: -66};
// The name of the type, such as "Float32Array", also for arrays of another window or worker; undefined if it is not a typed array.
const kindOf = data => (ArrayBuffer.isView(data) ? data[Symbol.toStringTag] : undefined);
const isBytes = data => ['Uint8Array', 'Uint8ClampedArray'].includes(kindOf(data));

function nanoseconds(time, name = 'ptsNs') {
  if (typeof time !== 'bigint' && !Number.isFinite(time)) throw new MienError(`${name}: not a finite number (got ${time})`, outOfRange);
  return number('i64', typeof time === 'bigint' ? time : BigInt(Math.round(time)), name);
}

// Memory of the module, kept at the largest size requested so far.
class Buffer {
  constructor(mien) { Object.assign(this, {mien, address: 0, bytes: 0}); }

  reserve(bytes) {
    if (bytes > this.bytes) {
      this.free();
      this.address = this.mien.allocate(bytes);
      this.bytes = bytes;
    }
    return this.address;
  }

  free() {
    this.mien.release(this.address);
    this.address = this.bytes = 0;
  }
}

const configNames = {
  lod: 'lod', maxLod: 'max_lod', audio: 'audio', cpuMask: 'cpu_mask', horizontalFov: 'horizontal_fov', acceptProbability: 'accept_probability',
  loseProbability: 'lose_probability', loseAfterFrames: 'lose_after_frames', proposalSize: 'proposal_size',
  proposalThreshold: 'proposal_threshold', refineThreshold: 'refine_threshold', searchInterval: 'search_interval',
  budgetMs: 'budget_ms', smoothing: 'smoothing', maxFaces: 'max_faces', voiceAttackMs: 'voice_attack_ms', voiceReleaseMs: 'voice_release_ms',
  voiceStrength: 'voice_strength'};
const imageNames = {
  chromaPixelStrideBytes: 'chroma_pixel_stride_bytes', rotation: 'rotation', mirrored: 'mirrored', fullRange: 'full_range',
  focalLengthPx: 'focal_length_px', principalX: 'principal_x', principalY: 'principal_y', bt709: 'yuv_matrix',
  pixelAspect: 'pixel_aspect'};

// The number of rows and of bytes per row of each plane, without padding. `step`: bytes between samples of I420's U or V.
function planeSizes(format, width, height, step) {
  const half = {width: (width + 1) >> 1, height: (height + 1) >> 1};
  const luma = {row: width, rows: height};
  switch (format) {
    case 'gray8': return [luma];
    case 'rgb': case 'bgr': return [{row: width * 3, rows: height}];
    case 'rgba': case 'bgra': return [{row: width * 4, rows: height}];
    case 'nv12': case 'nv21': return [luma, {row: half.width * 2, rows: half.height}];
    case 'i420': {
      const chroma = {row: (half.width - 1) * (step || 1) + 1, rows: half.height};
      return [luma, chroma, chroma];
    }
    default: throw new MienError(`'${format}' is no image format`, wrong.format);
  }
}

export class Tracker {
  constructor(mien, config) {
    this.mien = mien;
    this.handle = 0;
    this.image = mien.struct('image');
    this.audio = mien.struct('audio');
    this.result = mien.struct('result');
    this.visemes = mien.allocate(4 * visemes.count);
    this.pixels = new Buffer(mien);
    this.samples = new Buffer(mien);
    this.reader = new FrameReader();
    this.last = Promise.resolve();
    try {
      this.create(config);
    } catch (error) {
      this.destroy();
      throw error;
    }
  }

  create(config) {
    const {mien} = this, struct = mien.struct('tracker_config');
    try {
      if (!config.weights?.address) throw new MienError('weights: missing (expected the result of createWeights)', wrong.argument);
      struct.fill(configNames, {cpuMask: defaultMask, ...config});
      struct.set('weights', config.weights.address());
      struct.set('clock_ns', mien.exports.mien_module_clock());
      this.handle = mien.create('mien_tracker_create', struct.address);
    } finally {
      mien.release(struct.address);
    }
  }

  call(name, ...values) { this.mien.check(this.mien.exports['mien_tracker_' + name](this.handle, ...values)); }

  destroy() {
    if (this.handle) this.mien.exports.mien_tracker_destroy(this.handle);
    for (const buffer of [this.pixels, this.samples]) buffer.free();
    for (const address of [this.image?.address, this.audio?.address, this.result?.address, this.visemes]) this.mien.release(address);
    this.handle = 0;
    this.image = this.audio = this.result = null;
    this.visemes = 0;
  }

  reset() { this.call('reset'); }
  setLod(lod) { this.call('set_lod', number('i32', lod, 'lod')); }
  advance(ptsNs) { this.call('advance', nanoseconds(ptsNs)); }
  captureNeutral() { this.call('capture_neutral'); }
  setAudioOffset(offsetNs) { this.call('set_audio_offset', nanoseconds(offsetNs, 'offsetNs')); }
  setMix(control, audioWeight, videoWeight) {
    const index = typeof control === 'string' ? this.mien.controlNames.indexOf(control) : control;
    this.call('set_mix', number('i32', index, 'control'), number('f32', audioWeight, 'audioWeight'), number('f32', videoWeight, 'videoWeight'));
  }

  pushVideo(image, ptsNs) {
    this.checkOpen();
    const {format = 'rgba', width, height, chromaPixelStrideBytes = 0} = image;
    for (const [name, value] of Object.entries({width, height, chromaPixelStrideBytes})) number('i32', value, name);
    if (width < 0 || height < 0) throw new MienError(`an image of ${width} x ${height}`, wrong.size);
    if (chromaPixelStrideBytes < 0) throw new MienError(`chromaPixelStrideBytes: negative (got ${chromaPixelStrideBytes})`, wrong.stride);
    const sizes = planeSizes(format, width, height, chromaPixelStrideBytes);
    const planes = image.planes ?? this.split(image.data, sizes);
    const strides = image.rowStrideBytes ?? sizes.map(({row}) => row);
    sizes.forEach((size, i) => this.checkPlane(planes[i], strides[i], size));
    const used = sizes.map(({rows}, i) => Math.min(planes[i].byteLength, strides[i] * rows));
    const start = this.pixels.reserve(used.reduce((sum, bytes) => sum + bytes + alignment, 0));
    const heap = new Uint8Array(this.mien.memory.buffer);
    this.mien.exports.mien_image_default(this.image.address);
    this.image.fill(imageNames, image);
    this.image.set('format', imageFormats[format]);
    this.image.set('width', width);
    this.image.set('height', height);
    (image.region ?? []).forEach((side, i) => this.image.set('region', side, i));
    let address = start;
    sizes.forEach((_, i) => {
      heap.set(new Uint8Array(planes[i].buffer, planes[i].byteOffset, used[i]), address);
      this.image.set('planes', address, i);
      this.image.set('row_stride_bytes', strides[i], i);
      address += used[i];
    });
    this.call('push_video', this.image.address, nanoseconds(ptsNs));
  }

  // One source at a time, in the order of the calls.
  track(source, ptsNs = timeOf(source)) {
    const result = this.last.then(async () => {
      this.checkOpen();
      const image = await this.reader.read(source);
      this.throwAudioError();
      this.pushVideo(image, ptsNs);
      return this.getResult();
    });
    this.last = result.catch(() => {});
    return result;
  }

  // One buffer with the planes one after another.
  split(data, sizes) {
    if (!isBytes(data)) throw new MienError('data: neither Uint8Array nor Uint8ClampedArray', wrong.plane);
    let offset = 0;
    return sizes.map(({row, rows}) => {
      const plane = new Uint8Array(data.buffer, data.byteOffset + offset, Math.max(0, Math.min(row * rows, data.byteLength - offset)));
      offset += row * rows;
      return plane;
    });
  }

  checkPlane(plane, stride, {row, rows}) {
    if (!isBytes(plane)) throw new MienError('planes: wrong type (expected Uint8Array or Uint8ClampedArray)', wrong.plane);
    number('i32', stride, 'rowStrideBytes');
    if (stride < row) throw new MienError(`rows of ${row} bytes do not fit into ${stride}`, wrong.stride);
    if (plane.byteLength < stride * (rows - 1) + row) {
      throw new MienError(`a plane has ${plane.byteLength} bytes, less than its rows`, wrong.plane);
    }
  }

  checkOpen() { if (!this.handle) throw new MienError('the tracker was destroyed', wrong.argument); }

  // `samples`: Float32Array or Int16Array, channels interleaved.
  pushAudio(samples, {sampleRate, channels = 1}, ptsNs) {
    this.checkOpen();
    const kind = kindOf(samples);
    if (kind !== 'Float32Array' && kind !== 'Int16Array') {
      throw new MienError(`samples: wrong type (got ${kind ?? typeof samples}, expected Float32Array or Int16Array)`, wrong.samples);
    }
    const address = this.samples.reserve(samples.byteLength);
    new Uint8Array(this.mien.memory.buffer).set(new Uint8Array(samples.buffer, samples.byteOffset, samples.byteLength), address);
    this.audio.set('format', kind === 'Int16Array' ? 1 : 0);
    this.audio.set('sample_rate', sampleRate);
    this.audio.set('channels', channels);
    this.audio.set('frames', channels >= 1 ? Math.floor(samples.length / channels) : 0);
    this.audio.set('samples', address);
    this.call('push_audio', this.audio.address, nanoseconds(ptsNs));
  }

  // Takes audio from the port of an audio worklet until an error, which the next track() reports.
  connectAudio(port) {
    port.onmessage = ({data: {samples, sampleRate, timeMs}}) => {
      try {
        this.pushAudio(samples, {sampleRate}, timeMs * 1e6);
      } catch (error) {
        port.onmessage = null;
        if (this.handle) this.audioError = error;
      }
    };
  }

  throwAudioError() {
    const {audioError} = this;
    this.audioError = undefined;
    if (audioError) throw audioError;
  }

  getResult() {
    this.checkOpen();
    this.call('get_result', this.result.address);
    return this.readResult();
  }

  faceCount() { return this.mien.exports.mien_tracker_face_count(this.handle); }

  getFace(index) {
    this.checkOpen();
    this.call('get_face', number('i32', index, 'index'), this.result.address);
    return this.readResult();
  }

  readResult() {
    const get = field => this.result.get(field), stages = get('stage_ns');
    return {
      status: faceStatus[get('status')], ptsNs: get('pts_ns'), supportedControls: get('supported_controls'),
      faceProbability: get('face_probability'), voiceActivity: get('voice_activity'), lod: get('lod'), flags: get('flags'),
      box: get('box'), rotation: get('rotation'), pitch: get('pitch'), yaw: get('yaw'), roll: get('roll'),
      translation: get('translation'), controls: get('controls'), ...this.readVisemes(get('supported_controls')), landmarks: get('landmarks'),
      frames: get('frames'), faceFrames: get('face_frames'), proposalRuns: get('proposal_runs'), encoderRuns: get('encoder_runs'),
      stageNs: Object.fromEntries(this.mien.stageNames.map((name, i) => [name, Number(stages[i])])), faceId: get('face_id')};
  }

  readVisemes(supportedControls) {
    const {vocabulary, count} = visemes, {mien_vocabulary_values: values, mien_vocabulary_supported: supported} = this.mien.exports;
    this.mien.check(values(vocabulary, this.result.addressOf('controls'), this.visemes, count));
    return {visemes: new Float32Array(this.mien.memory.buffer.slice(this.visemes, this.visemes + 4 * count)),
            supportedVisemes: Number(supported(vocabulary, supportedControls))};
  }

  // The file of 448 bytes, and which levels it has: bit 0 level 1, bit 1 the others.
  saveNeutral() {
    const bytes = 448, address = this.mien.allocate(bytes + 4);
    try {
      this.call('save_neutral', address, bytes, address + bytes);
      return {file: new Uint8Array(this.mien.memory.buffer.slice(address, address + bytes)),
              captured: new DataView(this.mien.memory.buffer).getUint32(address + bytes, true)};
    } finally {
      this.mien.release(address);
    }
  }

  loadNeutral(file) {
    const {address, bytes} = this.mien.load(file);
    try {
      this.call('load_neutral', address, bytes);
    } finally {
      this.mien.release(address);
    }
  }
}
