// The skin of the head in its neutral shape. Its grid consists of rings around the mouth in elliptic coordinates: the
// innermost ring is the line between the lips, with the upper lip in one direction and the lower lip in the other, and
// rings widen to circles that end under the hair. Therefore lips open without a cut, and the grid is finest where a
// face moves most.
import {add, bump, clamp01, cross, mix, normalize, smoothstep} from './vectors.js';
import {palette} from './palette.js';
import {Mesh, gridTriangles} from './mesh.js';

const centre = [0, 0, -0.1];
const mouthAxis = normalize([0, -0.615, 0.85]);
const mouthUp = normalize(cross(mouthAxis, [1, 0, 0]));
export const mouthHalfWidth = 0.272;  // radians from the centre of the head
export const columns = 96;
const skinRings = 56;
// Rings inside the mouth: distance behind the lips, distance from the line between them, width, and share of the lip's
// motion.
const innerRings = [
  {back: 0.62, away: 0, wide: 0, follow: 0, color: palette.throat},
  {back: 0.40, away: 0.15, wide: 0.85, follow: 0.5, color: palette.throat},
  {back: 0.20, away: 0.13, wide: 0.97, follow: 0.9, color: palette.mouth},
  {back: 0.10, away: 0.06, wide: 1, follow: 1, color: palette.lipDeep},
  {back: 0.035, away: 0.008, wide: 1, follow: 1, color: palette.lip}];

function ellipsoid(direction) {
  const radii = [0.99, direction[1] > 0 ? 1.22 : 1.17, 1.0];
  const scale = 1 / Math.hypot(...direction.map((value, i) => value / radii[i]));
  return add(centre, direction, scale);
}

// Half the height of the upper and of the lower lip at `u`, -1..1 from corner to corner.
const cupid = u => 1 - 0.2 * Math.exp(-((u / 0.14) ** 2)) + 0.1 * Math.exp(-(((Math.abs(u) - 0.28) / 0.16) ** 2));
const lipWidth = u => Math.max(0, 1 - u * u) ** 0.75;
export const lipHeight = (u, upper) => (upper ? 0.075 * cupid(u) : 0.098) * lipWidth(u) + 0.002;

// How far the lips protrude; `t` is 0 at the line between them and 1 at their outer edge.
const lipProfile = t => smoothstep(-0.15, 0.5, t) * (1 - 0.72 * smoothstep(0.55, 1.25, t)) * Math.exp(-Math.max(0, t - 1.2));

function features([x, y, z], {u, t, upper, away}) {
  const front = smoothstep(0.0, 0.5, z), side = Math.abs(x);
  let out = 0;
  out += 0.07 * bump(side - 0.56, y + 0.36, 0.32, 0.28);              // cheeks
  out -= 0.14 * bump(side - 0.38, y - 0.10, 0.24, 0.24);              // eye sockets
  out += 0.045 * bump(side - 0.36, y - 0.44, 0.34, 0.13);             // brow ridge
  out += 0.075 * bump(x, y - 0.14, 0.13, 0.24);                       // bridge of the nose
  out += 0.12 * bump(x, y + 0.05, 0.12, 0.17);
  out += 0.21 * bump(x, y + 0.20, 0.15, 0.13);                        // its tip
  out += 0.095 * bump(side - 0.145, y + 0.255, 0.07, 0.075);          // its wings
  out -= 0.05 * bump(side - 0.068, y + 0.325, 0.035, 0.025);          // nostrils
  out -= 0.02 * bump(x, y + 0.43, 0.04, 0.07);                        // philtrum
  out += 0.075 * bump(x, y + 0.62, 0.36, 0.24);                       // the bulge over the teeth
  out -= 0.055 * bump(x, y + 0.84, 0.22, 0.06);                       // below the lower lip
  out += 0.115 * bump(x, y + 1.03, 0.25, 0.17);                       // chin
  out += (upper ? 0.062 : 0.07) * lipProfile(t) * lipWidth(clamp01(Math.abs(u)));
  out -= 0.035 * bump(Math.abs(u) - 1.05, away, 0.17, 0.06);           // corners of the mouth
  return out * front;
}

