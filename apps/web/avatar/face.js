// The parts of the avatar that move, as meshes.
import {makeHead} from './head.js';
import {makeExpressions, shapeWeights} from './expressions.js';
import {Eye} from './eyes.js';
import {makeMouth} from './mouth.js';
import {Brow} from './figure.js';

// Shared by all faces, because computing it takes long.
let expressions;
const expressionsOf = head => (expressions ??= makeExpressions(head));

export class Face {
  constructor() {
    this.head = makeHead();
    this.neutral = this.head.mesh.positions.slice();
    this.expressions = expressionsOf(this.head);
    this.eyes = [new Eye(1), new Eye(-1)];
    this.mouth = makeMouth();
    this.brows = [new Brow(1, this.head), new Brow(-1, this.head)];
  }

  get meshes() {
    return [this.head.mesh, ...this.eyes.flatMap(eye => eye.meshes), ...this.brows.map(brow => brow.mesh), ...this.mouth.map(part => part.mesh)];
  }

  // Moves the meshes to all 52 controls.
  pose(c) {
    this.shapeHead(c);
    for (const part of [...this.eyes, ...this.mouth]) part.update(c);
    for (const brow of this.brows) brow.update(this.head.mesh.positions);
  }

  shapeHead(c) {
    const {mesh} = this.head, weights = shapeWeights(c);
    mesh.positions.set(this.neutral);
    for (const [name, {vertices, offsets}] of this.expressions) {
      const weight = weights[name];
      if (!(weight > 0)) continue;
      for (let i = 0; i < vertices.length; ++i) {
        const at = vertices[i] * 3;
        mesh.positions[at] += weight * offsets[i * 3];
        mesh.positions[at + 1] += weight * offsets[i * 3 + 1];
        mesh.positions[at + 2] += weight * offsets[i * 3 + 2];
      }
    }
    mesh.updateNormals();
  }
}
