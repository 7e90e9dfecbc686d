// The avatar with one morph target per control, coarser than the page draws it, for animations as glTF. Positions and offsets are
// integers, so that files store only vertices that move visibly.
import {controlNames} from './avatar.js';
import {Face} from './face.js';
import {makeFigure} from './figure.js';
import {Mesh, gridTriangles, gridVertices} from './mesh.js';
import {rgb} from './palette.js';

export const quantum = 1024;  // steps per unit of the avatar
export const coarser = 2;     // steps of the neutral face per step of a target
export const nodes = {head: 0, body: 1, eye: 2};

// Every `step`-th of `count` rows or columns, and the last one unless the rows or columns are closed.
function picked(count, step, closed = false) {
  const all = Array.from({length: Math.ceil(count / step)}, (_, i) => i * step);
  return closed || all.at(-1) === count - 1 ? all : [...all, count - 1];
}

// An eyeball around its centre, smaller than on the page: lids that move along straight lines must not cut it. Rings have the colours
// of pupil, iris, limbus and white.
const eyeRings = [
  [0, '#080708'], [0.20, '#080708'], [0.23, '#3f6350'], [0.34, '#5f9a6b'], [0.44, '#33594f'], [0.48, '#122422'], [0.52, '#fcf9f4'], [0.66, '#faf4ee'],
  [0.84, '#f2dfd8'], [0.97, '#e6c7bd']];
const eyeRadius = 0.285 * 0.95, eyeColumns = 20;
const makeEyeball = () => new Mesh('eye', gridVertices(eyeRings.length, eyeColumns, (row, column) => {
  const [r, color] = eyeRings[row], angle = 2 * Math.PI * column / eyeColumns;
  return {at: [r * Math.cos(angle), r * Math.sin(angle), Math.sqrt(1 - r * r)].map(value => value * eyeRadius), color: rgb(color)};
}), gridTriangles(eyeRings.length, eyeColumns, {closed: true, inward: true}));

class Coarse extends Face {
  constructor() {
    super();
    const [leftEar, rightEar, hair, neck, shirt, collar] = makeFigure();
    const rings = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 18, 20, 22, 25, 28, 31, 34, 37, 40, 44, 48, 52, 56, 61];  // finest at the lips
    const eyelid = picked(12, 3), lashes = picked(24, 3), brow = picked(14, 2), teeth = picked(12, 3);
    this.list = [
      this.part(this.head.mesh, 96, 2, rings, {flip: 1}),
      ...this.eyes.flatMap(({parts: [, upper, lower, {mesh}]}, i) => {
        const partner = 3 - 6 * i;
        return [this.part(upper.mesh, 29, 2, [0, 1, ...eyelid.slice(1)], {partner}), this.part(lower.mesh, 29, 2, [0, 1, ...eyelid.slice(1)], {partner}),
                this.part(mesh, 7, 1, lashes, {partner})];
      }),
      ...this.brows.map(({mesh}, i) => this.part(mesh, 7, 1, brow, {partner: 1 - 2 * i})),
      this.part(this.mouth[0].mesh, 41, 2, teeth, {flip: 2}), this.part(this.mouth[1].mesh, 41, 2, teeth, {flip: 2}),
      this.part(this.mouth[2].mesh, 16, 2, picked(16, 3), {flip: 1}),
      ...[leftEar, rightEar].map(mesh => this.part(mesh, 22, 2, picked(14, 2))), this.part(hair, 108, 2, picked(22, 2)),
      this.part(neck, 40, 2, picked(7, 1), {node: nodes.body}), this.part(shirt, 40, 2, picked(14, 2), {node: nodes.body}),
      this.part(collar, 44, 2, picked(10, 2, true), {node: nodes.body}), this.part(makeEyeball(), eyeColumns, 1, picked(eyeRings.length, 1), {node: nodes.eye})];
  }

  // Keeps some rows and every `step`-th column of a mesh. Morph targets of the right side are stored as differences from the mirrored left
  // side: `partner` is the distance to the part on the other side, `flip` how the mirror reorders columns (0 not, 1 around a ring, 2 reversed).
  part(mesh, columns, step, rows, {node = nodes.head, partner = 0, flip = 0} = {}) {
    const all = mesh.turning.length / columns, triangles = mesh.indices.length / 6;
    const closed = triangles % columns === 0, ring = triangles === all * columns, inward = mesh.indices[1] !== 1;
    const kept = picked(columns, step, closed);
    return {mesh, node, rows: rows.length, columns: kept.length, flags: closed | inward << 1 | ring << 2 | flip << 3, partner,
            vertices: rows.flatMap(row => kept.map(column => row * columns + column))};
  }

  // The positions of all kept vertices for a set of controls.
  positions(set) {
    this.pose(Object.fromEntries(controlNames.map(name => [name, set[name] ?? 0])));
    return this.steps('positions', quantum);
  }

  steps(attribute, unit) {
    return this.list.flatMap(({mesh, vertices}) =>
      vertices.flatMap(i => [...mesh[attribute].subarray(i * 3, i * 3 + 3)].map(value => Math.round(value * unit))));
  }
}

// Rounds halves towards 0, so that both sides are alike.
const nearest = value => Math.sign(value) * Math.ceil(Math.abs(value) - 0.5);

// The parts; of all vertices, positions and colours (0..255); and by control, offsets.
export function morphAvatar() {
  const avatar = new Coarse(), positions = avatar.positions({});
  const targets = new Map(controlNames.map(name => {
    // As in ARKit, mouthClose is relative to an open jaw.
    const base = name === 'mouthClose' ? {jawOpen: 1} : {}, from = base.jawOpen ? avatar.positions(base) : positions;
    return [name, avatar.positions({...base, [name]: 1}).map((value, i) => nearest((value - from[i]) / coarser))];
  }));
  return {parts: avatar.list, positions, colors: avatar.steps('colors', 255), targets};
}