// The point of the neutral skin in `direction` from the centre; `lips` if it is near the mouth.
function skinPoint(direction, lips) {
  let [x, y, z] = ellipsoid(direction);
  const low = smoothstep(-0.05, -1.15, y);
  x *= 1 - 0.20 * low + 0.05 * bump(0, y + 0.45, 1, 0.4);
  z += 0.03 * low * smoothstep(0, 0.5, z) - 0.05 * smoothstep(0.5, 1.2, y) * smoothstep(0, 0.6, z);
  return [x, y, z + features([x, y, z], lips)];
}

const farFromLips = {u: 9, t: 9, upper: true, away: 9};
export const skinInDirection = direction => skinPoint(normalize(direction), farFromLips);

function vertexOnRing(angle, ring) {
  const mu = Math.acosh(0.985 * Math.PI / mouthHalfWidth) * (ring / skinRings) ** 1.1;
  const X = mouthHalfWidth * Math.cosh(mu) * Math.cos(angle), Y = mouthHalfWidth * Math.sinh(mu) * Math.sin(angle);
  const turn = Math.hypot(X, Y), across = turn > 0 ? Math.sin(turn) / turn : 1;
  const direction = [0, 1, 2].map(k =>
    Math.cos(turn) * mouthAxis[k] + across * (X * (k === 0 ? 1 : 0) + Y * mouthUp[k]));
  const away = mouthHalfWidth * Math.sinh(mu), u = X / mouthHalfWidth, upper = Math.sin(angle) >= 0;
  const height = lipHeight(Math.min(1, Math.abs(u)), upper);
  const t = Math.abs(u) < 1 ? Math.abs(Y) / height : Math.hypot(Y, (Math.abs(u) - 1) * mouthHalfWidth) / 0.03;
  // The head's curvature lifts the corners of the mouth, which would smile at rest.
  const at = skinPoint(direction, {u, t, upper, away});
  at[1] -= 0.028 * Math.min(1, u * u) * Math.exp(-((Math.max(0, Math.abs(u) - 1)) ** 2) / 0.5 - (Y / 0.2) ** 2);
  return {at, u, t, turn, away, sine: Math.sin(angle), follow: 1, inner: false};
}

function skinColor({at: [x, y, z], t, u}) {
  let color = palette.skin;
  const blend = (other, share) => { color = color.map((value, i) => mix(value, other[i], share)); };
  const front = smoothstep(0, 0.4, z);
  blend(palette.blush, 0.42 * front * bump(Math.abs(x) - 0.57, y + 0.34, 0.22, 0.17));
  blend(palette.blush, 0.35 * front * bump(x, y + 0.22, 0.13, 0.11));
  blend(palette.blush, 0.18 * front * bump(x, y + 1.05, 0.2, 0.12));
  blend(palette.lid, 0.55 * front * bump(Math.abs(x) - 0.40, y - 0.09, 0.25, 0.22));
  blend(palette.lipDeep, 0.75 * front * bump(Math.abs(x) - 0.066, y + 0.335, 0.042, 0.026));
  if (Math.abs(u) < 1.05) blend(palette.lip, (1 - smoothstep(0.86, 1.1, t)) * smoothstep(1.05, 0.93, Math.abs(u)));
  blend(palette.lipDeep, 0.75 * Math.exp(-((t / 0.13) ** 2)));
  return color;
}

function innerVertex(lip, ring) {
  const {back, away, wide} = innerRings[ring];
  const from = lip.sine * Math.abs(lip.sine) ** -0.5 || 0;
  const at = [lip.at[0] * wide, lip.at[1] + away * from, lip.at[2] - back];
  return {...lip, at, follow: innerRings[ring].follow, inner: true, color: innerRings[ring].color};
}

// The position of each vertex on the face: `u` and `t` as above, `turn` from the middle of the mouth and `away` from
// the line between the lips in radians, `sine` 1 straight above and -1 straight below it.
export function makeHead() {
  const rings = [];
  const angles = Array.from({length: columns}, (_, i) => 2 * Math.PI * i / columns);
  const lips = angles.map(angle => vertexOnRing(angle, 0));
  innerRings.forEach((_, ring) => rings.push(lips.map(lip => innerVertex(lip, ring))));
  for (let ring = 0; ring <= skinRings; ++ring) {
    rings.push(angles.map(angle => {
      const vertex = vertexOnRing(angle, ring);
      return {...vertex, color: skinColor(vertex)};
    }));
  }
  const vertices = rings.flat();
  const triangles = gridTriangles(rings.length, columns, {closed: true, inward: true});
  return {mesh: new Mesh('skin', vertices, triangles), vertices};
}
