// Creases of the skin: drawn once as soft strokes on one half of the face, with x and y of head space mapped to a
// square. They are blended by how far the controls fold the skin, and the shader darkens the result.
import {clamp01, sideName} from './vectors.js';

export const creaseField = {left: -0.08, right: 0.98, bottom: -1.26, top: 0.86};
export const creaseSize = 256;

// Each is a list of quadratic curves [start, control point, end] and the width of the stroke.
const strokes = {
  forehead: {width: 0.030, curves: [
    [[-0.1, 0.640], [0.12, 0.645], [0.42, 0.640]], [[-0.1, 0.735], [0.15, 0.735], [0.40, 0.735]]]},
  temple: {width: 0.030, curves: [[[0.34, 0.635], [0.52, 0.665], [0.72, 0.60]], [[0.36, 0.73], [0.5, 0.745], [0.64, 0.70]]]},
  frown: {width: 0.030, curves: [[[0.055, 0.50], [0.040, 0.42], [0.060, 0.32]], [[0.115, 0.49], [0.10, 0.44], [0.105, 0.39]]]},
  sneer: {width: 0.028, curves: [
    [[0.0, 0.19], [0.05, 0.215], [0.125, 0.25]], [[0.02, 0.10], [0.08, 0.125], [0.16, 0.175]], [[0.035, 0.02], [0.09, 0.03], [0.165, 0.085]],
    [[0.18, -0.16], [0.215, -0.22], [0.235, -0.30]]]},
  nasolabial: {width: 0.036, curves: [[[0.195, -0.24], [0.33, -0.34], [0.42, -0.56]]]},
  smile: {width: 0.032, curves: [[[0.395, -0.44], [0.47, -0.52], [0.445, -0.65]]]},
  dimple: {width: 0.060, curves: [[[0.425, -0.49], [0.47, -0.545], [0.43, -0.61]]]},
  crow: {width: 0.026, curves: [[[0.71, 0.155], [0.77, 0.19], [0.83, 0.235]], [[0.72, 0.085], [0.79, 0.085], [0.86, 0.095]], [[0.70, 0.02], [0.76, -0.01], [0.82, -0.05]]]},
  under: {width: 0.030, curves: [[[0.20, -0.155], [0.38, -0.245], [0.62, -0.17]]]},
  cheek: {width: 0.034, curves: [[[0.25, -0.20], [0.45, -0.32], [0.72, -0.19]]]},
  chin: {width: 0.028, curves: [
    [[0.03, -0.90], [0.05, -0.91], [0.075, -0.93]], [[0.10, -0.96], [0.12, -0.98], [0.14, -0.97]], [[0.02, -1.00], [0.04, -1.02], [0.075, -1.01]],
    [[0.10, -1.06], [0.12, -1.07], [0.15, -1.05]], [[0.0, -0.80], [0.12, -0.79], [0.22, -0.86]]]},
  marionette: {width: 0.034, curves: [[[0.325, -0.61], [0.40, -0.68], [0.405, -0.82]]]},
  stretch: {width: 0.028, curves: [[[0.40, -0.50], [0.50, -0.62], [0.46, -0.78]], [[0.50, -0.47], [0.61, -0.61], [0.56, -0.80]]]},
  pucker: {width: 0.024, curves: [
    [[0.045, -0.44], [0.05, -0.47], [0.055, -0.495]], [[0.125, -0.45], [0.125, -0.475], [0.125, -0.50]], [[0.205, -0.49], [0.195, -0.51], [0.185, -0.53]],
    [[0.06, -0.705], [0.055, -0.73], [0.055, -0.75]], [[0.15, -0.685], [0.15, -0.71], [0.155, -0.73]]]},
  puff: {width: 0.05, curves: [[[0.37, -0.38], [0.30, -0.58], [0.40, -0.80]]]},
  press: {width: 0.036, curves: [[[0.325, -0.52], [0.375, -0.575], [0.33, -0.645]]]},
};

