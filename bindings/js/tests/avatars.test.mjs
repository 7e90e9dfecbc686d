// Results move avatars: minimal ones, and a mesh of three.js if apps/web has installed it. apps/web/tests/vrm.test.mjs loads VRM files.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {test} from 'node:test';
import {applyToMorphs, applyToVRM} from '../avatars.js';
import {controlNames, controlsByName} from '../vocabularies.js';

const root = new URL('../../../', import.meta.url);
const resultOf = (values, supportedControls = 2n ** 52n - 1n) => ({
  controls: Float32Array.from(controlNames, name => values[name] ?? 0), supportedControls, rotation: Float32Array.of(0.1, 0.2, 0.3, 0.9)});

function mesh(...names) {
  const node = {morphTargetDictionary: Object.fromEntries(names.map((name, i) => [name, i])), morphTargetInfluences: names.map(() => 0.125)};
  return {...node, traverse(visit) { visit({}); visit(this); }};
}

function vrmOf(names, metaVersion = '1') {
  const values = {}, head = [];
  return {values, head, meta: {metaVersion},
          expressionManager: {expressions: names.map(expressionName => ({expressionName})), setValue(name, value) { values[name] = value; }},
          humanoid: {getNormalizedBoneNode: bone => (bone === 'head' ? {quaternion: {set(...q) { head.splice(0, 4, ...q); }}} : null)}};
}
const near = (actual, expected) => expected.forEach((value, i) => assert.ok(Math.abs(actual[i] - value) < 1e-6, `${actual} is not ${expected}`));

test('the names are those of mien.h, in its order', () => {
  const header = readFileSync(new URL('include/mien/mien.h', root), 'utf8');
  const constants = [...header.matchAll(/MIEN_CONTROL_(\w+) = \d+/g)].map(([, name]) => name);
  assert.deepEqual(controlNames.map(name => name.replace(/[A-Z]/g, '_$&').toUpperCase()), constants);
  assert.equal(constants.length, 52);
});

test('controls by name are the predicted ones', () => {
  const named = controlsByName(resultOf({eyeBlinkLeft: 0.5, jawOpen: 1}, 0b101n));
  assert.deepEqual(named, {eyeBlinkLeft: 0.5, eyeLookInLeft: 0});
});

test('morph targets follow by their names, and others stay', () => {
  const face = mesh('Face.jawOpen', 'mouthSmile_L', 'JawDrop', 'hairLength');
  assert.equal(applyToMorphs(face, resultOf({jawOpen: 0.5, mouthSmileLeft: 0.25})), 3);
  near(face.morphTargetInfluences, [0.5, 0.25, 0.5, 0.125]);
  applyToMorphs(face, resultOf({}));
  near(face.morphTargetInfluences, [0, 0, 0, 0.125]);
});

const visemes = Float32Array.from({length: 15}, (_, i) => i / 16);
const ovr = ['sil', 'PP', 'FF', 'TH', 'DD', 'kk', 'CH', 'SS', 'nn', 'RR', 'aa', 'E', 'ih', 'oh', 'ou'];
const readyPlayerMe = ovr.map(name => 'viseme_' + ({ih: 'I', oh: 'O', ou: 'U'}[name] ?? name));

test('morph targets with names of Oculus follow the visemes', () => {
  for (const names of [ovr, readyPlayerMe, ovr.map(name => 'vrc.v_' + name)]) {
    const face = mesh(...names, 'eyeBlinkLeft');
    assert.equal(applyToMorphs(face, {...resultOf({eyeBlinkLeft: 0.5, jawOpen: 1}), visemes}), 16, names[1]);
    near(face.morphTargetInfluences, [...visemes, 0.5]);
  }
});

test('visemes and vowels rest where names of ARKit open the jaw, and single letters mean nothing', () => {
  const both = mesh('jawOpen', ...readyPlayerMe);
  assert.equal(applyToMorphs(both, {...resultOf({jawOpen: 0.5}), visemes}), 1);
  assert.equal(applyToMorphs(mesh('A', 'E', 'hat'), resultOf({})), 0);
});

