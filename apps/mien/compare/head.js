// The head that carries the face: a pinhole view of 3D points, skull, jaw, ears, hair, shoulders.
// Head space as in mien.h: x to the subject's left (the picture's right), y up, z out of the face;
// half the width of the head is 1.

const skin = {base: '#e3b190', light: '#f3cdb0', shade: '#c58e6d', line: '#8f5a41', dark: '#6f4331'};
const hairColors = {light: '#57463d', dark: '#352a25'};
const mix = (a, b, t) => a + (b - a) * t;
const clamp01 = value => Math.min(1, Math.max(0, value));

// Positive pitch looks down, yaw turns to the subject's left; R = Ry(yaw) Rx(pitch) Rz(roll).
function rotate([x, y, z], {pitch, yaw, roll}) {
  [x, y] = [x * Math.cos(roll) - y * Math.sin(roll), x * Math.sin(roll) + y * Math.cos(roll)];
  [y, z] = [y * Math.cos(pitch) - z * Math.sin(pitch), y * Math.sin(pitch) + z * Math.cos(pitch)];
  return [z * Math.sin(yaw) + x * Math.cos(yaw), y, z * Math.cos(yaw) - x * Math.sin(yaw)];
}

// The head turns about a point in the neck and is seen from 7 units away.
function makeView(width, height, face) {
  const unit = Math.min(width / 3.15, height / 3.7);
  const pivot = [0, -0.55, -0.25];
  const place = point => {
    const turned = rotate(point.map((value, i) => value - pivot[i]), face);
    return turned.map((value, i) => value + pivot[i]);
  };
  const project = ([x, y, z]) => {
    const scale = unit * 7 / (7 - z);
    return [width / 2 + x * scale, height * 0.465 - y * scale];
  };
  return {unit, width, height, place, fixed: project, point: at => project(place(at))};
}

// Depth of the skin of the face at (x, y), and the point there; `out` stands off it.
const skinDepth = (x, y) =>
  0.88 * Math.sqrt(Math.max(0.06, 1 - (x / 1.04) ** 2 - ((y - 0.1) / 1.6) ** 2));
const onSkin = (x, y, out = 0) => [x, y, skinDepth(x, y) + out];

function trace(ctx, points, closed) {
  ctx.beginPath();
  points.forEach(([x, y], i) => (i ? ctx.lineTo(x, y) : ctx.moveTo(x, y)));
  if (closed) ctx.closePath();
}

function fillShape(ctx, view, points, color) {
  trace(ctx, points.map(view.point), true);
  ctx.fillStyle = color;
  ctx.fill();
}

// A line `width` head units thick; nothing where it would not be seen.
function strokeLine(ctx, view, points, color, width, alpha = 1) {
  if (alpha <= 0.01) return;
  ctx.save();
  ctx.globalAlpha *= Math.min(1, alpha);
  ctx.lineCap = ctx.lineJoin = 'round';
  ctx.strokeStyle = color;
  ctx.lineWidth = width * view.unit;
  trace(ctx, points.map(view.point), false);
  ctx.stroke();
  ctx.restore();
}

// A quadratic curve from a by way of c to b on the skin; points are [x, y].
function skinCurve(a, c, b, out = 0.01) {
  return Array.from({length: 13}, (_, i) => {
    const t = i / 12;
    const [x, y] = [0, 1].map(k => (1 - t) ** 2 * a[k] + 2 * t * (1 - t) * c[k] + t ** 2 * b[k]);
    return onSkin(x, y, out);
  });
}

const circle = (count, at) =>
  Array.from({length: count}, (_, i) => at(2 * Math.PI * i / count));

