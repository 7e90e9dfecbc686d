// Teeth and tongue, behind the lips.
import {mix} from './vectors.js';
import {palette} from './palette.js';
import {Mesh, gridTriangles, gridVertices} from './mesh.js';
import {openJaw} from './expressions.js';

// Moves points with the lower jaw.
export function jawPose(c) {
  const shift = [0.19 * (c.jawLeft - c.jawRight), 0.05 * c.jawForward, 0.23 * c.jawForward];
  return at => openJaw(at, c.jawOpen).map((value, i) => value + shift[i]);
}

const archColumns = 41, archRows = 12;

// A row of teeth: an arch around the mouth with gum at one end and shallow grooves between the teeth.
function archPoint(row, column, upper) {
  const angle = mix(-1.25, 1.25, column / (archColumns - 1)), height = row / (archRows - 1);
  const tooth = Math.abs(Math.sin(angle * (upper ? 5.6 : 6.8))) ** 0.35;
  const wide = upper ? 0.385 : 0.34, deep = upper ? 0.50 : 0.45;
  const swell = 0.02 * Math.sin(Math.PI * Math.min(1, height * 1.2)) + 0.012 * tooth - 0.03 * Math.max(0, height - 0.8);
  const top = upper ? -0.40 : -0.77, edge = upper ? -0.645 : -0.655;
  const bottom = edge + (upper ? -1 : 1) * 0.006 * tooth - (upper ? -1 : 1) * 0.03 * Math.abs(angle);
  const out = 1 + swell / wide;
  return {
    at: [wide * out * Math.sin(angle), mix(top, bottom, height), 0.16 + deep * (0.55 + 0.45 * Math.cos(angle)) * (1 + swell) - 0.02],
    color: height < (upper ? 0.55 : 0.3) ? palette.gum : palette.tooth.map(value => value * mix(0.82, 1, tooth) * mix(1, 0.86, Math.abs(angle) / 1.25)),
  };
}

class Teeth {
  constructor(upper) {
    this.upper = upper;
    const vertices = gridVertices(archRows, archColumns, (row, column) => archPoint(row, column, upper));
    this.mesh = new Mesh('wet', vertices, gridTriangles(archRows, archColumns, {inward: upper}));
    this.neutral = vertices.map(vertex => vertex.at);
  }

  update(c) {
    if (this.upper) return;
    const pose = jawPose(c);
    this.neutral.forEach((at, i) => this.mesh.setPosition(i, pose(at)));
    this.mesh.updateNormals();
  }
}

const tongueRows = 16, tongueColumns = 16;

class Tongue {
  constructor() {
    const dark = column => 1 - 0.22 * Math.exp(-(((column / tongueColumns - 0.25) / 0.06) ** 2));  // the groove along its middle
    const vertices = gridVertices(tongueRows, tongueColumns, (_, column) =>
      ({at: [0, 0, 0], color: palette.tongue.map(value => value * dark(column))}));
    this.mesh = new Mesh('wet', vertices, gridTriangles(tongueRows, tongueColumns, {closed: true}));
  }

  // A flattened tube from the throat over the lower teeth, which bends down in front of the lip when it is out.
  update(c) {
    const pose = jawPose(c), out = c.tongueOut;
    for (let row = 0; row < tongueRows; ++row) {
      const s = row / (tongueRows - 1);
      const reach = mix(0.40 * s, 0.84 * s, out);  // distance along the tongue from the throat
      const past = Math.max(0, reach - 0.47);  // distance beyond the lips
      const curl = past * 1.9;
      const z = 0.28 + Math.min(reach, 0.47) + (past > 0 ? Math.sin(curl) / 1.9 * 0.9 : 0);
      const y = mix(-0.725, -0.655, out * Math.min(1, s * 2.2)) + mix(0.10, 0.03, out) * Math.sin(Math.PI * s) - (past > 0 ? (1 - Math.cos(curl)) / 1.9 + 0.35 * past : 0);
      const round = Math.sqrt(Math.max(0, 1 - Math.max(0, (s - 0.66) / 0.34) ** 2.8));
      const half = 0.205 * mix(1, 0.94, out) * round, thick = 0.062 * Math.sqrt(round);
      for (let k = 0; k < tongueColumns; ++k) {
        const angle = 2 * Math.PI * k / tongueColumns;
        const x = half * Math.cos(angle), groove = 0.03 * Math.exp(-((x / 0.05) ** 2)) * Math.max(0, Math.sin(angle)) * round;
        const lift = thick * Math.sin(angle) - groove;
        const lean = Math.min(1.3, curl);
        const at = [x, y + lift * Math.cos(lean), z + lift * Math.sin(lean)];
        this.mesh.setPosition(row * tongueColumns + k, pose(at));
      }
    }
    this.mesh.updateNormals();
  }
}

export const makeMouth = () => [new Teeth(true), new Teeth(false), new Tongue()];
