// applyToVRM with @pixiv/three-vrm: frames of the demo clip move VRM 0 and VRM 1 as the CSV of these frames says.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {before, test} from 'node:test';
import {VRMLoaderPlugin, VRMUtils} from '@pixiv/three-vrm';
import {Euler, Quaternion} from 'three';
import {GLTFLoader} from 'three/examples/jsm/loaders/GLTFLoader.js';
import {applyToVRM} from '../../../bindings/js/avatars.js';
import {createTracker} from '../../../bindings/js/node.js';
import {controlNames} from '../../../bindings/js/vocabularies.js';
import {curvesCsv} from '../src/recording/csv.js';
import {Recording} from '../src/recording/recording.js';
import {vrmModel} from './models.mjs';
import {clip, dist} from './page.mjs';

const width = 640, height = 480, bytes = width * height * 4, seconds = 8, perSecond = 3;
const frames = [];  // {result, row}: `row` has the cells of the CSV by name

before(async () => {
  const options = ['-t', String(seconds), '-vf', `fps=${perSecond}`, '-pix_fmt', 'rgba', '-f', 'rawvideo', '-'];
  const pixels = execFileSync('ffmpeg', ['-v', 'error', '-i', clip, ...options], {maxBuffer: bytes * seconds * perSecond});
  const tracker = await createTracker({folder: `file://${dist}`, lod: 4}), recording = new Recording();
  recording.start();
  for (let i = 0; i < seconds * perSecond; ++i) {
    const timeMs = i * 1000 / perSecond;
    frames.push({result: await tracker.track({width, height, data: pixels.subarray(i * bytes, (i + 1) * bytes)}, timeMs * 1e6)});
    recording.add(timeMs, frames[i].result);
  }
  tracker.destroy();
  const [names, ...rows] = curvesCsv(recording.frames, controlNames).trim().split('\n').map(line => line.split(','));
  rows.forEach((cells, i) => { frames[i].row = Object.fromEntries(names.map((name, k) => [name, Number(cells[k])])); });
});

test('the frames have a mouth that opens, eyes that close and a head that turns', () => {
  for (const [name, least] of [['jawOpen', 0.3], ['eyeBlinkLeft', 0.5], ['mouthSmileLeft', 0.5], ['yaw_rad', 0.2], ['pitch_rad', 0.05], ['roll_rad', 0.05]]) {
    assert.ok(Math.max(...frames.map(({row}) => Math.abs(row[name]))) > least, name);
  }
});

async function load(version, names) {
  const file = new Uint8Array(vrmModel(version, names)).buffer;
  const {userData: {vrm}} = await new GLTFLoader().register(parser => new VRMLoaderPlugin(parser)).parseAsync(file, '');
  if (version === 0) VRMUtils.rotateVRM0(vrm);
  const bone = vrm.humanoid.getRawBoneNode('head'), turned = () => {
    vrm.scene.updateMatrixWorld(true);
    return bone.getWorldQuaternion(new Quaternion());
  };
  const rest = turned().invert();
  return {vrm, weights: vrm.scene.getObjectByName('face').morphTargetInfluences, head: () => turned().multiply(rest)};
}

// Applies every frame; `expected` gives the weights of the morph targets for a row.
function follows({vrm, weights, head}, count, expected) {
  for (const {result, row} of frames) {
    assert.equal(applyToVRM(vrm, result), count);
    vrm.update(1 / 30);
    expected(row).forEach((value, i) => assert.ok(Math.abs(weights[i] - value) < 1e-6, `target ${i} of frame ${row.frame}: ${weights[i]} instead of ${value}`));
    const angle = head().angleTo(new Quaternion().setFromEuler(new Euler(row.pitch_rad, row.yaw_rad, row.roll_rad, 'YXZ')));
    assert.ok(angle < 1e-3, `the head of frame ${row.frame} is ${angle} rad away`);
  }
}

for (const version of [0, 1]) {
  test(`the presets of a VRM ${version} and its head are those of the CSV`, async () => {
    const model = await load(version, ['custom']);
    follows(model, 2, row => [row.jawOpen, row.eyeBlinkLeft, 0]);
    const {result, row} = frames.find(frame => frame.row.jawOpen > 0.3);
    applyToVRM(model.vrm, result);
    assert.ok(Math.abs(model.vrm.expressionManager.getValue('aa') - row.jawOpen) < 1e-6);
  });

  test(`a VRM ${version} with expressions of all ARKit names has the controls of the CSV, and its presets rest`, async () => {
    const names = version === 0 ? controlNames.map(name => name[0].toUpperCase() + name.slice(1)) : controlNames;
    follows(await load(version, names), 52, row => [0, 0, ...controlNames.map(name => row[name])]);
  });
}
