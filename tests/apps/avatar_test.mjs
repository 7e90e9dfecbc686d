// Tests of `--avatar` with other programs: Khronos' validator reports no error, and three.js plays the avatars as the animation says.
// usage: avatar_test.mjs MIEN_PROGRAM PACKAGES        PACKAGES fetched by scripts/peers/install_gltf.sh
import assert from 'node:assert/strict';
import {execFileSync, spawnSync} from 'node:child_process';
import fs from 'node:fs';
import {createRequire} from 'node:module';
import os from 'node:os';
import path from 'node:path';
import {test} from 'node:test';
import {pathToFileURL} from 'node:url';

const [program, packages] = process.argv.slice(2);
const modules = path.join(packages, 'node_modules');
const validator = createRequire(path.join(modules, 'x.js'))('gltf-validator');
const load = name => import(pathToFileURL(path.join(modules, name)));
const THREE = await load('three/build/three.module.js');
const {GLTFLoader} = await load('three/examples/jsm/loaders/GLTFLoader.js');

const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'mien_avatar_'));
process.on('exit', () => fs.rmSync(folder, {recursive: true}));
const file = name => path.join(folder, name);

const YAW = 0.5, PITCH = 0.25;
const controls = {
  jawOpen: 0.5, mouthSmileLeft: 0.75, mouthSmileRight: 0.25, eyeBlinkLeft: 1, eyeBlinkRight: 0.5, eyeLookDownLeft: 0.5, eyeLookDownRight: 0.5};
const frame = (t_ns, share) => JSON.stringify({
  t_ns, status: 'tracking', controls: Object.fromEntries(Object.entries(controls).map(([name, value]) => [name, value * share])),
  head: {pitch_rad: PITCH * share, yaw_rad: YAW * share, roll_rad: 0}, position_m: [0, 0, -0.5]}) + '\n';
fs.writeFileSync(file('clip.jsonl'), frame(0, 0) + frame(1e9, 1));

const nodes = {root: 0, neck: 1, head: 2, leftEye: 3, rightEye: 4, face: 5};
const half = Math.SQRT1_2;

// A triangle with morph targets under a head whose parents are turned, as exporters turn them.
function avatar(names, change = () => {}) {
  const data = Buffer.alloc(92);  // positions, morph targets, a key of the identity
  data.writeFloatLE(1, 88);
  [0, 0, 0, 1, 0, 0, 0, 1, 0].forEach((side, i) => data.writeFloatLE(side, 4 * i));
  const vec3 = {componentType: 5126, type: 'VEC3', count: 3};
  const document = {
    asset: {version: '2.0', generator: 'test'}, scene: 0, scenes: [{nodes: [0]}],
    nodes: [
      {name: 'Armature', children: [1], rotation: [half, 0, 0, half]}, {name: 'mixamorig:Neck', children: [2], rotation: [0, half, 0, half]},
      {name: 'mixamorig:Head', children: [3, 4, 5], translation: [0, 1, 0], rotation: [0, 0, half, half]}, {name: 'LeftEye'}, {name: 'RightEye'},
      {name: 'Face', mesh: 0}],
    meshes: [{
      primitives: [{attributes: {POSITION: 0}, targets: names.map(() => ({POSITION: 1}))}], weights: names.map((_, i) => i === 0 ? 0.125 : 0),
      extras: {targetNames: names, note: 'kept'}}],
    accessors: [{...vec3, bufferView: 0, min: [0, 0, 0], max: [1, 1, 0]}, {...vec3, bufferView: 1, min: [0, 0, 0], max: [0, 0, 0]}],
    bufferViews: [{buffer: 0, byteOffset: 0, byteLength: 36, target: 34962}, {buffer: 0, byteOffset: 36, byteLength: 36, target: 34962}],
    buffers: [{byteLength: 72}]};
  change(document);
  return glb(document, data);
}

