// Measurements of a face for avatar.test.mjs.
import {Avatar} from '../avatar/avatar.js';
import {columns} from '../avatar/head.js';

const width = 300, height = 370, threshold = 14;
const face = Object.assign(document.createElement('canvas'), {width, height});
const copy = Object.assign(document.createElement('canvas'), {width, height});
const avatar = new Avatar(face), ctx = copy.getContext('2d', {willReadFrequently: true});

function picture(controls, angles = {}) {
  avatar.draw({controls, ...angles});
  ctx.clearRect(0, 0, width, height);
  ctx.drawImage(face, 0, 0);
  return ctx.getImageData(0, 0, width, height).data;
}

const neutral = picture({});
const difference = data => Array.from({length: width * height}, (_, i) =>
  Math.max(...[0, 1, 2, 3].map(k => Math.abs(data[i * 4 + k] - neutral[i * 4 + k]))));

// The number of changed pixels, their centre (0..1), and the total change.
window.change = (controls, angles) => {
  const levels = difference(picture(controls, angles));
  let changed = 0, x = 0, y = 0, below = 0, sum = 0;
  levels.forEach((level, i) => {
    sum += level;
    if (level < threshold) return;
    ++changed;
    x += i % width;
    y += Math.floor(i / width);
    if (Math.floor(i / width) > height * 0.93) ++below;
  });
  return {changed, x: x / changed / width, y: y / changed / height, below, sum};
};

// The share of pixels changed by either that are changed by both, with one mirrored.
window.mirrorOverlap = (left, right) => {
  const [a, b] = [left, right].map(name => difference(picture({[name]: 1})));
  let either = 0, both = 0;
  for (let i = 0; i < a.length; ++i) {
    const there = Math.floor(i / width) * width + width - 1 - i % width;
    const one = a[i] >= threshold, other = b[there] >= threshold;
    if (one || other) ++either;
    if (one && other) ++both;
  }
  return both / either;
};

const positionsOf = controls => {
  avatar.draw({controls});
  return avatar.head.mesh.positions.slice();
};

// The maximum distance of a vertex from the mirror image of its partner.
window.mirrorOffset = (left, right) => {
  const a = positionsOf({[left]: 1}), b = positionsOf({[right]: 1});
  let most = 0;
  for (let i = 0; i < a.length / 3; ++i) {
    const column = i % columns, partner = i - column + (columns / 2 - column + columns) % columns;
    most = Math.max(most, Math.hypot(a[i * 3] + b[partner * 3], a[i * 3 + 1] - b[partner * 3 + 1], a[i * 3 + 2] - b[partner * 3 + 2]));
  }
  return most;
};

const {vertices} = avatar.head;
const find = test => vertices.findIndex(vertex => !vertex.inner && test(vertex));
const landmarks = {
  upper: find(v => v.t < 0.01 && v.sine > 0.999), lower: find(v => v.t < 0.01 && v.sine < -0.999),
  left: find(v => v.away < 1e-9 && v.u > 0.999), right: find(v => v.away < 1e-9 && v.u < -0.999),
  red: find(v => v.sine < -0.999 && v.t > 0.95 && v.t < 1.3), chin: find(v => v.sine < -0.999 && v.at[1] < -1.0)};

// Points on the mouth and the chin, in head space.
window.lips = controls => {
  const positions = positionsOf(controls);
  return Object.fromEntries(Object.entries(landmarks).map(([name, i]) => [name, [...positions.slice(i * 3, i * 3 + 3)]]));
};

// The centre between the irises in the image, by the greenest pixels, and their number.
window.noseAt = (angles, controls = {}) => {
  const data = picture(controls, angles);
  let count = 0, x = 0, y = 0;
  for (let i = 0; i < width * height; ++i) {
    const [r, g, b] = [data[i * 4], data[i * 4 + 1], data[i * 4 + 2]];
    if (g < r + 15 || g < b + 12 || i / width > height * 0.7) continue;
    ++count;
    x += i % width;
    y += Math.floor(i / width);
  }
  return {x: x / count / width, y: y / count / height, count};
};
