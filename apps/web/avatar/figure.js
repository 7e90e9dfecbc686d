// Parts that do not deform: ears, hair, neck and clothes; and the brows, which follow the skin.
import {add, mix, sideName, smoothstep} from './vectors.js';
import {palette} from './palette.js';
import {Mesh, gridTriangles, gridVertices} from './mesh.js';
import {skinInDirection} from './head.js';
import {shapeTube, tubeMesh} from './eyes.js';

const blend = (a, b, t) => a.map((value, i) => mix(value, b[i], t));

function makeEar(side) {
  const rows = 14, columns = 22;
  const vertices = gridVertices(rows, columns, (row, column) => {
    const polar = Math.PI * row / (rows - 1), around = 2 * Math.PI * column / columns;
    const flat = [Math.sin(polar) * Math.cos(around), Math.sin(polar) * Math.sin(around), Math.cos(polar)];
    // A shell with a concave outer side.
    const hollow = flat[2] > 0 ? 0.75 * Math.exp(-(flat[0] ** 2 + flat[1] ** 2) / 0.34) : 0;
    const x = flat[0] * 0.155 * (flat[1] < 0 ? 1 + 0.35 * flat[1] : 1), y = flat[1] * 0.25, out = (flat[2] - hollow * 1.5) * 0.075;
    const flare = 0.62;
    return {
      at: [side * (1.0 + out * Math.cos(flare) - x * Math.sin(flare) * 0.9 + 0.05), 0.0 + y, -0.06 + x * Math.cos(flare) + out * Math.sin(flare)],
      color: blend(palette.skin, palette.ear, 0.25 + hollow)};
  });
  return new Mesh('skin', vertices, gridTriangles(rows, columns, {closed: true, inward: side < 0}));
}

// Hair: a shell over the skull down to the hairline, with locks.
function makeHair() {
  const rows = 22, columns = 108;
  const vertices = gridVertices(rows, columns, (row, column) => {
    const azimuth = 2 * Math.PI * column / columns - Math.PI, away = Math.abs(azimuth);
    const swept = azimuth + 0.55 * (1 - row / rows) ** 1.3;  // locks bend to one side towards their ends
    const lock = Math.sin(swept * 7 + 1.1 * Math.sin(swept * 3)), fine = Math.sin(swept * 23 + Math.sin(swept * 9));
    const front = Math.exp(-((away / 0.85) ** 2)), ear = Math.exp(-(((away - 1.62) / 0.30) ** 4));
    let line = mix(0.72, 2.30, smoothstep(0.55, 2.0, away)) - 0.50 * ear;
    line += 0.07 * Math.exp(-(((away - 1.12) / 0.14) ** 2));             // sideburns
    line += 0.035 * lock * (front + 0.2) + 0.15 * front * Math.sin((azimuth - 0.35) * 1.2);
    const share = Math.min(1, row / (rows - 4)), inside = Math.max(0, row - (rows - 4)) / 3;
    const polar = line * (share - 0.02 * inside);
    const direction = [Math.sin(polar) * Math.sin(azimuth), Math.cos(polar), Math.sin(polar) * Math.cos(azimuth)];
    const skin = skinInDirection(direction);
    const round = Math.sqrt(Math.max(0, 1 - Math.max(0, (share - 0.6) / 0.42) ** 2.2));
    let thick = (0.12 + 0.15 * front * smoothstep(0.25, 0.85, share) * (1 - 0.35 * Math.sin(azimuth - 0.3)) - 0.045 * ear * share) * round;
    thick += share * round * (0.028 * lock * (0.4 + front) + 0.007 * fine);
    thick = mix(thick + 0.015, -0.05, inside);
    const shine = 0.5 + 0.3 * lock + 0.2 * fine;
    return {at: add(skin, direction, thick), color: blend(palette.hair, palette.hairTip, shine * share * (1 - inside))};
  });
  return new Mesh('hair', vertices, gridTriangles(rows, columns, {closed: true, inward: true}));
}

function lathe(material, profile, columns, depth, colorOf, turningOf = () => 0) {
  const vertices = gridVertices(profile.length, columns, (row, column) => {
    const angle = 2 * Math.PI * column / columns, [r, y, z = -0.28] = profile[row];
    const at = [r * Math.sin(angle), y, z + r * depth * Math.cos(angle)];
    return {at, color: colorOf(at, row), turning: turningOf(at)};
  });
  return new Mesh(material, vertices, gridTriangles(profile.length, columns, {closed: true}));
}

