// The whole face, drawn from the 52 controls and the head's angles.

function softSpot(ctx, view, at, radius, color, alpha) {
  if (alpha <= 0.01) return;
  const [x, y] = view.point(at), r = radius * view.unit;
  const spot = ctx.createRadialGradient(x, y, 0, x, y, r);
  spot.addColorStop(0, color);
  spot.addColorStop(1, color + '00');
  ctx.save();
  ctx.globalAlpha *= Math.min(1, alpha);
  ctx.fillStyle = spot;
  ctx.fillRect(x - r, y - r, 2 * r, 2 * r);
  ctx.restore();
}

function drawCheek(ctx, view, c, side) {
  const squint = c['cheekSquint' + sideName(side)], smile = c['mouthSmile' + sideName(side)];
  const raised = clamp01(squint + 0.5 * smile), y = -0.30 + 0.07 * raised, puff = c.cheekPuff;
  softSpot(ctx, view, onSkin(side * 0.58, y - 0.1 * puff), 0.3 + 0.12 * puff, '#e0796a', 0.3 + 0.25 * raised + 0.2 * puff);
  softSpot(ctx, view, onSkin(side * 0.6, y - 0.16 * puff + 0.1), 0.18 + 0.1 * puff, '#ffe9d8', 0.25 * raised + 0.7 * puff);
  const top = skinCurve([side * 0.30, y + 0.12], [side * 0.52, y + 0.02], [side * 0.76, y + 0.20]);
  strokeLine(ctx, view, top, skin.line, 0.024, 0.7 * squint);
  const round = skinCurve([side * 0.42, -0.36], [side * 0.34, -0.62], [side * 0.5, -0.86]);
  strokeLine(ctx, view, round, skin.line, 0.024, 0.55 * puff);
}

function drawNose(ctx, view, c) {
  const lift = side => 0.075 * c['noseSneer' + sideName(side)];
  const tipLift = (lift(1) + lift(-1)) * 0.3;
  softSpot(ctx, view, onSkin(0, -0.42, 0.1), 0.24, '#a8694c', 0.35);
  const bridge = [[-0.10, 0.22, 0.0], [-0.075, 0.05, 0.1], [-0.085, -0.14, 0.18], [-0.13, -0.24, 0.2]];
  strokeLine(ctx, view, bridge.map(([x, y, out]) => onSkin(-x, y, out)), skin.shade, 0.05, 0.55);
  const ball = circle(24, t => onSkin(0.115 * Math.cos(t), -0.27 + tipLift + 0.1 * Math.sin(t), 0.25));
  fillShape(ctx, view, ball, skin.base);
  softSpot(ctx, view, onSkin(-0.03, -0.23 + tipLift, 0.3), 0.13, '#fff0e2', 0.75);
  for (const side of [-1, 1]) drawNostril(ctx, view, side, lift(side), tipLift);
  const base = skinCurve([-0.075, -0.355 + tipLift], [0, -0.40 + tipLift], [0.075, -0.355 + tipLift], 0.2);
  strokeLine(ctx, view, base, skin.line, 0.024, 0.75);
  for (const side of [-1, 1]) drawSneer(ctx, view, side, c['noseSneer' + sideName(side)]);
}

function drawNostril(ctx, view, side, lift, tipLift) {
  const wing = skinCurve([side * 0.135, -0.245 + lift], [side * 0.235, -0.31 + lift], [side * 0.15, -0.375 + lift], 0.1);
  strokeLine(ctx, view, wing, skin.line, 0.028, 0.85);
  const nostril = circle(16, t => onSkin(side * (0.095 + 0.045 * Math.cos(t)),
    -0.362 + lift * 0.7 + tipLift * 0.3 + (0.02 + 0.15 * lift) * Math.sin(t), 0.16));
  fillShape(ctx, view, nostril, skin.dark);
}

function drawSneer(ctx, view, side, sneer) {
  for (const y of [0.08, 0.0, -0.08]) {
    const line = skinCurve([side * 0.05, y], [side * 0.10, y + 0.015], [side * 0.16, y + 0.06], 0.1);
    strokeLine(ctx, view, line, skin.line, 0.02, 0.7 * sneer);
  }
}

function drawFeatures(ctx, view, c, outlines) {
  clipTo(ctx, outlines);
  for (const side of [-1, 1]) drawCheek(ctx, view, c, side);
  drawForehead(ctx, view, c);
  for (const side of [-1, 1]) drawEye(ctx, view, c, side);
  for (const side of [-1, 1]) drawBrow(ctx, view, c, side);
  ctx.restore();
  drawMouth(ctx, view, c, outlines);
  clipTo(ctx, outlines);
  drawNose(ctx, view, c);
  ctx.restore();
}

function drawFace(ctx, face) {
  const {width, height} = ctx.canvas;
  const view = makeView(width, height, face), c = face.controls;
  ctx.clearRect(0, 0, width, height);
  drawHair(ctx, view, false);
  drawShoulders(ctx, view);
  const ears = near => [-1, 1].filter(side => earIsNear(view, side) === near).forEach(side => drawEar(ctx, view, side));
  ears(false);
  drawFeatures(ctx, view, c, drawSkull(ctx, view, c));
  drawHair(ctx, view, true);
  ears(true);
}
