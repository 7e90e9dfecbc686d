// Layout of the structs of mien.h on a 32-bit machine. Each field is [offset, kind, count].
import {MienError} from './error.js';

export const fields = {
  image: {
    struct_size: [0, 'u32'], format: [4, 'i32'], width: [8, 'i32'], height: [12, 'i32'], planes: [16, 'u32', 3],
    row_stride_bytes: [28, 'i32', 3], chroma_pixel_stride_bytes: [40, 'i32'], rotation: [44, 'i32'], mirrored: [48, 'i32'],
    full_range: [52, 'i32'], focal_length_px: [56, 'f32'], principal_x: [60, 'f32'], principal_y: [64, 'f32'],
    yuv_matrix: [68, 'i32'], region: [72, 'i32', 4], pixel_aspect: [88, 'f32']},
  audio: {
    struct_size: [0, 'u32'], format: [4, 'i32'], sample_rate: [8, 'i32'], channels: [12, 'i32'], planar: [16, 'i32'],
    frames: [20, 'u32'], samples: [24, 'u32', 8]},
  error_detail: {struct_size: [0, 'u32'], status: [4, 'i32'], known: [8, 'u32'], file: [12, 'i32']},
  weights_config: {struct_size: [0, 'u32'], copy: [4, 'i32'], files: [8, 'u32', 8], file_bytes: [40, 'u32', 8]},
  tracker_config: {
    struct_size: [0, 'u32'], cpu_mask: [4, 'u32'], weights: [8, 'u32'], clock_ns: [24, 'u32'], lod: [32, 'i32'], max_lod: [36, 'i32'],
    horizontal_fov: [40, 'f32'], accept_probability: [44, 'f32'], lose_probability: [48, 'f32'], lose_after_frames: [52, 'i32'],
    proposal_size: [56, 'i32'], proposal_threshold: [60, 'f32'], refine_threshold: [64, 'f32'], search_interval: [68, 'i32'],
    budget_ms: [72, 'f32'], smoothing: [76, 'i32'], max_faces: [80, 'i32'], audio: [84, 'i32'], voice_attack_ms: [88, 'f32'],
    voice_release_ms: [92, 'f32'], voice_strength: [100, 'f32']},
  result: {
    struct_size: [0, 'u32'], status: [4, 'i32'], pts_ns: [8, 'i64'], supported_controls: [16, 'u64'],
    face_probability: [24, 'f32'], voice_activity: [28, 'f32'], lod: [32, 'i32'], flags: [36, 'u32'], box: [40, 'f32', 4],
    rotation: [56, 'f32', 4], pitch: [72, 'f32'], yaw: [76, 'f32'], roll: [80, 'f32'], translation: [84, 'f32', 3],
    controls: [96, 'f32', 52], landmarks: [304, 'f32', 350], frames: [1704, 'u64'], face_frames: [1712, 'u64'],
    proposal_runs: [1720, 'u64'], encoder_runs: [1728, 'u64'], stage_ns: [1736, 'u64', 16], face_id: [1864, 'u32']},
  network_config: {
    struct_size: [0, 'u32'], cpu_mask: [4, 'u32'], weights: [8, 'u32'], name: [12, 'u32'], height: [16, 'i32'], width: [20, 'i32']},
};

// sizeof. Loading compares it with the module's, so that a changed header is detected.
export const structBytes = {image: 100, audio: 88, error_detail: 160, weights_config: 116, tracker_config: 136, result: 1928, network_config: 68};

const kinds = {
  i32: {bytes: 4, get: 'getInt32', set: 'setInt32', array: Int32Array, least: -(2 ** 31), most: 2 ** 31 - 1},
  u32: {bytes: 4, get: 'getUint32', set: 'setUint32', array: Uint32Array, least: 0, most: 2 ** 32 - 1},
  f32: {bytes: 4, get: 'getFloat32', set: 'setFloat32', array: Float32Array},
  i64: {bytes: 8, get: 'getBigInt64', set: 'setBigInt64', least: -(2n ** 63n), most: 2n ** 63n - 1n},
  u64: {bytes: 8, get: 'getBigUint64', set: 'setBigUint64', array: BigUint64Array, least: 0n, most: 2n ** 64n - 1n}};

export const outOfRange = -3;  // MIEN_ERROR_OUT_OF_RANGE

// Checks every number for the module, because JavaScript truncates values out of range and converts NaN to 0. The module checks
// the ranges of floats.
export function number(kind, value, name) {
  const {least, most} = kinds[kind], taken = ['number', 'bigint', 'boolean'].includes(typeof value);
  if (!taken) throw new MienError(`${name}: not a number (got ${typeof value})`, outOfRange);
  if (least === undefined) return Number(value);
  const whole = typeof value === 'bigint' || Number.isInteger(Number(value));
  if (whole && value >= least && value <= most) return typeof least === 'bigint' ? BigInt(value) : Number(value);
  throw new MienError(`${name}: number out of range (got ${value}, expected a whole number from ${least} to ${most})`, outOfRange);
}

// One struct at `address` in `memory`, which may grow between accesses.
export class Struct {
  constructor(memory, name, address) {
    Object.assign(this, {memory, fields: fields[name], address});
  }

  set(field, value, index = 0) {
    const [offset, kind, count = 1] = this.fields[field], {bytes, set} = kinds[kind];
    if (index >= count) throw new MienError(`${field}: too many values (expected ${count})`, outOfRange);
    new DataView(this.memory.buffer)[set](this.address + offset + index * bytes, number(kind, value, field), true);
  }

  // `names`: names of callers to names of fields; missing values do not change.
  fill(names, values) {
    for (const [name, field] of Object.entries(names)) {
      if (values[name] !== undefined) this.set(field, values[name]);
    }
  }

  addressOf(field) { return this.address + this.fields[field][0]; }

  // A number, or a copy of an array.
  get(field) {
    const [offset, kind, count] = this.fields[field], {get, array: Kind} = kinds[kind];
    if (count) return new Kind(this.memory.buffer.slice(this.address + offset, this.address + offset + count * Kind.BYTES_PER_ELEMENT));
    return new DataView(this.memory.buffer)[get](this.address + offset, true);
  }
}
