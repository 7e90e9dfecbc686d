// Keeps what was tracked while it records.

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

// Box and pose of other frames are where the face was last.
export const isFollowed = ({status}) => status === 'tracking';

// Where the eyes look, radians; 0.485 is a control at 1.
export function gaze(controls, names) {
  const of = name => controls[names.indexOf(name)], full = 0.485;
  return {
    left: {pitch: full * (of('eyeLookDownLeft') - of('eyeLookUpLeft')), yaw: full * (of('eyeLookOutLeft') - of('eyeLookInLeft'))},
    right: {pitch: full * (of('eyeLookDownRight') - of('eyeLookUpRight')), yaw: full * (of('eyeLookInRight') - of('eyeLookOutRight'))}};
}