const neckProfile = [[0.62, -1.95], [0.50, -1.7], [0.45, -1.5], [0.43, -1.3], [0.44, -1.1], [0.45, -0.9], [0.36, -0.72, -0.42]];
const shade = (color, amount) => color.map(value => value * amount);

// Darker under the chin; the upper end rotates with the head.
const makeNeck = () => lathe('neck', neckProfile, 40, 0.92,
  ([, y, z]) => shade(blend(palette.skin, palette.blush, 0.12), mix(1, 0.70, smoothstep(-1.6, -1.15, y) * smoothstep(-0.6, 0.1, z))),
  ([, y]) => smoothstep(-1.55, -0.85, y));

function makeShirt() {
  const rows = 14, columns = 40;
  const vertices = gridVertices(rows, columns, (row, column) => {
    const share = row / (rows - 1), angle = 2 * Math.PI * column / columns, side = Math.abs(Math.sin(angle));
    const r = mix(0.56, 1.0, share ** 0.8), drop = share ** 1.9;
    const wide = mix(1, 1.72, share) * r, deep = mix(0.86, 0.78, share) * r;
    return {at: [wide * Math.sin(angle), -1.50 - 1.25 * drop * mix(1.25, 0.9, side) - 0.16 * share, -0.30 + deep * Math.cos(angle)],
            color: blend(palette.shirt, palette.shirtDark, share * 0.6), turning: 0};
  });
  return new Mesh('cloth', vertices, gridTriangles(rows, columns, {closed: true, inward: true}));
}

function makeCollar() {
  const columns = 44, rows = 10;
  const vertices = gridVertices(rows, columns, (row, column) => {
    const angle = 2 * Math.PI * column / columns, around = 2 * Math.PI * row / rows;
    const thick = 0.115 + 0.03 * Math.cos(angle + Math.PI), r = 0.585 + thick * Math.cos(around);
    const dip = -0.11 * Math.cos(angle);
    return {at: [r * Math.sin(angle), -1.48 + dip + thick * 1.05 * Math.sin(around), -0.27 + 0.95 * r * Math.cos(angle)],
            color: blend(palette.shirt, palette.shirtDark, 0.5 - 0.5 * Math.sin(around)), turning: 0};
  });
  const triangles = gridTriangles(rows + 1, columns, {closed: true, inward: false}).map(i => i % (rows * columns));
  return new Mesh('cloth', vertices, triangles);
}

export const makeFigure = () => [makeEar(1), makeEar(-1), makeHair(), makeNeck(), makeShirt(), makeCollar()];

const browLength = 14;
// From the inner to the outer end: position, and half the height.
const browCurve = Array.from({length: browLength}, (_, i) => {
  const t = i / (browLength - 1);
  return [0.135 + 0.575 * t, 0.392 + 0.105 * Math.sin(Math.PI * Math.min(1, t * 0.86 + 0.06)) - 0.075 * t ** 3];
});
const browRadii = browCurve.map((_, i) => {
  const t = i / (browLength - 1);
  return 0.046 * Math.sqrt(Math.min(1, t / 0.16 + 0.06)) * (1 - 0.86 * t ** 2.4);
});

// A brow lies on the skin: each of its points follows the nearest vertices of the head.
export class Brow {
  constructor(side, head) {
    this.name = sideName(side);
    this.mesh = tubeMesh('brow', browCurve.length, palette.brow);
    this.anchors = browCurve.map(([x, y]) => this.nearest(head.vertices, side * x, y));
  }

  nearest(vertices, x, y) {
    const close = [];
    vertices.forEach(({at}, i) => {
      const distance = Math.hypot(at[0] - x, at[1] - y);
      if (at[2] > 0 && distance < 0.12) close.push({i, at, distance});
    });
    close.sort((a, b) => a.distance - b.distance).splice(4);
    const total = close.reduce((sum, {distance}) => sum + 1 / (distance + 0.01), 0);
    const z = close.reduce((sum, {at, distance}) => sum + at[2] / (distance + 0.01) / total, 0);
    return {at: [x, y, z + 0.02], followed: close.map(({i, at, distance}) => ({i, at, weight: 1 / (distance + 0.01) / total}))};
  }

  // `positions` are the current ones of the head.
  update(positions) {
    const points = this.anchors.map(({at, followed}) => {
      const point = at.slice();
      for (const {i, at: from, weight} of followed) {
        for (let k = 0; k < 3; ++k) point[k] += weight * (positions[i * 3 + k] - from[k]);
      }
      return point;
    });
    shapeTube(this.mesh, points, browRadii, 0.65);
  }
}
