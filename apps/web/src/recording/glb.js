// Binary glTF 2.0: morph weights of a small triangle whose 52 targets move nothing, and rotations of head and eyes, so
// that animation programs show named curves. Nodes: root > head > leftEye, rightEye, face.
import {gaze, isTracked} from './recording.js';

const float = 5126, leftEye = 2, rightEye = 3, face = 4, head = 1;

// Collects arrays of floats in one buffer, with an accessor for each.
class Floats {
  constructor() { Object.assign(this, {parts: [], bytes: 0, views: [], accessors: []}); }

  add(values, type, {range = false, target} = {}) {
    const data = Float32Array.from(values), components = {SCALAR: 1, VEC3: 3, VEC4: 4}[type];
    this.views.push({buffer: 0, byteOffset: this.bytes, byteLength: data.byteLength, ...(target && {target})});
    const accessor = {bufferView: this.views.length - 1, componentType: float, count: data.length / components, type};
    if (range) Object.assign(accessor, extremes(data, components));
    this.accessors.push(accessor);
    this.parts.push(data);
    this.bytes += data.byteLength;
    return this.accessors.length - 1;
  }
}

function extremes(data, components) {
  const of = pick => Array.from({length: components}, (_, k) => data.filter((_, i) => i % components === k).reduce((a, b) => pick(a, b)));
  return {min: of(Math.min), max: of(Math.max)};
}

// R = Ry(yaw) Rx(pitch), x y z w.
function turn({pitch, yaw}) {
  const [cp, sp, cy, sy] = [Math.cos(pitch / 2), Math.sin(pitch / 2), Math.cos(yaw / 2), Math.sin(yaw / 2)];
  return [cy * sp, sy * cp, -sy * sp, cy * cp];
}

// Removes keys whose times do not increase in fp32.
const atLaterTimes = frames => frames.filter((frame, i) => i === 0 || Math.fround(frame.tMs / 1000) > Math.fround(frames[i - 1].tMs / 1000));

function animation(frames, names, floats) {
  const samplers = [], channels = [];
  const channel = (of, node, path, values, type) => {
    if (!of.length) return;
    const input = floats.add(of.map(({tMs}) => tMs / 1000), 'SCALAR', {range: true});
    samplers.push({input, output: floats.add(values, type), interpolation: 'LINEAR'});
    channels.push({sampler: samplers.length - 1, target: {node, path}});
  };
  const tracked = frames.filter(isTracked), eyes = frames.map(({controls}) => gaze(controls, names));
  channel(frames, face, 'weights', frames.flatMap(({controls}) => [...controls]), 'SCALAR');
  channel(tracked, head, 'rotation', tracked.flatMap(({rotation}) => unit([...rotation])), 'VEC4');
  channel(tracked, head, 'translation', tracked.flatMap(({translation}) => [...translation]), 'VEC3');
  channel(frames, leftEye, 'rotation', eyes.flatMap(({left}) => unit(turn(left))), 'VEC4');
  channel(frames, rightEye, 'rotation', eyes.flatMap(({right}) => unit(turn(right))), 'VEC4');
  return {name: 'face', samplers, channels};
}

const unit = q => q.map(value => value / Math.hypot(...q));

export function animationGlb(allFrames, names) {
  const floats = new Floats(), frames = atLaterTimes(allFrames);
  const recorded = animation(frames, names, floats);
  const position = floats.add([0, 0, 0, 0.01, 0, 0, 0, 0.01, 0], 'VEC3', {range: true, target: 34962});
  const still = floats.add(new Array(9).fill(0), 'VEC3', {range: true, target: 34962});
  return container({
    asset: {version: '2.0', generator: 'mien'}, scene: 0, scenes: [{nodes: [0]}],
    nodes: [{name: 'root', children: [head]}, {name: 'head', children: [leftEye, rightEye, face]}, {name: 'leftEye'}, {name: 'rightEye'},
            {name: 'face', mesh: 0}],
    meshes: [{name: 'face', primitives: [{attributes: {POSITION: position}, targets: names.map(() => ({POSITION: still}))}],
              weights: names.map(() => 0), extras: {targetNames: names}}],
    animations: recorded.channels.length ? [recorded] : undefined,
    buffers: [{byteLength: floats.bytes}], bufferViews: floats.views, accessors: floats.accessors,
  }, floats.parts);
}

// JSON chunk and binary chunk, each padded to four bytes.
function container(json, parts) {
  const text = new TextEncoder().encode(JSON.stringify(json)), textBytes = text.length + 3 & ~3;
  const binaryBytes = parts.reduce((sum, part) => sum + part.byteLength, 0);
  const file = new Uint8Array(12 + 8 + textBytes + 8 + binaryBytes), view = new DataView(file.buffer);
  [0x46546c67, 2, file.length, textBytes, 0x4e4f534a].forEach((value, i) => view.setUint32(i * 4, value, true));
  file.fill(0x20, 20, 20 + textBytes);
  file.set(text, 20);
  view.setUint32(20 + textBytes, binaryBytes, true);
  view.setUint32(24 + textBytes, 0x004e4942, true);
  let offset = 28 + textBytes;
  for (const part of parts) {
    file.set(new Uint8Array(part.buffer), offset);
    offset += part.byteLength;
  }
  return file;
}
