// Curves as `mien track` writes them: docs/cli.md, Curves.
import {isFollowed} from './recording.js';

const fixed = ['frame', 't_ms', 'status', 'face_prob', 'lod', 'vad', 'x', 'y', 'w', 'h', 'pitch_rad', 'yaw_rad', 'roll_rad', 'tx_m', 'ty_m', 'tz_m'];
// As few digits as give the same float back.
const shortest = value => {
  for (let digits = 1; digits < 9; ++digits) {
    const text = Number(value.toPrecision(digits));
    if (Math.fround(text) === value) return String(text);
  }
  return String(value);
};

export function curvesCsv(frames, names) {
  const rows = frames.map((frame, i) => {
    const seen = isFollowed(frame);
    const pose = [...frame.box, frame.pitch, frame.yaw, frame.roll, ...frame.translation];
    return [i, Number(frame.tMs.toFixed(4)), frame.status, shortest(frame.faceProbability), frame.lod, shortest(frame.voiceActivity),
            ...pose.map(value => (seen ? shortest(value) : '')),
            ...Array.from(frame.controls, (value, k) => (frame.driven[k] ? shortest(value) : ''))].join(',');
  });
  return [[...fixed, ...names].join(','), ...rows].join('\n') + '\n';
}
