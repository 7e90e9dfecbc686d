// Tests of mien's glTF with other programs: Khronos' validator reports no error and no warning, and three.js plays it.
// usage: gltf_test.mjs MIEN_PROGRAM PACKAGES        PACKAGES fetched by scripts/peers/install_gltf.sh
// The file contains the avatar that apps/web/avatar/bake.mjs writes, as do recordings of the web page.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import { createRequire } from 'node:module';
import os from 'node:os';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { controlNames } from '../../apps/web/avatar/avatar.js';
import { animationGlb } from '../../apps/web/src/recording/glb.js';

globalThis.ProgressEvent ??= class extends Event {}; // of browsers; three.js fetches data: URIs as they do

const [program, packages] = process.argv.slice(2);
const modules = path.join(packages, 'node_modules');
const validator = createRequire(path.join(modules, 'x.js'))('gltf-validator');
const load = (name) => import(pathToFileURL(path.join(modules, name)));
const THREE = await load('three/build/three.module.js');
const { GLTFLoader } = await load('three/examples/jsm/loaders/GLTFLoader.js');

const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'mien_gltf_'));
const file = (name) => path.join(folder, name);
const convert = (a, b) => execFileSync(program, ['convert', file(a), file(b), '--quiet']);

async function validate(name) {
  const { issues } = await validator.validateBytes(new Uint8Array(fs.readFileSync(file(name))));
  assert.equal(issues.numErrors, 0, JSON.stringify(issues.messages));
  assert.equal(issues.numWarnings, 0, JSON.stringify(issues.messages));
}

const loadGlb = (name) => new GLTFLoader().parseAsync(new Uint8Array(fs.readFileSync(file(name))).buffer, '');

const frames = [];
for (let i = 0; i <= 30; ++i) {
  frames.push({
    t_ns: i * 1e9 / 30 | 0, status: i < 5 ? 'searching' : 'tracking', controls: { jawOpen: i / 30, mouthSmileLeft: 0.25, eyeLookDownLeft: i / 30 },
    ...(i >= 5 && { head: { pitch_rad: 0, yaw_rad: i / 30, roll_rad: 0 }, position_m: [0, 0, -0.5 - i / 100] }),
  });
}
fs.writeFileSync(file('clip.jsonl'), frames.map((frame) => JSON.stringify(frame) + '\n').join(''));
fs.writeFileSync(file('one.jsonl'), JSON.stringify(frames[10]) + '\n');
fs.writeFileSync(file('nobody.jsonl'), JSON.stringify({ t_ns: 0, status: 'searching' }) + '\n');
for (const name of ['clip', 'one', 'nobody']) {
  for (const ending of ['.glb', '.gltf']) {
    convert(name + '.jsonl', name + ending);
    await validate(name + ending);
  }
}

for (const name of ['clip.glb', 'clip.gltf']) {
  const bytes = fs.readFileSync(file(name));
  const data = name.endsWith('.glb') ? bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length) : bytes.toString();
  const gltf = await new GLTFLoader().parseAsync(data, '');
  const mesh = gltf.scene.getObjectByName('face');
  const head = gltf.scene.getObjectByName('head');
  assert.equal(Object.keys(mesh.morphTargetDictionary).length, 52);
  assert.equal(mesh.morphTargetInfluences.length, 52);
  const mixer = new THREE.AnimationMixer(gltf.scene);
  mixer.clipAction(gltf.animations[0]).play();
  mixer.setTime(0.5);
  const weight = (control) => mesh.morphTargetInfluences[mesh.morphTargetDictionary[control]];
  assert.ok(Math.abs(weight('jawOpen') - 0.5) < 1e-4, `${weight('jawOpen')}`);
  assert.ok(Math.abs(weight('mouthSmileLeft') - 0.25) < 1e-6);
  assert.equal(weight('tongueOut'), 0);
  const turn = new THREE.Euler().setFromQuaternion(head.quaternion, 'YXZ');
  assert.ok(Math.abs(turn.y - 0.5) < 1e-4 && Math.abs(turn.x) < 1e-6, `${turn.y}`);
  assert.ok(Math.abs(head.position.z + 0.65) < 1e-4, `${head.position.z}`);
  const eye = new THREE.Euler().setFromQuaternion(gltf.scene.getObjectByName('leftEye').quaternion, 'YXZ');
  assert.ok(Math.abs(eye.x - 0.485 / 2) < 1e-4, `${eye.x}`); // looks down
}