function convexHull(points) {
  const sorted = points.slice().sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const turns = (o, a, b) => (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
  const half = list => {
    const chain = [];
    for (const point of list) {
      while (chain.length > 1 && turns(chain.at(-2), chain.at(-1), point) <= 0) chain.pop();
      chain.push(point);
    }
    return chain.slice(0, -1);
  };
  return [...half(sorted), ...half(sorted.reverse())];
}

const craniumPoint = (polar, azimuth, size = 1) => [
  0.96 * size * Math.sin(polar) * Math.sin(azimuth),
  0.30 + 1.02 * size * Math.cos(polar),
  -0.12 + 1.02 * size * Math.sin(polar) * Math.cos(azimuth)];

const cranium = Array.from({length: 15}, (_, row) =>
  circle(36, azimuth => craniumPoint(Math.PI * (row + 0.5) / 17, azimuth))).flat();

// Of the subject's left side, from the temple to the chin: x, y, z, how far the point goes with the
// jaw, and how far a puffed cheek pushes it out.
const jawline = [
  [0.93, 0.05, 0.05, 0, 0], [0.91, -0.22, 0.08, 0, 0.03], [0.87, -0.46, 0.12, 0.1, 0.13],
  [0.79, -0.70, 0.18, 0.4, 0.17], [0.66, -0.93, 0.30, 0.75, 0.08], [0.47, -1.12, 0.46, 0.95, 0.01],
  [0.24, -1.235, 0.58, 1, 0], [0.08, -1.265, 0.62, 1, 0], [0, -1.27, 0.62, 1, 0]];

// How the jaw has moved: [x, y, z].
const jawShift = c => [
  0.17 * (c.jawLeft - c.jawRight), -0.36 * c.jawOpen - 0.03 * c.jawForward, 0.3 * c.jawForward];

const catmullRom = (p, q, r, s, t) => 0.5 * (2 * q + (r - p) * t + (2 * p - 5 * q + 4 * r - s) * t ** 2 +
  (3 * q - p - 3 * r + s) * t ** 3);

function jawPoints(c) {
  const [dx, dy, dz] = jawShift(c);
  const moved = jawline.map(([x, y, z, jaw, puff]) => ({
    x: x + puff * c.cheekPuff + 0.05 * jaw * c.jawForward * Math.min(1, x * 3),
    shift: dx * jaw, y: y + dy * jaw, z: z + dz * jaw + puff * c.cheekPuff}));
  const points = [];
  for (let i = 0; i + 1 < moved.length; ++i) {
    const near = [-1, 0, 1, 2].map(k => moved[Math.min(moved.length - 1, Math.max(0, i + k))]);
    for (let t = 0; t < 1; t += 0.125) {
      const at = key => catmullRom(...near.map(point => point[key]), t);
      for (const side of [-1, 1]) points.push([side * at('x') + at('shift'), at('y'), at('z')]);
    }
  }
  return points;
}

function drawShoulders(ctx, view) {
  const neck = circle(24, t => [0.5 * Math.cos(t), -0.95, -0.3 + 0.42 * Math.sin(t)]).map(view.point);
  const base = circle(24, t => [0.6 * Math.cos(t), -1.75, -0.3 + 0.42 * Math.sin(t)]).map(view.fixed);
  trace(ctx, convexHull([...neck, ...base]), true);
  ctx.fillStyle = skin.shade;
  ctx.fill();
  const {width, height, unit} = view;
  ctx.beginPath();
  ctx.moveTo(width / 2 - 1.75 * unit, height);
  ctx.bezierCurveTo(width / 2 - 1.6 * unit, height - 0.42 * unit, width / 2 - 0.9 * unit,
                    height - 0.3 * unit, width / 2 - 0.6 * unit, height - 0.52 * unit);
  ctx.quadraticCurveTo(width / 2, height - 0.12 * unit, width / 2 + 0.6 * unit, height - 0.52 * unit);
  ctx.bezierCurveTo(width / 2 + 0.9 * unit, height - 0.3 * unit, width / 2 + 1.6 * unit,
                    height - 0.42 * unit, width / 2 + 1.75 * unit, height);
  ctx.fillStyle = '#51677f';
  ctx.fill();
}

function drawEar(ctx, view, side) {
  const rim = size => circle(28, t => [
    side * (0.93 + 0.09 * (1 - Math.cos(t))), 0.0 + 0.25 * size * Math.sin(t) - 0.02 * Math.cos(t),
    -0.08 - 0.11 * size * (1 - Math.cos(t)) / 2 - (1 - size) * 0.1]);
  fillShape(ctx, view, rim(1), skin.base);
  strokeLine(ctx, view, [...rim(1), rim(1)[0]], skin.line, 0.016, 0.7);
  strokeLine(ctx, view, rim(0.6).slice(3, 22), skin.line, 0.02, 0.4);
}

const earIsNear = (view, side) => view.place([side, 0, -0.1])[2] > 0.2;

// The half of the hair that faces the viewer, or the other.
function drawHair(ctx, view, front) {
  const rows = 8, columns = 72;
  const hairline = azimuth => mix(0.86, 2.15, ((1 - Math.cos(azimuth)) / 2) ** 0.9);
  const at = (row, column) => {
    const azimuth = 2 * Math.PI * column / columns;
    return view.place(craniumPoint(hairline(azimuth) * row / rows, azimuth, 1.05));
  };
  const centre = view.place([0, 0.3, -0.12]);
  const [x, y] = view.point([-0.35, 1.2, 0.5]);
  const shine = ctx.createRadialGradient(x, y, 0, x, y, 1.3 * view.unit);
  shine.addColorStop(0, front ? hairColors.light : hairColors.dark);
  shine.addColorStop(1, hairColors.dark);
  ctx.fillStyle = ctx.strokeStyle = shine;
  ctx.lineWidth = 1.5;
  for (let row = 0; row < rows; ++row) {
    for (let column = 0; column < columns; ++column) {
      const corners = [at(row, column), at(row + 1, column), at(row + 1, column + 1), at(row, column + 1)];
      if (corners.some(([, , z]) => z > centre[2] - 0.05) !== front) continue;
      trace(ctx, corners.map(view.fixed), true);
      ctx.fill();
      ctx.stroke();
    }
  }
}

// The nose as far as it shows beside a turned head.
const noseOutline = view => convexHull([
  onSkin(0, 0.3, 0), onSkin(0, -0.42, 0.02), ...circle(24, t => onSkin(0.1 * Math.cos(t), -0.27 + 0.1 * Math.sin(t), 0.27)),
].map(view.point));

// The skin of the head; returns its outlines in pixels.
function drawSkull(ctx, view, c) {
  const outlines = [convexHull([...cranium, ...jawPoints(c)].map(view.point)), noseOutline(view)];
  const [x, y] = view.point([-0.3, 0.25, 0.85]);
  const light = ctx.createRadialGradient(x, y, 0.1 * view.unit, x, y, 1.75 * view.unit);
  light.addColorStop(0, skin.light);
  light.addColorStop(0.6, skin.base);
  light.addColorStop(1, skin.shade);
  ctx.fillStyle = light;
  ctx.strokeStyle = skin.line;
  ctx.lineWidth = 0.03 * view.unit;
  ctx.lineJoin = 'round';
  // Filled after all strokes, so that no line crosses where one part lies before the other.
  for (const draw of [() => ctx.stroke(), () => ctx.fill()]) {
    for (const outline of outlines) {
      trace(ctx, outline, true);
      draw();
    }
  }
  return outlines;
}

// Only what lies within one of the outlines, until ctx.restore().
function clipTo(ctx, outlines) {
  ctx.save();
  ctx.beginPath();
  for (const outline of outlines) {
    outline.forEach(([x, y], i) => (i ? ctx.lineTo(x, y) : ctx.moveTo(x, y)));
    ctx.closePath();
  }
  ctx.clip();
}
