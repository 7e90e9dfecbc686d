// Eyeballs, lids and lashes. A lid is a part of a sphere slightly larger than the eyeball and moves over it, as real
// lids do. Its intersection with the skin of the head is its crease.
import {clamp01, mix, sideName} from './vectors.js';
import {palette} from './palette.js';
import {Mesh, gridTriangles, gridVertices} from './mesh.js';

const radius = 0.285;
export const centreOf = side => [side * 0.395, 0.075, 0.515];
const outward = 0.07;  // radians between the axis of an eye socket and straight ahead
const widest = 1.02;    // radians from the middle of the eye to its corners
const lidColumns = 29, lidRows = 12, ballRows = 18, ballColumns = 28;

// A point on a sphere around the eye: azimuth towards the ear, elevation upwards.
function onEye(side, azimuth, elevation, size) {
  const turned = azimuth + outward;
  const [x, y, z] = centreOf(side), r = radius * size;
  return [x + side * r * Math.sin(turned) * Math.cos(elevation), y + r * Math.sin(elevation), z + r * Math.cos(turned) * Math.cos(elevation)];
}

// Elevation of the lids in the middle of the eye, in radians above its corners, and the direction of the eye.
export function eyeState(c, side) {
  const of = name => c[name + sideName(side)];
  const blink = of('eyeBlink'), squint = of('eyeSquint'), wide = of('eyeWide'), cheek = of('cheekSquint');
  const up = of('eyeLookUp') - of('eyeLookDown'), out = of('eyeLookOut') - of('eyeLookIn');
  const upper = 0.60 + 0.27 * wide - 0.20 * squint - 0.05 * cheek + (up > 0 ? 0.13 : 0.28) * up;
  const lower = -0.50 - 0.12 * wide + 0.28 * squint + 0.22 * cheek + (up < 0 ? 0.10 : 0.05) * up + 0.1 * Math.max(0, of('mouthSmile'));
  const shut = -0.24 + 0.10 * squint + 0.06 * cheek;
  const upperLid = mix(upper, shut, blink), lowerLid = mix(Math.min(lower, upper - 0.1), shut - 0.012, blink);
  return {
    upper: Math.max(upperLid, lowerLid), lower: lowerLid,
    yaw: side * out * (out > 0 ? 0.52 : 0.50), pitch: -up * 0.42,
    squeeze: clamp01(Math.max(squint, cheek) + 0.3 * blink), blink,
  };
}

// The edge of a lid; `u` is -1 at the inner corner and 1 at the outer one.
const tilt = u => 0.045 * u;
const almond = u => Math.max(0, 1 - Math.abs(u) ** 2.3) ** 0.9;
const edge = (u, height) => tilt(u) + height * almond(u * 0.995);

class Lid {
  constructor(side, upper) {
    this.side = side;
    this.upper = upper;
    // Row 0 lies on the eyeball, row 1 in front of it: the thickness of the lid.
    const vertices = gridVertices(lidRows, lidColumns, row => ({at: [0, 0, 0], color: row < 2 ? palette.lidEdge : palette.lid}));
    const inward = (side > 0) !== upper;
    this.mesh = new Mesh('lid', vertices, gridTriangles(lidRows, lidColumns, {inward}));
  }

  update(eye) {
    const height = this.upper ? eye.upper : eye.lower, far = this.upper ? 1.45 : -1.35;
    for (let row = 0; row < lidRows; ++row) {
      const share = Math.max(0, row - 1) / (lidRows - 2), size = row === 0 ? 0.99 : 1.06 - (this.upper ? 0.03 : 0.10) * share;
      for (let column = 0; column < lidColumns; ++column) {
        const u = 1.28 * (2 * column / (lidColumns - 1) - 1);
        const from = edge(u, height);
        this.mesh.setPosition(row * lidColumns + column, onEye(this.side, widest * u, mix(from, far, share), size));
      }
    }
    this.mesh.updateNormals();
  }
}

const tubeSides = 7;

