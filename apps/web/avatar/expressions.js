// How each control moves the skin of the head: the offset of every vertex at 1. A vertex is given by its position `p`
// in the neutral face and, near the mouth, by u (-1 and 1 at the corners) and t (0 between the lips, 1 at the outer
// edge of the lip).
import {columns} from './head.js';
import {bump, clamp01, mix, smoothstep} from './vectors.js';

const farthest = 1.75;  // radians from the mouth to the vertices that do not move
const hinge = [0, -0.08, -0.2];  // of the jaw
const jawAngle = 0.26;    // radians at jawOpen 1
const jawDrop = 0.16;  // lowering of the jaw at jawOpen 1
export const mouthLine = -0.605;

// Fraction of the lower jaw's motion: 1 at the chin and the middle of the lower lip, less towards the corners of the mouth
// and the ears.
export function jawShare({sine, turn}) {
  const round = sine < 0 ? mix(0.30, 1, -sine) : mix(0.30, 0, Math.min(1, sine * 1.1));
  return round * (1 - smoothstep(0.85, 1.65, turn));
}

// For sideways motion, which includes the upper lip but not the skin of the cheeks.
const jawSideShare = ({sine, turn}) =>
  mix(0.55, sine < 0 ? 1 : 0.15, Math.abs(sine)) * (1 - smoothstep(0.55, 1.25, turn));

export function openJaw([x, y, z], open) {
  const angle = jawAngle * open;
  const up = y - hinge[1], out = z - hinge[2];
  return [x, hinge[1] + up * Math.cos(angle) - out * Math.sin(angle) - jawDrop * open, hinge[2] + out * Math.cos(angle) + up * Math.sin(angle)];
}

// 1 on the lips, falling off around them.
const aroundLips = ({away}) => Math.exp(-((Math.max(0, away - 0.085) / 0.20) ** 2));
// The same, wide enough for lips that contract without folding the skin beside them.
const aroundMouth = ({away}) => Math.exp(-((Math.max(0, away - 0.07) / 0.30) ** 2));
const onLips = ({u, t}) => (1 - smoothstep(1.0, 2.0, t)) * smoothstep(1.05, 0.75, Math.abs(u));
const towards = (u, side) => smoothstep(-0.45, 0.35, u * side);
const corner = ({p, u}, side, size = 0.22) => bump(u * side * 0.3 - 0.3, p[1] - mouthLine - 0.03, size, size * 0.85) * smoothstep(0.0, 0.2, p[2]);
const softly = u => 1.25 * Math.tanh(u / 1.25) ;  // like u near the middle, constant beyond the corners
const front = ({p}) => smoothstep(0.05, 0.45, p[2]);
const near = (v, side, x, y, sizeX, sizeY) => front(v) * bump(v.p[0] * side - x, v.p[1] - y, sizeX, sizeY);
const scaled = (vector, share) => vector.map(value => value * share);
const sum = (...vectors) => vectors[0].map((_, i) => vectors.reduce((total, vector) => total + vector[i], 0));
const isUpper = v => v.sine >= 0;

// Lips that are pressed together between the corners: moves them towards the line between them, and inwards.
const thin = (v, share, depth) => {
  const toLine = mouthLine + 0.045 * Math.min(1, v.u * v.u) - v.p[1];
  return scaled([0, toLine * 0.78, -depth], share * onLips(v));
};