function glb(document, data) {
  const json = Buffer.from(JSON.stringify(document)), padded = Buffer.concat([json, Buffer.alloc(-json.length & 3, ' ')]);
  const u32 = (...values) => Buffer.from(Uint32Array.from(values).buffer);
  return Buffer.concat([
    u32(0x46546C67, 2, 28 + padded.length + data.length, padded.length, 0x4E4F534A), padded, u32(data.length, 0x004E4942), data]);
}

const documentOf = bytes => JSON.parse(bytes.subarray(20, 20 + bytes.readUInt32LE(12)));

async function baked(bytes) {
  fs.writeFileSync(file('avatar.glb'), bytes);
  execFileSync(program, ['convert', file('clip.jsonl'), file('out.glb'), '--avatar', file('avatar.glb'), '--quiet']);
  const output = fs.readFileSync(file('out.glb'));
  const {issues} = await validator.validateBytes(new Uint8Array(output));
  assert.equal(issues.numErrors, 0, JSON.stringify(issues.messages));
  return output;
}

// The scene at the last frame of the animation, and at rest.
async function played(output) {
  const parse = () => new Promise((resolve, reject) =>
    new GLTFLoader().parse(output.buffer.slice(output.byteOffset, output.byteOffset + output.length), '', resolve, reject));
  const rest = await parse(), moved = await parse();
  const mixer = new THREE.AnimationMixer(moved.scene), action = mixer.clipAction(THREE.AnimationClip.findByName(moved.animations, 'mien'));
  action.setLoop(THREE.LoopOnce).clampWhenFinished = true;
  action.play();
  mixer.update(1);
  for (const {scene} of [rest, moved]) scene.updateMatrixWorld(true);
  return {rest: rest.scene, moved: moved.scene, animations: moved.animations};
}

const weights = scene => {
  let found;
  scene.traverse(node => { if (node.morphTargetInfluences) found = node; });
  return found.morphTargetInfluences;
};
const near = (a, b, what) => assert.ok(Math.abs(a - b) < 1e-5, `${what}: ${a} instead of ${b}`);

// The rotation of a node in the scene, from its rest.
function turn({rest, moved}, name) {
  const rotation = scene => scene.getObjectByName(name).getWorldQuaternion(new THREE.Quaternion());
  return rotation(moved).multiply(rotation(rest).invert());
}
const angles = (pitch, yaw) => new THREE.Quaternion().setFromEuler(new THREE.Euler(pitch, yaw, 0, 'YXZ'));
const same = (a, b, what) => assert.ok(a.angleTo(b) < 1e-3, `${what}: ${a.toArray()} instead of ${b.toArray()}`);

test('names of ARKit in several spellings', async () => {
  const result = await played(await baked(avatar(['Custom', 'Face.M_F.jawOpen', 'mouthSmile_L', 'MouthSmileRight', 'viseme_aa'])));
  [0.125, 0.5, 0.75, 0.25, 0].forEach((value, i) => near(weights(result.moved)[i], value, `target ${i}`));
  near(weights(result.rest)[0], 0.125, 'rest');
});

test('head and eyes turn about the axes of the scene', async () => {
  const result = await played(await baked(avatar(['jawOpen'])));
  same(turn(result, 'mixamorigHead'), angles(PITCH, YAW), 'head');
  same(turn(result, 'LeftEye'), angles(PITCH, YAW).multiply(angles(0.485 / 2, 0)), 'eye');
});

test('eyes with morph targets that look do not turn as well', async () => {
  const result = await played(await baked(avatar(['jawOpen', 'eyeLookInLeft', 'eyeLookDownLeft'])));
  near(weights(result.moved)[2], 0.5, 'eyeLookDownLeft');
  same(turn(result, 'LeftEye'), angles(PITCH, YAW), 'eye');
});

