// Curves in the format of `mien track`; see docs/cli.md, Curves.
import {isTracked} from './recording.js';

const fixed = ['frame', 't_ms', 'status', 'face_prob', 'lod', 'vad', 'x', 'y', 'w', 'h', 'pitch_rad', 'yaw_rad', 'roll_rad', 'tx_m', 'ty_m', 'tz_m'];
// The minimum number of digits that gives the same float.
const shortest = value => {
  for (let digits = 1; digits < 9; ++digits) {
    const text = Number(value.toPrecision(digits));
    if (Math.fround(text) === value) return String(text);
  }
  return String(value);
};

export function curvesCsv(frames, names) {
  const rows = frames.map((frame, i) => {
    const tracked = isTracked(frame);
    const pose = [...frame.box, frame.pitch, frame.yaw, frame.roll, ...frame.translation];
    return [i, Number(frame.tMs.toFixed(4)), frame.status, shortest(frame.faceProbability), frame.lod, shortest(frame.voiceActivity),
            ...pose.map(value => (tracked ? shortest(value) : '')),
            ...Array.from(frame.controls, (value, k) => (frame.driven[k] ? shortest(value) : ''))].join(',');
  });
  return [[...fixed, ...names].join(','), ...rows].join('\n') + '\n';
}
