// Writes the avatar of apps/web as a GLB with a morph target for each of the 52 controls.
// usage: node avatar_glb.mjs OUTPUT.glb
import {writeFileSync} from 'node:fs';
import {controlNames} from '../../apps/web/avatar/avatar.js';
import {makeHead} from '../../apps/web/avatar/head.js';
import {makeExpressions, shapeWeights} from '../../apps/web/avatar/expressions.js';
import {Eye} from '../../apps/web/avatar/eyes.js';
import {makeMouth} from '../../apps/web/avatar/mouth.js';
import {Brow} from '../../apps/web/avatar/figure.js';

const irisEdge = 0.92, pupilEdge = 0.97;  // cosines of the angle to the middle of the cornea
const white = [0.95, 0.95, 0.95], iris = [0.25, 0.4, 0.5], pupil = [0.02, 0.02, 0.02];

const head = makeHead(), expressions = makeExpressions(head), neutral = head.mesh.positions.slice();
const eyes = [new Eye(1), new Eye(-1)], mouth = makeMouth(), brows = [new Brow(1, head), new Brow(-1, head)];
const meshes = [head.mesh, ...eyes.flatMap(eye => eye.meshes), ...brows.map(brow => brow.mesh), ...mouth.map(part => part.mesh)];

function pose(controls) {
  head.mesh.positions.set(neutral);
  for (const [name, weight] of Object.entries(shapeWeights(controls))) {
    const {vertices, offsets} = expressions.get(name) ?? {vertices: []};
    vertices.forEach((vertex, i) => {
      for (let k = 0; k < 3; ++k) head.mesh.positions[vertex * 3 + k] += weight * offsets[i * 3 + k];
    });
  }
  for (const part of [...eyes, ...mouth]) part.update(controls);
  for (const brow of brows) brow.update(head.mesh.positions);
  return Float32Array.from(meshes.flatMap(mesh => [...mesh.positions]));
}

// The page's shader colours eyes; here their vertices do.
function colors(mesh) {
  if (mesh.material !== 'eye') return [...mesh.colors];
  return Array.from({length: mesh.rest.length / 3}, (_, i) => {
    const z = mesh.rest[i * 3 + 2] / Math.hypot(...mesh.rest.subarray(i * 3, i * 3 + 3));
    return z > pupilEdge ? pupil : z > irisEdge ? iris : white;
  }).flat();
}

const parts = [], views = [], accessors = [];
let bytes = 0;
function add(data, type, target, range = {}) {
  const components = type === 'VEC3' ? 3 : 1, componentType = data instanceof Uint32Array ? 5125 : 5126;
  views.push({buffer: 0, byteOffset: bytes, byteLength: data.byteLength, target});
  accessors.push({bufferView: views.length - 1, componentType, count: data.length / components, type, ...range});
  parts.push(Buffer.from(data.buffer));
  bytes += data.byteLength;
  return accessors.length - 1;
}
const extremes = data => Object.fromEntries(['min', 'max'].map(which => [which, [0, 1, 2].map(k =>
  data.reduce((best, value, i) => (i % 3 === k ? Math[which](best, value) : best), which === 'min' ? Infinity : -Infinity))]));

const still = Object.fromEntries(controlNames.map(name => [name, 0]));
const rest = pose(still);
const indices = [];
let first = 0;
for (const mesh of meshes) {
  indices.push(...[...mesh.indices].map(index => index + first));
  first += mesh.positions.length / 3;
}
const attributes = {POSITION: add(rest, 'VEC3', 34962, extremes(rest)), COLOR_0: add(Float32Array.from(meshes.flatMap(colors)), 'VEC3', 34962)};
const targets = controlNames.map(name => {
  const offsets = pose({...still, [name]: 1}).map((value, i) => value - rest[i]);
  return {POSITION: add(offsets, 'VEC3', 34962, extremes(offsets))};
});
const document = {
  asset: {version: '2.0', generator: 'mien'}, scene: 0, scenes: [{nodes: [0]}], nodes: [{name: 'Avatar', mesh: 0}],
  meshes: [{name: 'Avatar', primitives: [{attributes, targets, indices: add(Uint32Array.from(indices), 'SCALAR', 34963)}], extras: {targetNames: controlNames}}],
  buffers: [{byteLength: bytes}], bufferViews: views, accessors};

const chunk = (type, data, filler) => {
  const padded = Buffer.concat([data, Buffer.alloc(-data.length & 3, filler)]), header = Buffer.alloc(8);
  header.writeUInt32LE(padded.length, 0);
  header.write(type, 4, 'latin1');
  return Buffer.concat([header, padded]);
};
const chunks = Buffer.concat([chunk('JSON', Buffer.from(JSON.stringify(document)), 0x20), chunk('BIN\0', Buffer.concat(parts), 0)]);
const header = Buffer.from('glTF\x02\0\0\0\0\0\0\0', 'latin1');
header.writeUInt32LE(12 + chunks.length, 8);
writeFileSync(process.argv[2], Buffer.concat([header, chunks]));
