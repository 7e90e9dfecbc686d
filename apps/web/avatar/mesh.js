// Triangles with the attributes of each vertex: position, normal, colour, `rest` (its position in the neutral face,
// which selects creases), and the share of the head's rotation (0..1).

export class Mesh {
  constructor(material, vertices, triangles) {
    const count = vertices.length;
    this.material = material;
    this.positions = new Float32Array(count * 3);
    this.normals = new Float32Array(count * 3);
    this.colors = new Float32Array(count * 3);
    this.rest = new Float32Array(count * 3);
    this.turning = new Float32Array(count);
    this.indices = new Uint16Array(triangles);
    vertices.forEach(({at, color, turning = 1}, i) => {
      this.positions.set(at, i * 3);
      this.colors.set(color, i * 3);
      this.turning[i] = turning;
    });
    this.rest.set(this.positions);
    this.updateNormals();
  }

  setPosition(i, [x, y, z]) {
    this.positions[i * 3] = x;
    this.positions[i * 3 + 1] = y;
    this.positions[i * 3 + 2] = z;
  }

  // The mean of the normals of adjacent triangles, weighted by area.
  updateNormals() {
    const {positions: p, normals: n, indices} = this;
    n.fill(0);
    for (let i = 0; i < indices.length; i += 3) {
      const a = indices[i] * 3, b = indices[i + 1] * 3, c = indices[i + 2] * 3;
      const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
      const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
      const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
      for (const k of [a, b, c]) {
        n[k] += x;
        n[k + 1] += y;
        n[k + 2] += z;
      }
    }
  }
}

// Triangles of a grid of `rows` x `columns` vertices; joins the last column to the first if `closed`. Seen from
// outside, columns run to the right and rows upwards; `inward` flips the triangles.
export function gridTriangles(rows, columns, {closed = false, inward = false} = {}) {
  const triangles = [];
  for (let row = 0; row + 1 < rows; ++row) {
    for (let column = 0; column + (closed ? 0 : 1) < columns; ++column) {
      const next = (column + 1) % columns;
      const a = row * columns + column, b = row * columns + next;
      const c = a + columns, d = b + columns;
      triangles.push(...(inward ? [a, c, b, b, c, d] : [a, b, c, b, d, c]));
    }
  }
  return triangles;
}

// Vertices of a grid; at(row, column) gives {at, color, turning}.
export const gridVertices = (rows, columns, at) =>
  Array.from({length: rows * columns}, (_, i) => at(Math.floor(i / columns), i % columns));
