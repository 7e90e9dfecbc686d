// mien's face: draws 52 ARKit controls and the angles of the head on a canvas, with WebGL 2 and no dependencies.
//
//   const avatar = new Avatar(canvas);
//   avatar.draw({controls: {jawOpen: 0.4, mouthSmileLeft: 0.8}, pitch: 0, yaw: 0.2, roll: 0});
//
// Left and right are the subject's: the subject's left is on the right of the image.
import {rotationOfAngles} from './vectors.js';
import {Face} from './face.js';
import {eyeState} from './eyes.js';
import {makeFigure} from './figure.js';
import {Creases} from './creases.js';
import {Renderer} from './renderer.js';

// In the order of the C API (mien_control_name).
export const controlNames = [
  'eyeBlinkLeft', 'eyeLookDownLeft', 'eyeLookInLeft', 'eyeLookOutLeft', 'eyeLookUpLeft', 'eyeSquintLeft', 'eyeWideLeft',
  'eyeBlinkRight', 'eyeLookDownRight', 'eyeLookInRight', 'eyeLookOutRight', 'eyeLookUpRight', 'eyeSquintRight', 'eyeWideRight',
  'jawForward', 'jawLeft', 'jawRight', 'jawOpen', 'mouthClose', 'mouthFunnel', 'mouthPucker', 'mouthLeft', 'mouthRight',
  'mouthSmileLeft', 'mouthSmileRight', 'mouthFrownLeft', 'mouthFrownRight', 'mouthDimpleLeft', 'mouthDimpleRight',
  'mouthStretchLeft', 'mouthStretchRight', 'mouthRollLower', 'mouthRollUpper', 'mouthShrugLower', 'mouthShrugUpper',
  'mouthPressLeft', 'mouthPressRight', 'mouthLowerDownLeft', 'mouthLowerDownRight', 'mouthUpperUpLeft', 'mouthUpperUpRight',
  'browDownLeft', 'browDownRight', 'browInnerUp', 'browOuterUpLeft', 'browOuterUpRight', 'cheekPuff', 'cheekSquintLeft',
  'cheekSquintRight', 'noseSneerLeft', 'noseSneerRight', 'tongueOut'];

// All 52 controls, each 0..1. Missing or invalid values become 0.
const completed = controls => Object.fromEntries(controlNames.map(name => {
  const value = Number(controls?.[name]);
  return [name, value > 0 ? Math.min(1, value) : 0];
}));

const angle = value => (Number.isFinite(value) ? value : 0);

export class Avatar extends Face {
  constructor(canvas) {
    super();
    this.creases = new Creases();
    this.renderer = new Renderer(canvas, this.meshes, makeFigure());
  }

  // `smooth` edges take about twice the time without a graphics card.
  draw({controls, pitch = 0, yaw = 0, roll = 0} = {}, {smooth = true} = {}) {
    const c = completed(controls);
    this.pose(c);
    this.creases.update(c);
    this.renderer.draw({
      smooth, rotation: rotationOfAngles({pitch: angle(pitch), yaw: angle(yaw), roll: angle(roll)}),
      creases: this.creases.data,
      pupil: 0.225 - 0.02 * (c.eyeSquintLeft + c.eyeSquintRight), lids: [1, -1].map(side => eyeState(c, side).upper),
    });
  }
}
