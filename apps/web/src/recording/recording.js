// Stores the results of tracking during a recording.

export class Recording {
  constructor() { this.clear(); }

  clear() {
    this.frames = [];
    this.active = false;
  }

  start() {
    this.clear();
    this.active = true;
  }

  stop() { this.active = false; }

  add(timeMs, result) {
    if (!this.active) return;
    this.startMs ??= timeMs;
    if (!this.frames.length) this.startMs = timeMs;
    const {status, faceProbability, voiceActivity, lod, box, pitch, yaw, roll, rotation, translation, controls, supportedControls} = result;
    this.frames.push({
      tMs: timeMs - this.startMs, status, faceProbability, voiceActivity, lod, box, pitch, yaw, roll, rotation, translation, controls,
      driven: controls.map((_, i) => Number(supportedControls >> BigInt(i) & 1n))});
  }

  get seconds() { return this.frames.length ? this.frames.at(-1).tMs / 1000 : 0; }
}

// In other frames, box and pose have their last values.
export const isTracked = ({status}) => status === 'tracking';

// Gaze directions in radians; a control at 1 is 0.485.
export function gaze(controls, names) {
  const of = name => controls[names.indexOf(name)], full = 0.485;
  return {
    left: {pitch: full * (of('eyeLookDownLeft') - of('eyeLookUpLeft')), yaw: full * (of('eyeLookOutLeft') - of('eyeLookInLeft'))},
    right: {pitch: full * (of('eyeLookDownRight') - of('eyeLookUpRight')), yaw: full * (of('eyeLookInRight') - of('eyeLookOutRight'))}};
}
