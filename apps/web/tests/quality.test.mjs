// The drawing quality decreases under load, recovers afterwards, and becomes stable.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {Quality, qualities} from '../src/ui/quality.js';

// Simulates a browser in which an image at step i takes costs[i] ms; returns the steps that it draws.
function run(quality, costs, seconds, from_ms = 0) {
  const steps = [];
  for (let time_ms = from_ms; time_ms < from_ms + seconds * 1000;) {
    const took_ms = 8 + Math.max(16.7, costs[quality.step]);
    time_ms += Math.max(33.3, costs[quality.step]);
    steps.push(quality.step);
    quality.took(took_ms, time_ms);
  }
  return steps;
}

const fast = qualities.map(() => 3), last = qualities.length - 1;

test('nothing changes under low load', () => {
  assert.deepEqual(new Set(run(new Quality(), fast, 60)), new Set([0]));
});

test('a 30 Hz display does not reduce the quality', () => {
  assert.deepEqual(new Set(run(new Quality(), qualities.map(() => 33), 60)), new Set([0]));
});

test('from two images per second the rate rises within a dozen images', () => {
  const steps = run(new Quality(), [500, 220, 110, 60, 30], 30);
  assert.ok(steps.slice(12).every(step => step >= last - 1), steps.slice(0, 20).join(' '));
});

test('the quality recovers when drawing becomes fast again', () => {
  const quality = new Quality();
  run(quality, qualities.map(() => 200), 20);
  assert.equal(quality.step, last);
  run(quality, fast, 60, 20000);
  assert.equal(quality.step, 0);
});

test('failed attempts at a finer quality become rarer', () => {
  const steps = run(new Quality(), [300, 90, 20, 10, 6], 600);
  const changes = steps.filter((step, i) => i > 0 && step !== steps[i - 1]).length;
  assert.ok(steps.filter(step => step === 2).length > steps.length * 0.95 && changes < 30, `${changes} changes`);
});

test('a single long wait does not change the quality', () => {
  const quality = new Quality();
  run(quality, fast, 5);
  quality.took(3000, 8000);
  run(quality, fast, 5, 8000);
  assert.equal(quality.step, 0);
});