// A tube along `points` with one radius per point.
export function tubeMesh(material, count, color) {
  const vertices = gridVertices(count, tubeSides, () => ({at: [0, 0, 0], color}));
  return new Mesh(material, vertices, gridTriangles(count, tubeSides, {closed: true}));
}

export function shapeTube(mesh, points, radii, flatten = 1) {
  points.forEach(([x, y, z], row) => {
    const before = points[Math.max(0, row - 1)], after = points[Math.min(points.length - 1, row + 1)];
    const dx = after[0] - before[0], dy = after[1] - before[1];
    const length = Math.hypot(dx, dy) || 1;
    for (let k = 0; k < tubeSides; ++k) {
      const angle = 2 * Math.PI * k / tubeSides, r = radii[row];
      const across = r * Math.cos(angle), out = r * flatten * Math.sin(angle);
      mesh.setPosition(row * tubeSides + k, [x - dy / length * across, y + dx / length * across, z + out]);
    }
  });
  mesh.updateNormals();
}

const lashPoints = 24;

class Lashes {
  constructor(side) {
    this.side = side;
    this.mesh = tubeMesh('dark', lashPoints, palette.lash);
  }

  // Along the upper lid, thicker towards the outside, with a wing beyond the corner.
  update(eye) {
    const points = [], radii = [];
    for (let i = 0; i < lashPoints; ++i) {
      const share = i / (lashPoints - 1), u = mix(-0.97, 1.2, share), beyond = Math.max(0, u - 0.97);
      const lift = beyond * mix(0.75, -0.25, eye.blink);
      points.push(onEye(this.side, widest * u, edge(Math.min(u, 0.97), eye.upper) + lift, 1.085 + 0.25 * beyond));
      radii.push(0.002 + 0.021 * Math.sin(Math.PI * Math.min(1, share * 0.62 + 0.02)) * (1 - smooth(0.86, 1, share)));
    }
    shapeTube(this.mesh, points, radii, 1);
  }
}
const smooth = (from, to, value) => { const t = clamp01((value - from) / (to - from)); return t * t; };

class Eyeball {
  constructor(side) {
    this.side = side;
    const vertices = gridVertices(ballRows, ballColumns, (row, column) => {
      const polar = Math.PI * row / (ballRows - 1) * 0.62, around = 2 * Math.PI * column / ballColumns;
      const cornea = 1 + 0.045 * Math.exp(-((polar / 0.36) ** 2));
      return {at: [Math.sin(polar) * Math.cos(around), Math.sin(polar) * Math.sin(around), Math.cos(polar)].map(value => value * cornea), color: [1, 1, 1]};
    });
    this.mesh = new Mesh('eye', vertices, gridTriangles(ballRows, ballColumns, {closed: true, inward: true}));
    this.unit = this.mesh.positions.slice();  // `rest` gives the shader the position of the iris
  }

  update(eye) {
    const [cx, cy, cz] = centreOf(this.side), yaw = eye.yaw, pitch = eye.pitch, p = this.mesh.positions;
    for (let i = 0; i < p.length; i += 3) {
      const [x, y, z] = this.unit.subarray(i, i + 3);
      const y2 = y * Math.cos(pitch) - z * Math.sin(pitch), z2 = z * Math.cos(pitch) + y * Math.sin(pitch);
      p[i] = cx + radius * (x * Math.cos(yaw) + z2 * Math.sin(yaw));
      p[i + 1] = cy + radius * y2;
      p[i + 2] = cz + radius * (z2 * Math.cos(yaw) - x * Math.sin(yaw));
    }
    this.mesh.updateNormals();
  }
}

export class Eye {
  constructor(side) {
    this.side = side;
    this.parts = [new Eyeball(side), new Lid(side, true), new Lid(side, false), new Lashes(side)];
    this.meshes = this.parts.map(part => part.mesh);
  }

  update(controls) {
    const state = eyeState(controls, this.side);
    for (const part of this.parts) part.update(state);
  }
}
