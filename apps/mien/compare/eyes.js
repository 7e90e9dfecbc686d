// Eyes and brows. `side` is 1 for the subject's left, -1 for the right.

const sideName = side => (side > 0 ? 'Left' : 'Right');
const span = (count, at) => Array.from({length: count + 1}, (_, i) => at(2 * i / count - 1));
const irisColors = {rim: '#2f4a3d', iris: '#5f8a6c', pupil: '#15191a'};

// What the controls make of one eye: how far the lids stand above and below the line between its
// corners, where it looks, and what squeezes it.
function eyeState(c, side) {
  const of = name => c[name + sideName(side)];
  const blink = of('eyeBlink'), squint = of('eyeSquint'), wide = of('eyeWide');
  const cheek = of('cheekSquint');
  const openUpper = 0.135 + 0.085 * wide - 0.035 * squint - 0.05 * of('eyeLookDown') + 0.025 * of('eyeLookUp');
  const openLower = 0.08 + 0.025 * wide - 0.055 * squint - 0.035 * cheek;
  return {
    upper: mix(openUpper, -0.055, blink), lower: mix(openLower, 0.055, blink),
    x: 0.105 * side * (of('eyeLookOut') - of('eyeLookIn')),
    y: 0.085 * (of('eyeLookUp') - of('eyeLookDown')),
    blink, squeeze: clamp01(0.7 * squint + 0.7 * cheek), cheek,
  };
}

// u: -1 at the inner corner, 1 at the outer one.
const eyePoint = (side, u, height, out = 0.02) =>
  onSkin(side * (0.40 + 0.215 * u), 0.12 + 0.02 * u + height * (1 - Math.abs(u) ** 2.3), out);

function drawEyeball(ctx, view, side, eye) {
  const lids = [...span(20, u => eyePoint(side, u, eye.upper)),
                ...span(20, u => eyePoint(side, -u, -eye.lower))];
  ctx.save();
  trace(ctx, lids.map(view.point), true);
  ctx.clip();
  fillShape(ctx, view, lids, '#f6f2ec');
  const x = side * 0.40 + eye.x, y = 0.125 + eye.y;
  const disc = (radius, dx = 0, dy = 0) => circle(28, t =>
    onSkin(x + dx + radius * Math.cos(t), y + dy + radius * Math.sin(t), 0.03));
  fillShape(ctx, view, disc(0.115), irisColors.rim);
  fillShape(ctx, view, disc(0.098), irisColors.iris);
  fillShape(ctx, view, disc(0.05), irisColors.pupil);
  fillShape(ctx, view, disc(0.024, -0.04, 0.045), '#ffffff');
  strokeLine(ctx, view, span(20, u => eyePoint(side, u, eye.upper - 0.02)), '#6b4a3c', 0.06, 0.3);
  ctx.restore();
}

function drawLids(ctx, view, side, eye) {
  const crease = Math.max(eye.upper, 0.07) + 0.05;
  fillShape(ctx, view, [...span(20, u => eyePoint(side, u, crease, 0.015)),
                        ...span(20, u => eyePoint(side, -u, eye.upper, 0.015))], '#d39f7e');
  strokeLine(ctx, view, span(20, u => eyePoint(side, u * 0.95, crease)), skin.line, 0.018, 0.65);
  strokeLine(ctx, view, span(20, u => eyePoint(side, u, -eye.lower)), skin.dark, 0.016, 0.7);
  const wing = eyePoint(side, 1.13, Math.min(eye.upper, 0.05) * 0.1);
  strokeLine(ctx, view, [...span(20, u => eyePoint(side, u, eye.upper)), wing], '#2b1d18', 0.04);
}

// Bag under the eye and crow's feet.
function drawEyeFolds(ctx, view, side, eye) {
  const lift = 0.05 * eye.squeeze;
  strokeLine(ctx, view, span(16, u => eyePoint(side, u * 0.85, -eye.lower - 0.075 + lift)), skin.line,
             0.022, 0.18 + 0.6 * eye.squeeze);
  for (const [from, to] of [[0.16, 0.22], [0.11, 0.11], [0.06, 0.01]]) {
    const line = skinCurve([side * 0.68, from], [side * 0.73, (from + to) / 2], [side * 0.79, to]);
    strokeLine(ctx, view, line, skin.line, 0.018, 0.7 * eye.squeeze);
  }
}

function drawEye(ctx, view, c, side) {
  const eye = eyeState(c, side);
  drawEyeFolds(ctx, view, side, eye);
  drawEyeball(ctx, view, side, eye);
  drawLids(ctx, view, side, eye);
}

function drawBrow(ctx, view, c, side) {
  const down = c['browDown' + sideName(side)], outer = c['browOuterUp' + sideName(side)];
  const inner = c.browInnerUp;
  const knots = [
    [0.15 - 0.05 * down, 0.40 + 0.19 * inner - 0.13 * down],
    [0.46, 0.50 + 0.11 * inner + 0.14 * outer - 0.13 * down],
    [0.73, 0.39 + 0.21 * outer + 0.01 * inner - 0.06 * down]];
  const middle = skinCurve(...knots.map(([x, y]) => [side * x, y]), 0.03);
  const edge = sign => middle.map(([x, y, z], i) => {
    const half = 0.036 * (1 - 0.75 * (i / 12) ** 2) * (i === 0 ? 0.8 : 1);
    return [x, y + sign * half, z];
  });
  const brow = [...edge(1), ...edge(-1).reverse()];
  fillShape(ctx, view, brow, hairColors.dark);
  strokeLine(ctx, view, [...brow, brow[0]], hairColors.dark, 0.025);  // rounds its corners
}

// Lines of a raised and of a knitted forehead.
function drawForehead(ctx, view, c) {
  for (const side of [-1, 1]) {
    const raised = clamp01(0.5 * c.browInnerUp + 0.6 * c['browOuterUp' + sideName(side)]);
    for (const y of [0.70, 0.80]) {
      const lift = 0.03 * raised;
      const from = [0, y + lift + 0.02 * c.browInnerUp], to = [side * 0.5, y + lift];
      strokeLine(ctx, view, skinCurve(from, [side * 0.28, y + lift + 0.03], to), skin.line, 0.02, 0.55 * raised);
    }
    const knit = c['browDown' + sideName(side)];
    const fold = skinCurve([side * 0.06, 0.43], [side * 0.045, 0.36], [side * 0.075, 0.27]);
    strokeLine(ctx, view, fold, skin.line, 0.024, 0.8 * knit);
  }
}