// Shapes of one side; the right side mirrors the left one.
const sided = {
  mouthSmile: (v, s) => sum(
    scaled([s * 0.115, 0.165, -0.05], corner(v, s, 0.27)),
    scaled([s * 0.02, 0.085, 0.055], near(v, s, 0.54, -0.32, 0.24, 0.22)),
    scaled([0, -0.018, -0.01], aroundLips(v) * bump(v.u, 0, 0.6, 1))),
  mouthFrown: (v, s) => sum(
    scaled([s * 0.015, -0.155, -0.02], corner(v, s, 0.20)),
    scaled([0, -0.05, 0.0], near(v, s, 0.40, -0.82, 0.18, 0.16)),
    scaled([0, 0.035, 0.03], front(v) * bump(v.p[0] - s * 0.06, v.p[1] + 0.95, 0.18, 0.14))),
  mouthDimple: (v, s) => sum(
    scaled([s * 0.075, 0.03, -0.10], corner(v, s, 0.15)),
    scaled([s * 0.01, 0, 0.05], near(v, s, 0.53, -0.52, 0.10, 0.16)),
    scaled([0, 0, -0.07], near(v, s, 0.44, -0.54, 0.055, 0.08))),
  mouthStretch: (v, s) => sum(
    scaled([s * 0.17, -0.055, -0.08], corner(v, s, 0.26)),
    thin(v, 0.45 * towards(v.u, s), 0.01),
    scaled([s * 0.05, -0.06, 0], near(v, s, 0.55, -0.80, 0.22, 0.25))),
  mouthPress: (v, s) => sum(
    thin(v, 0.75 * towards(v.u, s), 0.03),
    scaled([s * -0.01, 0.005, 0.05], near(v, s, 0.38, -0.56, 0.08, 0.12)),
    scaled([0, 0.02, 0.035], front(v) * bump(v.p[0] - s * 0.15, v.p[1] + 0.76, 0.14, 0.07))),
  mouthLowerDown: (v, s) => (isUpper(v) ? [0, 0, 0] :
    scaled([s * 0.02, -0.13, 0.015], towards(v.u, s) * aroundLips(v) * Math.sqrt(-v.sine))),
  mouthUpperUp: (v, s) => sum(
    isUpper(v) ? scaled([s * 0.015, 0.115, 0.02], towards(v.u, s) * aroundLips(v) * v.sine ** 0.7) : [0, 0, 0],
    scaled([0, 0.04, 0.02], near(v, s, 0.30, -0.34, 0.16, 0.14))),
  noseSneer: (v, s) => sum(
    scaled([s * 0.025, 0.105, 0.03], near(v, s, 0.15, -0.25, 0.12, 0.13)),
    scaled([0, 0.04, 0.0], near(v, s, 0.04, -0.2, 0.10, 0.12)),
    isUpper(v) ? scaled([0, 0.06, 0.015], towards(v.u, s) * aroundLips(v) * v.sine) : [0, 0, 0],
    scaled([0, 0.04, 0.035], near(v, s, 0.32, -0.18, 0.14, 0.12)),
    scaled([s * -0.03, -0.04, 0.02], near(v, s, 0.14, 0.32, 0.14, 0.14))),
  cheekSquint: (v, s) => scaled([0, 0.105, 0.085], near(v, s, 0.50, -0.22, 0.24, 0.17)),
  eyeSquint: (v, s) => sum(
    scaled([0, 0.055, 0.045], near(v, s, 0.44, -0.16, 0.22, 0.10)),
    scaled([s * -0.02, -0.03, 0.02], near(v, s, 0.40, 0.38, 0.25, 0.10))),
  eyeBlink: (v, s) => scaled([0, -0.03, 0], near(v, s, 0.40, 0.38, 0.25, 0.10)),
  eyeWide: (v, s) => scaled([0, 0.04, 0], near(v, s, 0.40, 0.42, 0.27, 0.12)),
  browDown: (v, s) => sum(
    scaled([s * -0.045, -0.13, 0.05], near(v, s, 0.20, 0.46, 0.17, 0.16)),
    scaled([s * -0.02, -0.095, 0.03], near(v, s, 0.48, 0.48, 0.20, 0.16))),
  browOuterUp: (v, s) => scaled([s * 0.01, 0.165, 0.01], near(v, s, 0.62, 0.42, 0.27, 0.30)),
  mouth: (v, s) => sum(   // mouthLeft, mouthRight
    scaled([s * 0.17, 0.02 * v.u * s, -0.02], aroundLips(v)),
    scaled([s * 0.03, 0.05, 0.03], near(v, s, 0.52, -0.42, 0.2, 0.2)),
    scaled([s * 0.03, 0, 0], front(v) * bump(v.p[0], v.p[1] + 0.3, 0.15, 0.15))),
  jaw: (v, s) => scaled([s * 0.19, 0, 0], jawSideShare(v)),  // jawLeft, jawRight
};

