// Binary glTF of the avatar with the morph weights and the rotations of head and eyes of a recording, as `mien track` writes it; see
// docs/cli.md, glTF.
import {addAvatar} from './avatar_meshes.js';
import {GlbFile} from './glb_file.js';
import {gaze, isTracked} from './recording.js';

const head = 1, leftEye = 2, rightEye = 3, face = 4, body = 5;  // nodes

// R = Ry(yaw) Rx(pitch), x y z w.
function turn({pitch, yaw}) {
  const [cp, sp, cy, sy] = [Math.cos(pitch / 2), Math.sin(pitch / 2), Math.cos(yaw / 2), Math.sin(yaw / 2)];
  return [cy * sp, sy * cp, -sy * sp, cy * cp];
}

const unit = q => q.map(value => value / Math.hypot(...q));

// Removes keys whose times do not increase in fp32.
const atLaterTimes = frames => frames.filter((frame, i) => i === 0 || Math.fround(frame.tMs / 1000) > Math.fround(frames[i - 1].tMs / 1000));

function animation(frames, names, file) {
  const samplers = [], channels = [];
  const channel = (of, nodes, path, valuesOf, type) => {
    if (!of.length) return;
    const input = file.add(Float32Array.from(of, ({tMs}) => tMs / 1000), 'SCALAR', {bounded: true});
    const output = file.add(Float32Array.from(of.flatMap(frame => [...valuesOf(frame)])), type);
    samplers.push({input, output, interpolation: 'LINEAR'});
    channels.push(...nodes.map(node => ({sampler: samplers.length - 1, target: {node, path}})));
  };
  const tracked = frames.filter(isTracked);
  channel(frames, [face], 'weights', ({controls}) => controls, 'SCALAR');
  channel(tracked, [head], 'rotation', ({rotation}) => unit([...rotation]), 'VEC4');
  channel(tracked, [head, body], 'translation', ({translation}) => translation, 'VEC3');
  channel(frames, [leftEye], 'rotation', ({controls}) => unit(turn(gaze(controls, names).left)), 'VEC4');
  channel(frames, [rightEye], 'rotation', ({controls}) => unit(turn(gaze(controls, names).right)), 'VEC4');
  const mien = {
    start_ns: 0, states: frames.map(({status}) => status[0]).join(''), not_driven: names.filter((_, i) => !frames.some(({driven}) => driven[i]))};
  return {name: 'face', channels, samplers, extras: {mien}};
}

export function animationGlb(allFrames, names) {
  const file = new GlbFile(), frames = atLaterTimes(allFrames), {meshes, materials, eyes} = addAvatar(file, names);
  return file.finish({
    asset: {version: '2.0', generator: 'mien'}, scene: 0, scenes: [{nodes: [0]}],
    nodes: [{name: 'root', children: [head, body]}, {name: 'head', children: [leftEye, rightEye, face]},
            {name: 'leftEye', mesh: 2, translation: eyes[0]}, {name: 'rightEye', mesh: 2, translation: eyes[1]},
            {name: 'face', mesh: 0}, {name: 'body', mesh: 1}],
    materials, meshes, ...(frames.length && {animations: [animation(frames, names, file)]}),
  });
}
