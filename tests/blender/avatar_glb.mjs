// Writes the avatar of apps/web as a GLB with a morph target for each of the 52 controls.
// usage: node avatar_glb.mjs OUTPUT.glb
import {writeFileSync} from 'node:fs';
import {controlNames} from '../../apps/web/avatar/avatar.js';
import {Face} from '../../apps/web/avatar/face.js';
import {GlbFile, targets} from '../../apps/web/src/recording/glb_file.js';

const irisEdge = 0.92, pupilEdge = 0.97;  // cosines of the angle to the middle of the cornea
const white = [0.95, 0.95, 0.95], iris = [0.25, 0.4, 0.5], pupil = [0.02, 0.02, 0.02];

const face = new Face(), {meshes} = face;

function pose(controls) {
  face.pose(controls);
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

const file = new GlbFile(), still = Object.fromEntries(controlNames.map(name => [name, 0]));
const vectors = (data, bounded) => file.add(data, 'VEC3', {bounded, target: targets.vertices});
const rest = pose(still), indices = [];
let first = 0;
for (const mesh of meshes) {
  indices.push(...[...mesh.indices].map(index => index + first));
  first += mesh.positions.length / 3;
}
const primitive = {
  attributes: {POSITION: vectors(rest, true), COLOR_0: vectors(Float32Array.from(meshes.flatMap(colors)))},
  targets: controlNames.map(name => ({POSITION: vectors(pose({...still, [name]: 1}).map((value, i) => value - rest[i]), true)})),
  indices: file.add(Uint32Array.from(indices), 'SCALAR', {target: targets.indices})};
writeFileSync(process.argv[2], file.finish({
  asset: {version: '2.0', generator: 'mien'}, scene: 0, scenes: [{nodes: [0]}], nodes: [{name: 'Avatar', mesh: 0}],
  meshes: [{name: 'Avatar', primitives: [primitive], extras: {targetNames: controlNames}}]}));