const middle = {
  jawOpen: v => {
    const moved = openJaw(v.p, 1), share = jawShare(v);
    const narrow = corner(v, 1) - corner(v, -1);
    return sum(scaled(moved.map((value, i) => value - v.p[i]), share), [-0.045 * narrow, 0, 0]);
  },
  jawForward: v => sum(
    scaled([0, 0.05, 0.23], jawShare(v)),
    scaled([0, 0.03, 0.06], isUpper(v) ? 0 : onLips(v)),
    scaled([v.p[0] * 0.22, -0.05, 0], front(v) * bump(v.p[0], v.p[1] + 1.02, 0.4, 0.25))),
  mouthFunnel: v => {
    const share = aroundMouth(v), high = Math.min(1, Math.abs(v.sine) * 1.1);
    const open = isUpper(v) ? 0.085 : -0.115;
    const curl = clamp01(v.t) * onLips(v) * (isUpper(v) ? 0.035 : -0.035);
    return sum(scaled([-0.105 * softly(v.u), open * high + curl, 0.17], share), [0, 0, 0.03 * onLips(v)]);
  },
  mouthPucker: v => {
    const share = aroundMouth(v), full = clamp01(v.t) * onLips(v) * (isUpper(v) ? 0.045 : -0.04);
    return sum(scaled([-0.175 * softly(v.u), 0, 0.19], share), [0, full - 0.03 * onLips(v) * v.u * v.u, 0.03 * onLips(v)]);
  },
  mouthRollLower: v => (isUpper(v) ? [0, 0, 0] : sum(
    scaled([0, (mouthLine - v.p[1]) * 0.95 + 0.02, -0.085], onLips(v) * clamp01(v.t + 0.3)),
    scaled([0, 0.04, -0.01], (1 - onLips(v)) * front(v) * bump(v.p[0], v.p[1] + 0.78, 0.26, 0.10)),
    scaled([0, 0.03, 0.02], front(v) * bump(v.p[0], v.p[1] + 0.9, 0.24, 0.12)))),
  mouthRollUpper: v => (!isUpper(v) ? [0, 0, 0] : sum(
    scaled([0, (mouthLine - v.p[1]) * 0.95 - 0.012, -0.08], onLips(v) * clamp01(v.t + 0.3)),
    scaled([0, -0.045, -0.01], (1 - onLips(v)) * front(v) * bump(v.p[0], v.p[1] + 0.44, 0.24, 0.08)))),
  mouthShrugLower: v => sum(
    isUpper(v) ? scaled([0, 0.055, 0.01], onLips(v) * (1 - v.u * v.u * 0.7)) : scaled([0, 0.075, 0.055], aroundLips(v) * mix(0.3, 1, Math.abs(v.sine))),
    scaled([0, 0.10, 0.055], front(v) * bump(v.p[0], v.p[1] + 0.96, 0.24, 0.17)),
    scaled([0, -0.035, 0], corner(v, 1, 0.13) + corner(v, -1, 0.13))),
  mouthShrugUpper: v => (!isUpper(v) ? scaled([0, 0.075, 0.04], onLips(v) * Math.abs(v.sine)) :
    scaled([0, 0.085, 0.055], aroundLips(v) * mix(0.1, 1, v.sine))),
  cheekPuff: v => {
    const puff = side => scaled([side * 0.165, 0.01, 0.19], bump(v.p[0] * side - 0.60, v.p[1] + 0.50, 0.27, 0.29) * smoothstep(-0.5, 0.4, v.p[2]));
    return sum(puff(1), puff(-1), scaled([-0.05 * v.u, 0, 0.05], onLips(v)), thin(v, 0.25, 0));
  },
  browInnerUp: v => [1, -1].map(s => sum(
    scaled([s * -0.02, 0.20, 0.02], near(v, s, 0.13, 0.44, 0.17, 0.30)),
    scaled([0, 0.04, 0.01], near(v, s, 0.36, 0.50, 0.16, 0.2)))).reduce((a, b) => sum(a, b)),
  // Corrective shapes for combinations of controls: lips that meet while the jaw is open, lips pressed flat while it is
  // closed, and a lower lip that makes way for the tongue.
  lipsTogether: v => {
    const open = middle.jawOpen(v);
    const reach = isUpper(v) ? 0 : aroundLips(v);
    const meet = isUpper(v) ? [0, -0.10 * v.sine, -0.015] : [0, -open[1] - 0.10 * -v.sine, -open[2] * 0.85];
    return scaled(meet, isUpper(v) ? aroundLips(v) : reach);
  },
  lipsPressed: v => sum(thin(v, 0.4, 0.035), scaled([0, isUpper(v) ? 0.008 : 0.02, -0.02], onLips(v))),
  tongueGap: v => (isUpper(v) ? scaled([0, 0.02, 0.01], aroundLips(v) * v.sine) :
    scaled([0, -0.15, 0.03], aroundLips(v) * bump(v.u, 0, 0.85, 1) * -v.sine)),
};