test('morph targets follow behind a prefix that three names share', () => {
  const values = resultOf({jawOpen: 0.5, mouthSmileLeft: 0.25, eyeBlinkLeft: 1, cheekPuff: 0.75});
  const two = mesh('Body.Head_jawOpen', 'Body.Head_mouthSmile_L', 'Body.Head_eyeBlinkLeft', 'Teeth_LOD0_jawOpen', 'Teeth_LOD0_jawLeft', 'Teeth_LOD0_jawRight', 'cheekPuff');
  assert.equal(applyToMorphs(two, values), 7);
  near(two.morphTargetInfluences, [0.5, 0.25, 1, 0.5, 0, 0, 0.75]);
  assert.equal(applyToMorphs(mesh('Head_jawOpen', 'Head_jawopen', 'Head_mouthSmile_L', 'Hat_eyeBlinkLeft', 'Head_long'), values), 0, 'two names share it');
});

test('visemes and vowels follow behind a prefix, but parts of a face in VRoid have no prefix', () => {
  const shifted = mesh(...readyPlayerMe.map(name => 'Head_' + name));
  assert.equal(applyToMorphs(shifted, {...resultOf({}), visemes}), 15);
  near(shifted.morphTargetInfluences, visemes);
  const vowels = mesh('Mouth_A', 'Mouth_I', 'Mouth_U', 'Mouth_wide');
  assert.equal(applyToMorphs(vowels, resultOf({jawOpen: 0.5, mouthPucker: 0.25})), 3);
  near(vowels.morphTargetInfluences, [0.5, 0, 0.25, 0.125]);
  const vroid = mesh('Fcl_MTH_A', 'Fcl_MTH_I', 'Fcl_MTH_U', 'Fcl_MTH_Joy', 'Fcl_ALL_Joy');
  assert.equal(applyToMorphs(vroid, resultOf({mouthSmileLeft: 1, mouthSmileRight: 1})), 4);
  near(vroid.morphTargetInfluences, [0, 0, 0, 0.125, 1]);
});

test('morph targets with names of VRM follow', () => {
  const values = resultOf({jawOpen: 0.5, mouthPucker: 0.25, eyeBlinkLeft: 1});
  for (const names of [['Fcl_MTH_A', 'Fcl_MTH_U', 'Fcl_EYE_Close_L'], ['A', 'U', 'Blink_L'], ['aa', 'ou', 'blinkLeft']]) {
    const face = mesh(...names);
    assert.equal(applyToMorphs(face, values), 3, names[0]);
    near(face.morphTargetInfluences, [0.5, 0.25, 1]);
  }
});

test('a VRM follows by its presets or by ARKit names, and turns its head', () => {
  const presets = vrmOf(['aa', 'blink', 'blinkLeft', 'blinkRight', 'custom']);
  assert.equal(applyToVRM(presets, resultOf({eyeBlinkLeft: 1, jawOpen: 0.5})), 3);
  assert.deepEqual(Object.keys(presets.values).sort(), ['aa', 'blinkLeft', 'blinkRight']);
  assert.equal(presets.values.blinkLeft, 1);
  assert.ok(presets.values.aa > 0.4);
  near(presets.head, [0.1, 0.2, 0.3, 0.9]);
  const older = vrmOf(['blinkLeft', 'aa'], '0');  // three-vrm gives presets of VRM 0 the names of VRM 1
  assert.equal(applyToVRM(older, resultOf({eyeBlinkLeft: 1})), 2);
  near(older.head, [-0.1, 0.2, -0.3, 0.9]);
  const perfect = vrmOf(['aa', ...controlNames]);
  assert.equal(applyToVRM(perfect, resultOf({jawOpen: 0.5})), 52);
  assert.equal(perfect.values.aa, undefined);
  assert.equal(perfect.values.jawOpen, 0.5);
});

const three = await import(new URL('apps/web/node_modules/three/build/three.module.js', root)).catch(() => null);
test('a mesh of three.js follows', {skip: !three && 'three.js is not installed'}, () => {
  const geometry = new three.BufferGeometry();
  geometry.setAttribute('position', new three.Float32BufferAttribute([0, 0, 0], 3));
  geometry.morphAttributes.position = ['jawOpen', 'other'].map(name => Object.assign(new three.Float32BufferAttribute([0, 1, 0], 3), {name}));
  const group = new three.Group(), face = new three.Mesh(geometry);
  group.add(face);
  assert.equal(applyToMorphs(group, resultOf({jawOpen: 0.75})), 1);
  near(face.morphTargetInfluences, [0.75, 0]);
});