// Depth of each crease on one side.
export function creaseDepths(c, side) {
  const of = name => c[name + sideName(side)];
  return {
    forehead: 0.75 * c.browInnerUp + 0.25 * of('browOuterUp'), temple: 0.8 * of('browOuterUp'),
    frown: 0.95 * of('browDown') + 0.35 * of('noseSneer'), sneer: 0.75 * of('noseSneer') + 0.15 * of('cheekSquint'),
    nasolabial: 0.10 + 0.4 * of('mouthSmile') + 0.45 * of('noseSneer') + 0.5 * of('mouthUpperUp') + 0.2 * of('cheekSquint') + 0.25 * of('mouthStretch'),
    smile: 0.65 * of('mouthSmile') + 0.25 * of('mouthStretch'), dimple: 1.1 * of('mouthDimple') + 0.15 * of('mouthSmile'),
    crow: 0.5 * of('eyeSquint') + 0.55 * of('cheekSquint') + 0.15 * of('mouthSmile') + 0.2 * of('eyeBlink'),
    under: 0.12 + 0.75 * of('eyeSquint') + 0.3 * of('cheekSquint'), cheek: 0.8 * of('cheekSquint') + 0.15 * of('mouthSmile'),
    chin: 0.5 * c.mouthShrugLower + 0.2 * (of('mouthFrown')), marionette: 0.8 * of('mouthFrown'), stretch: 0.75 * of('mouthStretch'),
    pucker: 0.4 * c.mouthPucker + 0.15 * c.mouthFunnel, puff: 0.55 * c.cheekPuff, press: 0.75 * of('mouthPress') + 0.3 * c.mouthRollLower + 0.2 * c.mouthRollUpper,
  };
}

function paintStroke({width, curves}) {
  const {left, right, bottom, top} = creaseField;
  const canvas = Object.assign(document.createElement('canvas'), {width: creaseSize, height: creaseSize});
  const ctx = canvas.getContext('2d', {willReadFrequently: true});
  const place = ([x, y]) => [(x - left) / (right - left) * creaseSize, (y - bottom) / (top - bottom) * creaseSize];
  ctx.fillRect(0, 0, creaseSize, creaseSize);
  ctx.globalCompositeOperation = 'lighten';
  ctx.lineCap = 'round';
  // Makes soft edges with strokes from wide and dark to narrow and bright, and tapers the ends with shorter strokes.
  for (let layer = 1; layer <= 8; ++layer) {
    const value = Math.round(255 * (layer / 8) ** 1.4), trim = 0.055 * (layer - 1);
    ctx.strokeStyle = `rgb(${value},${value},${value})`;
    ctx.lineWidth = width * creaseSize * (1.05 - layer / 8);
    for (const [from, way, to] of curves) {
      const at = t => place([0, 1].map(k => (1 - t) ** 2 * from[k] + 2 * t * (1 - t) * way[k] + t * t * to[k]));
      ctx.beginPath();
      for (let i = 0; i <= 16; ++i) ctx.lineTo(...at(trim + (1 - 2 * trim) * i / 16));
      ctx.stroke();
    }
  }
  return covered(ctx.getImageData(0, 0, creaseSize, creaseSize).data);
}

// The bounding box and brightness of the pixels that are not black.
function covered(data) {
  const places = [], values = [];
  for (let i = 0; i < creaseSize * creaseSize; ++i) {
    if (data[i * 4] === 0) continue;
    places.push(i);
    values.push(data[i * 4]);
  }
  return {places: Uint32Array.from(places), values: Uint8Array.from(values)};
}

// The blended image: two channels, for the subject's left and right.
export class Creases {
  constructor() {
    this.painted = Object.entries(strokes).map(([name, stroke]) => [name, paintStroke(stroke)]);
    this.data = new Uint8ClampedArray(creaseSize * creaseSize * 2);
  }

  update(c) {
    this.data.fill(0);
    [1, -1].forEach((side, channel) => {
      const depths = creaseDepths(c, side);
      for (const [name, {places, values}] of this.painted) {
        const depth = clamp01(depths[name]);
        if (depth === 0) continue;
        for (let i = 0; i < places.length; ++i) this.data[places[i] * 2 + channel] += depth * values[i];
      }
    });
  }
}
