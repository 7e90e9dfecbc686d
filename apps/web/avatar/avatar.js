// mien's face: draws 52 ARKit controls and the angles of the head on a canvas, with WebGL 2 and no dependencies.
//
//   const avatar = new Avatar(canvas);
//   avatar.draw({controls: {jawOpen: 0.4, mouthSmileLeft: 0.8}, pitch: 0, yaw: 0.2, roll: 0});
//
// Left and right are the subject's: the subject's left is on the right of the image.
import {rotationOfAngles} from './vectors.js';
import {makeHead} from './head.js';
import {makeExpressions, shapeWeights} from './expressions.js';
import {Eye, eyeState} from './eyes.js';
import {makeMouth} from './mouth.js';
import {Brow, makeFigure} from './figure.js';
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

// Shared by all avatars, because computing it takes long.
let expressions;
const expressionsOf = head => (expressions ??= makeExpressions(head));

const angle = value => (Number.isFinite(value) ? value : 0);

export class Avatar {
  constructor(canvas) {
    this.head = makeHead();
    this.neutral = this.head.mesh.positions.slice();
    this.expressions = expressionsOf(this.head);
    this.eyes = [new Eye(1), new Eye(-1)];
    this.mouth = makeMouth();
    this.brows = [new Brow(1, this.head), new Brow(-1, this.head)];
    const moving = [this.head.mesh, ...this.eyes.flatMap(eye => eye.meshes), ...this.brows.map(brow => brow.mesh),
                    ...this.mouth.map(part => part.mesh)];
    this.creases = new Creases();
    this.renderer = new Renderer(canvas, moving, makeFigure());
  }

  // `smooth` edges take about twice the time without a graphics card.
  draw({controls, pitch = 0, yaw = 0, roll = 0} = {}, {smooth = true} = {}) {
    const c = completed(controls);
    this.shapeHead(c);
    for (const part of [...this.eyes, ...this.mouth]) part.update(c);
    for (const brow of this.brows) brow.update(this.head.mesh.positions);
    this.creases.update(c);
    this.renderer.draw({
      smooth, rotation: rotationOfAngles({pitch: angle(pitch), yaw: angle(yaw), roll: angle(roll)}),
      creases: this.creases.data,
      pupil: 0.225 - 0.02 * (c.eyeSquintLeft + c.eyeSquintRight), lids: [1, -1].map(side => eyeState(c, side).upper),
    });
  }

  shapeHead(c) {
    const {mesh} = this.head, weights = shapeWeights(c);
    mesh.positions.set(this.neutral);
    for (const [name, {vertices, offsets}] of this.expressions) {
      const weight = weights[name];
      if (!(weight > 0)) continue;
      for (let i = 0; i < vertices.length; ++i) {
        const at = vertices[i] * 3;
        mesh.positions[at] += weight * offsets[i * 3];
        mesh.positions[at + 1] += weight * offsets[i * 3 + 1];
        mesh.positions[at + 2] += weight * offsets[i * 3 + 2];
      }
    }
    mesh.updateNormals();
  }
}
