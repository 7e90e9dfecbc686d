// CSV as Epic's Live Link Face records it: 63 columns. The order of JawRight, JawLeft and of MouthRight, MouthLeft
// differs from mien's. Rotations are in radians; positive pitch looks up.
import {gaze, isTracked} from './recording.js';

const fps = 60;
const rotations = ['HeadYaw', 'HeadPitch', 'HeadRoll', 'LeftEyeYaw', 'LeftEyePitch', 'LeftEyeRoll', 'RightEyeYaw', 'RightEyePitch', 'RightEyeRoll'];
const exchanged = {jawLeft: 'jawRight', jawRight: 'jawLeft', mouthLeft: 'mouthRight', mouthRight: 'mouthLeft'};
const digits = value => value.toFixed(10);

// HH:MM:SS:FF.mmm
function timecode(ms) {
  const thousandths = Math.round(ms / 1000 * fps * 1000), seconds = Math.floor(thousandths / (fps * 1000));
  const rest = thousandths - seconds * fps * 1000, two = value => String(Math.floor(value)).padStart(2, '0');
  return `${two(seconds / 3600 % 24)}:${two(seconds / 60 % 60)}:${two(seconds % 60)}:${two(rest / 1000)}.${String(rest % 1000).padStart(3, '0')}`;
}

const showsNothing = ({status, controls}) => status === 'searching' && controls.every(value => value === 0);

export function liveLinkCsv(frames, names) {
  const order = names.map(name => names.indexOf(exchanged[name] ?? name));
  const capital = name => name[0].toUpperCase() + name.slice(1);
  const header = ['Timecode', 'BlendshapeCount', ...order.map(i => capital(names[i])), ...rotations];
  const angles = ({yaw, pitch, roll = 0}) => [yaw, -pitch || 0, roll];
  const straight = {yaw: 0, pitch: 0};
  const rows = frames.map(frame => {
    if (showsNothing(frame)) return timecode(frame.tMs) + ',0' + ','.repeat(order.length + rotations.length);
    const {left, right} = gaze(frame.controls, names);
    const values = [...order.map(i => frame.controls[i]), ...angles(isTracked(frame) ? frame : straight), ...angles(left), ...angles(right)];
    return [timecode(frame.tMs), values.length, ...values.map(digits)].join(',');
  });
  return [header.join(','), ...rows].join('\n') + '\n';
}
