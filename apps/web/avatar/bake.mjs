// Writes the avatar with one morph target per control, coarser than the page draws it, for animations as glTF. The packed file is
// apps/animation/avatar.packed; apps/animation/avatar_model.h describes its content.
// usage: node bake.mjs FILE && scripts/package/pack_weights.py --any FILE PACKED
import {writeFileSync} from 'node:fs';
import {controlNames} from './avatar.js';
import {makeExpressions, shapeWeights} from './expressions.js';
import {Eye} from './eyes.js';
import {Brow, makeFigure} from './figure.js';
import {makeHead} from './head.js';
import {Mesh, gridTriangles, gridVertices} from './mesh.js';
import {makeMouth} from './mouth.js';
import {rgb} from './palette.js';

const quantum = 1024;  // steps per unit of the avatar
const coarser = 2;     // steps of the neutral face per step of a target
const head = 0, body = 1, eye = 2;  // nodes

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

class Parts {
  constructor() {
    this.head = makeHead();
    this.neutral = this.head.mesh.positions.slice();
    this.expressions = makeExpressions(this.head);
    this.eyes = [new Eye(1), new Eye(-1)];
    this.mouth = makeMouth();
    this.brows = [new Brow(1, this.head), new Brow(-1, this.head)];
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
      this.part(neck, 40, 2, picked(7, 1), {node: body}), this.part(shirt, 40, 2, picked(14, 2), {node: body}),
      this.part(collar, 44, 2, picked(10, 2, true), {node: body}), this.part(makeEyeball(), eyeColumns, 1, picked(eyeRings.length, 1), {node: eye})];
  }

  // A target of the right side is predicted from that of the left: the partner's vertices, in columns that `flip` as the mirror does.
  part(mesh, columns, step, rows, {node = head, partner = 0, flip = 0} = {}) {
    const all = mesh.turning.length / columns, triangles = mesh.indices.length / 6;
    const closed = triangles % columns === 0, ring = triangles === all * columns, inward = mesh.indices[1] !== 1;
    const kept = picked(columns, step, closed);
    return {mesh, node, rows: rows.length, columns: kept.length, flags: closed | inward << 1 | ring << 2 | flip << 3, partner,
            vertices: rows.flatMap(row => kept.map(column => row * columns + column))};
  }

  // The positions of all kept vertices for a set of controls.
  positions(set) {
    const c = Object.fromEntries(controlNames.map(name => [name, set[name] ?? 0])), weights = shapeWeights(c), {mesh} = this.head;
    mesh.positions.set(this.neutral);
    for (const [name, {vertices, offsets}] of this.expressions) {
      vertices.forEach((vertex, i) => {
        for (let k = 0; k < 3; ++k) mesh.positions[vertex * 3 + k] += (weights[name] ?? 0) * offsets[i * 3 + k];
      });
    }
    for (const part of [...this.eyes, ...this.mouth]) part.update(c);
    for (const brow of this.brows) brow.update(mesh.positions);
    return this.list.flatMap(({mesh: {positions}, vertices}) =>
      vertices.flatMap(i => [...positions.subarray(i * 3, i * 3 + 3)].map(value => Math.round(value * quantum))));
  }

  colors() {
    return this.list.flatMap(({mesh: {colors}, vertices}) =>
      vertices.flatMap(i => [...colors.subarray(i * 3, i * 3 + 3)].map(value => Math.round(value * 255))));
  }
}

const parts = new Parts(), rest = parts.positions({});
const firsts = parts.list.map((_, i) => parts.list.slice(0, i).reduce((sum, {vertices}) => sum + vertices.length, 0));

// For each vertex, the one on the other side.
const mirrored = parts.list.flatMap(({rows, columns, flags, partner}, i) =>
  Array.from({length: rows * columns}, (_, vertex) => {
    const column = vertex % columns, flipped = [column, (columns * 1.5 - column) % columns, columns - 1 - column][flags >> 3];
    return firsts[i + partner] + vertex - column + flipped;
  }));

// x of all vertices, then y, then z, each without what its neighbours in the grid predict.
const residuals = values => [0, 1, 2].flatMap(k => parts.list.flatMap(({rows, columns}, i) =>
  Array.from({length: rows * columns}, (_, at) => {
    const column = at % columns, value = vertex => values[(firsts[i] + vertex) * 3 + k];
    const left = column > 0 ? value(at - 1) : 0, below = at >= columns ? value(at - columns) : 0;
    return value(at) - left - below + (column > 0 && at >= columns ? value(at - columns - 1) : 0);
  })));

// Rounds halves towards 0, so that both sides are alike.
const nearest = value => Math.sign(value) * Math.ceil(Math.abs(value) - 0.5);

const targets = new Map();
for (const name of controlNames) {
  // As in ARKit, mouthClose is relative to an open jaw.
  const base = name === 'mouthClose' ? {jawOpen: 1} : {}, from = parts.positions(base), left = targets.get(name.replace(/Right$/, 'Left'));
  const offsets = parts.positions({...base, [name]: 1}).map((value, i) => nearest((value - from[i]) / coarser));
  targets.set(name, {offsets, coded: left ? offsets.map((value, i) =>
    value - (i % 3 === 0 ? -1 : 1) * left.offsets[mirrored[Math.floor(i / 3)] * 3 + i % 3]) : offsets});
}

// Numbers as zigzag varints: small ones of either sign are small bytes.
const bytes = [];
const put = value => {
  let rest = value < 0 ? -2 * value - 1 : 2 * value;
  for (; rest > 127; rest >>= 7) bytes.push(rest & 127 | 128);
  bytes.push(rest);
};
[parts.list.length, ...parts.list.flatMap(({node, rows, columns, flags, partner}) => [node, rows, columns, flags, partner]),
 ...residuals(rest), ...residuals(parts.colors()), ...[...targets.values()].flatMap(({coded}) => residuals(coded))].forEach(put);
while (bytes.length % 64) bytes.push(0);
writeFileSync(process.argv[2], Uint8Array.from(bytes));