// The avatar: 0.15 m wide between the ears; each control except gaze to the side, which turns the eyes, moves its side of the face.
{
  const gltf = await loadGlb('clip.glb');
  const mesh = gltf.scene.getObjectByName('face'), { position, normal, color } = mesh.geometry.attributes;
  assert.equal(normal.count, position.count);
  assert.equal(color.count, position.count);
  const size = new THREE.Box3().setFromBufferAttribute(position).getSize(new THREE.Vector3());
  assert.ok(size.x > 0.15 && size.x < 0.2 && size.y > 0.15 && size.y < 0.25, `${size.toArray()}`);
  for (const [name, target] of Object.entries(mesh.morphTargetDictionary)) {
    const moved = mesh.geometry.morphAttributes.position[target], largest = { left: 0, right: 0 };
    for (let i = 0; i < moved.count; ++i) {
      const offset = Math.hypot(moved.getX(i), moved.getY(i), moved.getZ(i)), side = position.getX(i) > 0 ? 'left' : 'right';
      largest[side] = Math.max(largest[side], offset);
    }
    if (/eyeLook(In|Out)/.test(name)) continue;
    const sided = !/^(jaw|mouth)(Left|Right)$/.test(name), sides = [!sided || !/Right$/.test(name), !sided || !/Left$/.test(name)];
    assert.ok(largest.left > 0.002 || !sides[0], `${name}: ${JSON.stringify(largest)}`);
    assert.ok(largest.right > 0.002 || !sides[1], `${name}: ${JSON.stringify(largest)}`);
    if (/^eye(?!Look)/.test(name)) assert.ok(Math.min(largest.left, largest.right) < 0.001, `${name}: ${JSON.stringify(largest)}`);
  }
  const mixer = new THREE.AnimationMixer(gltf.scene);
  mixer.clipAction(gltf.animations[0]).play();
  mixer.setTime(0.5);
  const [head, body] = ['head', 'body'].map((name) => gltf.scene.getObjectByName(name));
  assert.deepEqual(body.position.toArray(), head.position.toArray());
  assert.equal(body.quaternion.w, 1);

  const source = new URL('../..', import.meta.url).pathname;
  execFileSync(process.execPath, [source + 'apps/web/avatar/bake.mjs', file('avatar.bin')]);
  execFileSync('python3', [source + 'scripts/package/pack_weights.py', '--any', file('avatar.bin'), file('avatar.packed')]);
  assert.ok(fs.readFileSync(file('avatar.packed')).equals(fs.readFileSync(source + 'apps/animation/avatar.packed')),
    'apps/animation/avatar.packed: not the avatar of apps/web/avatar (run bake.mjs)');
}
// A recording of the page has the meshes and keys that the program writes for the same frames.
{
  fs.writeFileSync(file('page.glb'), animationGlb(frames.map(({ t_ns, status, controls, head, position_m }) => ({
    tMs: t_ns / 1e6, status, controls: controlNames.map((name) => controls[name] ?? 0), driven: controlNames.map((name) => Number(name in controls)),
    rotation: [0, Math.sin((head?.yaw_rad ?? 0) / 2), 0, Math.cos((head?.yaw_rad ?? 0) / 2)], translation: position_m ?? [0, 0, 0] })), controlNames));
  await validate('page.glb');
  const [page, ours] = await Promise.all(['page.glb', 'clip.glb'].map(loadGlb));
  const alike = (a, b, most, what) => {
    assert.equal(a.length, b.length, what);
    a.forEach((value, i) => assert.ok(Math.abs(value - b[i]) <= most, `${what} ${i}: ${value}, ${b[i]}`));
  };
  for (const name of ['face', 'body', 'leftEye', 'rightEye']) {
    const [a, b] = [page, ours].map(({ scene }) => scene.getObjectByName(name)), of = ({ geometry }) => geometry;
    alike(a.position.toArray(), b.position.toArray(), 1e-7, `place of ${name}`);
    alike(of(a).index.array, of(b).index.array, 0, `triangles of ${name}`);
    for (const [attribute, most] of [['position', 1e-7], ['normal', 1e-3], ['color', 1]]) {
      alike(of(a).attributes[attribute].array, of(b).attributes[attribute].array, most, `${attribute} of ${name}`);
    }
    assert.deepEqual(a.morphTargetDictionary, b.morphTargetDictionary);
    of(a).morphAttributes.position?.forEach(({ array }, i) => alike(array, of(b).morphAttributes.position[i].array, 1e-7, controlNames[i]));
  }
  const tracks = ({ animations: [{ tracks }] }) => tracks.sort((a, b) => (a.name < b.name ? -1 : 1));
  const [recorded, expected] = [page, ours].map(tracks);
  assert.deepEqual(recorded.map(({ name }) => name), expected.map(({ name }) => name));
  recorded.forEach(({ name, times, values }, i) => {
    alike(times, expected[i].times, 1e-6, `times of ${name}`);
    alike(values, expected[i].values, 1e-6, name);
  });
  const extras = ({ animations: [{ userData }] }) => userData.mien;
  assert.deepEqual(extras(page), extras(ours));
}
fs.rmSync(folder, { recursive: true });
console.log('7 files valid without errors and warnings, 2 played in three.js');