// Mirrors a shape of the left side to the right. Columns of the grid run around the mouth from the left corner.
function inMirror({vertices, offsets}) {
  const partners = vertices.map(i => {
    const column = i % columns;
    return i - column + (columns * 1.5 - column) % columns;
  });
  return {vertices: partners, offsets: offsets.map((value, k) => (k % 3 === 0 ? -value : value))};
}

// The indices of the vertices that `shape` moves, and three offsets for each. Vertices inside the mouth move with the
// edge of their lip.
function sampled(shape, places) {
  const moved = [], offsets = [], edge = places.findIndex(vertex => !vertex.inner);
  places.forEach((vertex, i) => {
    if (vertex.turn > farthest) return;
    const offset = scaled(shape(vertex.inner ? places[edge + i % columns] : vertex), vertex.follow);
    if (Math.hypot(...offset) < 5e-4) return;
    moved.push(i);
    offsets.push(...offset);
  });
  return {vertices: Uint16Array.from(moved), offsets: Float32Array.from(offsets)};
}

// All shapes by name, for a head of head.js.
export function makeExpressions({vertices}) {
  const places = vertices.map(vertex => ({...vertex, p: vertex.at}));
  const expressions = new Map(Object.entries(middle).map(([name, shape]) => [name, sampled(shape, places)]));
  for (const [name, shape] of Object.entries(sided)) {
    const left = sampled(v => shape(v, 1), places);
    expressions.set(name + 'Left', left).set(name + 'Right', inMirror(left));
  }
  return expressions;
}

// Weights of the shapes for a set of controls: a control's own value, or a function of several controls for shapes that
// interact.
export function shapeWeights(c) {
  const weights = {...c};
  const together = Math.min(c.mouthClose, c.jawOpen);
  delete weights.mouthClose;
  weights.lipsTogether = together;
  weights.lipsPressed = c.mouthClose - together;
  weights.tongueGap = c.tongueOut * (1 - 0.75 * clamp01(c.jawOpen * 1.5));
  const round = Math.max(c.mouthFunnel, c.mouthPucker);  // both together do not move the lips twice as far
  const both = c.mouthFunnel + c.mouthPucker;
  if (both > 0) {
    weights.mouthFunnel *= mix(1, round / both, 0.6);
    weights.mouthPucker *= mix(1, round / both, 0.6);
  }
  return weights;
}
