// Recordings of frames without a tracked face: the same as `mien track` writes.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {controlNames} from '../avatar/avatar.js';
import {curvesCsv} from '../src/recording/csv.js';
import {animationGlb} from '../src/recording/glb.js';
import {liveLinkCsv} from '../src/recording/live_link_face.js';

// The tracker keeps the last box and pose, whatever the status.
const frame = (tMs, status, jawOpen) => ({
  tMs, status, faceProbability: 0.5, voiceActivity: 0, lod: 1, box: [100, 50, 200, 220], pitch: 0.25, yaw: 0.5, roll: 0.125,
  rotation: [0, 0, 0, 1], translation: [0.25, 0.5, -0.5], controls: controlNames.map(name => (name === 'jawOpen' ? jawOpen : 0)),
  driven: controlNames.map(() => 1)});
const frames = [
  frame(0, 'tracking', 0.5), frame(100, 'lost', 0.25), frame(200, 'searching', 0), frame(300, 'searching', 0.125), frame(400, 'lost', 0)];
const cells = text => text.trimEnd().split('\n').slice(1).map(line => line.split(','));

test('curves have box and pose only for a tracked face', () => {
  const rows = cells(curvesCsv(frames, controlNames));
  assert.deepEqual(rows.map(row => row[2]), ['tracking', 'lost', 'searching', 'searching', 'lost']);
  assert.deepEqual(rows[0].slice(6, 16), ['100', '50', '200', '220', '0.25', '0.5', '0.125', '0.25', '0.5', '-0.5']);
  for (const row of rows.slice(1)) assert.deepEqual(row.slice(6, 16), new Array(10).fill(''), row[2]);
  const jaw = 16 + controlNames.indexOf('jawOpen');
  assert.deepEqual(rows.map(row => row[jaw]), ['0.5', '0.25', '0', '0.125', '0']);
});

test('Live Link Face has no blend shapes for an empty frame, and no rotation of a lost head', () => {
  const rows = cells(liveLinkCsv(frames, controlNames));
  assert.deepEqual(rows.map(row => row[1]), ['61', '61', '0', '61', '61']);
  assert.deepEqual(rows[2].slice(2), new Array(61).fill(''));
  assert.deepEqual(rows[0].slice(54, 57).map(Number), [0.5, -0.25, 0.125]);
  for (const i of [1, 3, 4]) assert.deepEqual(rows[i].slice(54, 57).map(Number), [0, 0, 0], frames[i].status);
});

test('the head of a GLB has keys only for a tracked face', () => {
  const file = animationGlb(frames, controlNames), bytes = new DataView(file.buffer).getUint32(12, true);
  const {animations: [{channels, samplers, extras}], accessors} = JSON.parse(new TextDecoder().decode(file.subarray(20, 20 + bytes)));
  const keys = (node, path) => {
    const {sampler} = channels.find(({target}) => target.node === node && target.path === path);
    return accessors[samplers[sampler].input].count;
  };
  assert.deepEqual([keys(1, 'rotation'), keys(1, 'translation'), keys(4, 'weights')], [1, 1, 5]);
  assert.deepEqual(extras.mien, {start_ns: 0, states: 'tlssl', not_driven: []});
});