test('a head with a matrix keeps its place and size', async () => {
  const bytes = avatar(['jawOpen'], ({nodes: [, , head]}) => {
    delete head.rotation;
    delete head.translation;
    head.matrix = [0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 3, 1, 0, 1];
  });
  const result = await played(await baked(bytes));
  const head = result.moved.getObjectByName('mixamorigHead');
  assert.deepEqual(head.position.toArray(), [3, 1, 0]);
  near(head.scale.x, 2, 'scale');
  same(turn(result, 'mixamorigHead'), angles(PITCH, YAW), 'head');
});

test('the rest of the file stays as it is', async () => {
  const bytes = avatar(['jawOpen'], document => {
    document.animations = [{
      name: 'idle', samplers: [{input: 2, output: 3}], channels: [{sampler: 0, target: {node: nodes.neck, path: 'rotation'}}]}];
    document.accessors.push({bufferView: 2, componentType: 5126, type: 'SCALAR', count: 1, min: [0], max: [0]});
    document.accessors.push({bufferView: 2, componentType: 5126, type: 'VEC4', count: 1, byteOffset: 4});
    document.bufferViews.push({buffer: 0, byteOffset: 72, byteLength: 20});
    document.buffers[0].byteLength = 92;
    document.extras = {licence: 'CC0 \u{1F600}', big: 12345678901234567n.toString(), pi: 3.141592653589793};
  });
  const before = documentOf(bytes), after = documentOf(await baked(bytes));
  assert.deepEqual(after.extras, before.extras);
  assert.deepEqual(after.animations.map(({name}) => name), ['mien', 'idle']);
  for (const [key, value] of Object.entries(before)) {
    if (Array.isArray(value) && key !== 'animations' && key !== 'buffers') assert.deepEqual(after[key].slice(0, value.length), value, key);
  }
});

test('visemes move a mouth without a jaw', async () => {
  execFileSync(program, ['convert', file('clip.jsonl'), file('clip.visemes.csv'), '--quiet']);
  const [header, , last] = fs.readFileSync(file('clip.visemes.csv'), 'utf8').trim().split('\n').map(line => line.split(','));
  const of = {viseme_aa: 'aa', viseme_E: 'E', viseme_I: 'ih', viseme_O: 'oh'};
  const {moved} = await played(await baked(avatar([...Object.keys(of), 'eyeBlinkLeft'])));
  Object.values(of).forEach((name, i) => near(weights(moved)[i], Number(last[header.indexOf(name)]), name));
  near(weights(moved)[4], 1, 'eyeBlinkLeft');
});

const bind0 = (presetName, index, weight = 100, name = presetName) => ({name, presetName, binds: [{mesh: 0, index, weight}]});
const humanBones0 = Object.entries({head: 2, leftEye: 3, rightEye: 4}).map(([bone, node]) => ({bone, node}));

test('VRM 0.x looks along -z; presets', async () => {
  const result = await played(await baked(avatar(['m0', 'm1', 'm2', 'm3'], document => {
    document.extensionsUsed = ['VRM'];
    document.extensions = {VRM: {humanoid: {humanBones: humanBones0}, blendShapeMaster: {blendShapeGroups: [
      bind0('a', 0, 50), bind0('joy', 1), bind0('blink_l', 2), bind0('blink', 3), {...bind0('unknown', 3), name: 'Custom'}]}}};
  })));
  [0.25, 0.5, 1, 0].forEach((value, i) => near(weights(result.moved)[i], value, `target ${i}`));
  const back = new THREE.Quaternion(0, 1, 0, 0);
  same(turn(result, 'mixamorigHead'), back.clone().multiply(angles(PITCH, YAW)).multiply(back.clone().invert()), 'head');
});

