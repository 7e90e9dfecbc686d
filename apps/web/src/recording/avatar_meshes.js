// The avatar for glTF, in metres: the same meshes as those of `mien track` (apps/animation/avatar_model.cpp).
import {centreOf} from '../../avatar/eyes.js';
import {Mesh, gridTriangles} from '../../avatar/mesh.js';
import {coarser, morphAvatar, nodes, quantum} from '../../avatar/morphs.js';
import {normalize} from '../../avatar/vectors.js';
import {targets} from './glb_file.js';

const metres = 0.08;  // half the width of the head
const linear = srgb => Math.round(255 * (srgb / 255) ** 2.2);
const triple = (values, i, scale) => [...values.slice(i * 3, i * 3 + 3)].map(value => value * scale);

function trianglesOf({rows, columns, flags}, first) {
  const triangles = gridTriangles(rows + (flags >> 2 & 1), columns, {closed: flags & 1, inward: flags & 2});
  return triangles.map(i => first + i % (rows * columns));
}

// The mesh of the parts of a node. `first`: of each part, its first vertex in the avatar.
function meshOf(node, {parts, positions}, first) {
  const triangles = [], vertices = [];
  parts.forEach((part, i) => {
    if (part.node !== node) return;
    triangles.push(...trianglesOf(part, vertices.length));
    for (let k = first[i]; k < first[i] + part.vertices.length; ++k) vertices.push({at: triple(positions, k, metres / quantum), color: [0, 0, 0], index: k});
  });
  return {mesh: new Mesh('', vertices, triangles), vertices: vertices.map(({index}) => index)};
}

function primitive(file, {mesh, vertices}, colors) {
  const normals = Array.from(vertices, (_, i) => triple(mesh.normals, i, 1)).flatMap(n => (Math.hypot(...n) > 0 ? normalize(n) : [0, 0, 1]));
  return {
    attributes: {
      POSITION: file.add(mesh.positions, 'VEC3', {bounded: true, target: targets.vertices}),
      NORMAL: file.add(Float32Array.from(normals), 'VEC3', {target: targets.vertices}),
      COLOR_0: file.add(Uint8Array.from(vertices.flatMap(i => [...triple(colors, i, 1).map(linear), 255])), 'VEC4', {normalized: true, target: targets.vertices})},
    indices: file.add(mesh.indices, 'SCALAR', {target: targets.indices}), material: 0};
}

// Adds the meshes to `file`: face with a morph target for each name, body, eye. `eyes` are the centres of left and right.
export function addAvatar(file, names) {
  const avatar = morphAvatar(), first = [];
  avatar.parts.reduce((sum, {vertices}, i) => (first[i] = sum) + vertices.length, 0);
  const [head, body, eye] = [nodes.head, nodes.body, nodes.eye].map(node => meshOf(node, avatar, first));
  const offsets = name => Float32Array.from(head.vertices.flatMap(i => triple(avatar.targets.get(name), i, metres / quantum * coarser)));
  const face = {...primitive(file, head, avatar.colors), targets: names.map(name => ({POSITION: file.addSparse(offsets(name))}))};
  return {
    meshes: [{name: 'face', primitives: [face], weights: names.map(() => 0), extras: {targetNames: names}},
             {name: 'body', primitives: [primitive(file, body, avatar.colors)]}, {name: 'eye', primitives: [primitive(file, eye, avatar.colors)]}],
    materials: [{name: 'mien', pbrMetallicRoughness: {metallicFactor: 0, roughnessFactor: 0.7}}],
    eyes: [1, -1].map(side => centreOf(side).map(value => value * metres))};
}
