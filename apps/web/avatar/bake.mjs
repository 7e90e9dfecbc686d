// Writes the avatar of morphs.js. The packed file is apps/animation/avatar.packed; apps/animation/avatar_model.h describes its content.
// usage: node bake.mjs FILE && scripts/package/pack_weights.py --any FILE PACKED
import {writeFileSync} from 'node:fs';
import {morphAvatar} from './morphs.js';

const {parts, positions, colors, targets} = morphAvatar();
const firsts = parts.map((_, i) => parts.slice(0, i).reduce((sum, {vertices}) => sum + vertices.length, 0));

// For each vertex, the one on the other side.
const mirrored = parts.flatMap(({rows, columns, flags, partner}, i) =>
  Array.from({length: rows * columns}, (_, vertex) => {
    const column = vertex % columns, flipped = [column, (columns * 1.5 - column) % columns, columns - 1 - column][flags >> 3];
    return firsts[i + partner] + vertex - column + flipped;
  }));

// x of all vertices, then y, then z, each without what its neighbours in the grid predict.
const residuals = values => [0, 1, 2].flatMap(k => parts.flatMap(({rows, columns}, i) =>
  Array.from({length: rows * columns}, (_, at) => {
    const column = at % columns, value = vertex => values[(firsts[i] + vertex) * 3 + k];
    const left = column > 0 ? value(at - 1) : 0, below = at >= columns ? value(at - columns) : 0;
    return value(at) - left - below + (column > 0 && at >= columns ? value(at - columns - 1) : 0);
  })));

// Offsets of the right side without the mirrored ones of the left side.
const coded = [...targets].map(([name, offsets]) => {
  const left = targets.get(name.replace(/Right$/, 'Left'));
  return left === offsets ? offsets : offsets.map((value, i) => value - (i % 3 === 0 ? -1 : 1) * left[mirrored[Math.floor(i / 3)] * 3 + i % 3]);
});

// Numbers as zigzag varints: small ones of either sign are small bytes.
const bytes = [];
const put = value => {
  let rest = value < 0 ? -2 * value - 1 : 2 * value;
  for (; rest > 127; rest >>= 7) bytes.push(rest & 127 | 128);
  bytes.push(rest);
};
[parts.length, ...parts.flatMap(({node, rows, columns, flags, partner}) => [node, rows, columns, flags, partner]),
 ...residuals(positions), ...residuals(colors), ...coded.flatMap(residuals)].forEach(put);
while (bytes.length % 64) bytes.push(0);
writeFileSync(process.argv[2], Uint8Array.from(bytes));