test('VRM 0.x with custom groups of all ARKit names', async () => {
  const names = Object.keys(JSON.parse(execFileSync(program, ['convert', file('clip.jsonl'), '-', '--to', 'jsonl', '--quiet'], {encoding: 'utf8'})
    .split('\n')[0]).controls);
  const arkit = [...names, ...[...Array(20).keys()].map(i => `${['mouthDimple', 'mouthFrown', 'mouthPress', 'mouthStretch', 'browDown', 'browOuterUp',
    'cheekSquint', 'noseSneer', 'mouthUpperUp', 'mouthLowerDown'][i >> 1]}${i % 2 ? 'Right' : 'Left'}`)];
  const {moved} = await played(await baked(avatar(arkit.map((_, i) => `m${i}`), document => {
    document.extensionsUsed = ['VRM'];
    document.extensions = {VRM: {humanoid: {humanBones: humanBones0}, blendShapeMaster: {blendShapeGroups: [
      ...arkit.map((name, i) => bind0('unknown', i, 100, name[0].toUpperCase() + name.slice(1))), bind0('a', 0)]}}};
  })));
  names.forEach((name, i) => near(weights(moved)[i], controls[name], name));
});

test('VRM 1.0: one blink for both eyes, custom expressions', async () => {
  const bind = (index, weight = 1) => ({morphTargetBinds: [{node: nodes.face, index, weight}]});
  const result = await played(await baked(avatar(['m0', 'm1', 'm2'], document => {
    document.extensionsUsed = ['VRMC_vrm'];
    document.extensions = {VRMC_vrm: {
      specVersion: '1.0', meta: {}, humanoid: {humanBones: {head: {node: nodes.head}}},
      expressions: {preset: {aa: bind(0, 0.5), blink: bind(1)}, custom: {Other: bind(2)}}}};
  })));
  [0.25, 0.75, 0].forEach((value, i) => near(weights(result.moved)[i], value, `target ${i}`));
  same(turn(result, 'mixamorigHead'), angles(PITCH, YAW), 'head');
});

function rejected(bytes, code, message, args = [file('clip.jsonl'), file('new.glb'), '--avatar', file('bad.glb')]) {
  fs.writeFileSync(file('bad.glb'), bytes);
  const {status, stderr} = spawnSync(program, ['convert', ...args], {encoding: 'utf8'});
  assert.equal(status, code, stderr);
  assert.match(stderr, message);
  assert.ok(!fs.existsSync(file('new.glb')));
}

test('files that are no avatar are rejected', () => {
  const good = avatar(['jawOpen']);
  rejected('{"asset":{}}', 3, /not a \.glb or \.vrm/);
  rejected(good.subarray(0, good.length - 4), 3, /wrong file length/);
  rejected(avatar(['x'], ({nodes: [, , head]}) => { head.name = 'Torso'; }), 3, /no morph target with a known name/);
  rejected(avatar(['jawOpen'], document => { document.buffers[0].uri = 'beside.bin'; }), 3, /buffers in other files/);
  rejected(avatar(['jawOpen'], document => { document.nodes[5].mesh = 7; }), 3, /invalid glTF/);
  rejected(avatar(['jawOpen'], document => { document.nodes[1].children = [9]; }), 3, /invalid glTF/);
  rejected(avatar(['jawOpen'], document => { document.nodes[0].children = 'x'; }), 3, /invalid glTF/);
  rejected(avatar(['jawOpen'], document => { document.extras = JSON.parse('['.repeat(200) + ']'.repeat(200)); }), 3, /nested too deeply/);
});

test('usage', () => {
  rejected(avatar(['jawOpen']), 2, /--avatar: no output for it/, [file('clip.jsonl'), file('new.csv'), '--avatar', file('bad.glb')]);
  rejected(avatar(['jawOpen']), 2, /bad\.glb/, [file('clip.jsonl'), file('bad.glb'), '--avatar', file('bad.glb')]);
});

test('a cycle of nodes ends', async () => {
  fs.writeFileSync(file('cycle.glb'), avatar(['jawOpen'], ({nodes: list}) => { list[2].children = [1, 3, 4, 5]; }));
  execFileSync(program, ['convert', file('clip.jsonl'), file('cycled.glb'), '--avatar', file('cycle.glb'), '--quiet']);
});
