// The mouth: two lips that follow the jaw, teeth and tongue behind them, folds around them.

const lipColors = {upper: '#b8695f', lower: '#cd7f73', line: '#7a3a35', inside: '#431a1c', tongue: '#d0696c'};
const restLine = -0.66;  // y of the closed mouth

// Left and right value of a control, blended across the mouth; u is 1 at the subject's left corner.
const across = (c, name) => u =>
  mix(c[name + 'Right'], c[name + 'Left'], clamp01(0.5 + 0.75 * u));
const average = (c, name) => (c[name + 'Left'] + c[name + 'Right']) / 2;

function mouthCorner(c, side) {
  const of = name => c[name + sideName(side)];
  const narrow = 0.16 * c.mouthPucker + 0.11 * c.mouthFunnel + 0.04 * c.jawOpen;
  return {
    x: Math.max(0.1, 0.33 + 0.09 * of('mouthSmile') + 0.02 * of('mouthFrown') + 0.13 * of('mouthStretch') +
      0.05 * of('mouthDimple') + 0.015 * of('mouthPress') - narrow),
    y: restLine + 0.15 * of('mouthSmile') - 0.14 * of('mouthFrown') - 0.04 * of('mouthStretch') +
      0.025 * of('mouthDimple') - 0.12 * c.jawOpen * (1 - 0.5 * c.mouthClose) + 0.03 * c.mouthShrugLower,
  };
}

// Heights of the inner edges of the lips in the middle of the mouth. mouthClose takes back what the
// jaw opens; what is left of it, with the jaw shut, tucks the lips in.
function lipGap(c) {
  const drop = 0.95 * -jawShift(c)[1] - 0.03 * c.jawForward;
  const closure = Math.min(drop, 0.36 * c.mouthClose);
  const tuck = c.mouthClose - closure / 0.36;
  const shrug = 0.075 * c.mouthShrugLower;
  const parted = Math.max(0, drop - closure);
  return {
    drop, tuck,
    upper: restLine - 0.35 * closure + 0.06 * c.mouthShrugUpper + 0.06 * c.mouthFunnel +
      Math.max(0, shrug - parted) * 0.8 - 0.015 * c.mouthRollUpper + 0.02 * tuck,
    lower: restLine - drop + 0.65 * closure + shrug - 0.08 * c.mouthFunnel -
      0.07 * c.tongueOut + 0.015 * c.mouthRollLower + 0.02 * tuck,
  };
}

function lipThickness(c, gap) {
  const full = (1 + 0.45 * c.mouthFunnel + 0.45 * c.mouthPucker) * (1 - 0.4 * gap.tuck) *
    (1 - 0.2 * average(c, 'mouthSmile')) * (1 - 0.25 * average(c, 'mouthStretch'));
  const press = across(c, 'mouthPress');
  return {
    upper: u => 0.078 * full * (1 - 0.85 * c.mouthRollUpper) * (1 - 0.55 * press(u)) * (1 + 0.2 * c.mouthShrugUpper),
    lower: u => 0.105 * full * (1 - 0.85 * c.mouthRollLower) * (1 - 0.55 * press(u)) * (1 + 0.25 * c.mouthShrugLower),
  };
}

// The four edges of the lips, from the subject's right corner to the left one.
function mouthShape(c) {
  const gap = lipGap(c), thick = lipThickness(c, gap);
  const corners = {'-1': mouthCorner(c, -1), '1': mouthCorner(c, 1)};
  const [jawX, , jawZ] = jawShift(c);
  const centre = 0.15 * (c.mouthLeft - c.mouthRight) + 0.45 * jawX;
  const up = across(c, 'mouthUpperUp'), down = across(c, 'mouthLowerDown'), sneer = across(c, 'noseSneer');
  const lip = (u, y, out, jaw) => {
    const bulge = 1 - u * u;
    const x = centre + u * corners[u < 0 ? -1 : 1].x + jaw * 0.5 * jawX * bulge;
    const stand = 0.05 + out + 0.16 * (c.mouthFunnel + c.mouthPucker) + jaw * jawZ * 0.8;
    return onSkin(x, y, 0.02 + stand * bulge);
  };
  const inner = (u, middle) => mix(corners[u < 0 ? -1 : 1].y, middle, (1 - u * u) ** 0.8);
  const upper = u => inner(u, gap.upper + 0.11 * up(u) + 0.035 * sneer(u));
  const lower = u => Math.min(upper(u), inner(u, gap.lower - 0.11 * down(u)));
  const bow = u => 1 - 0.25 * Math.exp(-((u / 0.16) ** 2));
  const round = u => Math.max(0, 1 - u * u) ** 0.6;
  const samples = at => span(32, v => at(Math.sin(v * Math.PI / 2)));
  return {
    gap, corners, centre,
    upperOuter: samples(u => lip(u, upper(u) + thick.upper(u) * round(u) * bow(u), 0, 0)),
    upperInner: samples(u => lip(u, upper(u), 0.02, 0)),
    lowerInner: samples(u => lip(u, lower(u), 0.02, 1)),
    lowerOuter: samples(u => lip(u, lower(u) - thick.lower(u) * round(u), 0, 1)),
  };
}

const band = (x, top, bottom, bend, out) => [
  ...span(12, u => onSkin(x + 0.27 * u, top - bend * u * u, out)),
  ...span(12, u => onSkin(x - 0.27 * u, bottom - bend * u * u, out))];

function drawInside(ctx, view, c, shape) {
  const opening = [...shape.upperInner, ...shape.lowerInner.slice().reverse()];
  ctx.save();
  trace(ctx, opening.map(view.point), true);
  ctx.clip();
  fillShape(ctx, view, opening, lipColors.inside);
  const jaw = jawShift(c), floor = restLine - shape.gap.drop;
  fillShape(ctx, view, circle(24, t => onSkin(shape.centre + jaw[0] + 0.17 * Math.cos(t),
    floor - 0.01 + 0.09 * Math.sin(t), -0.03)), '#a84b50');
  fillShape(ctx, view, band(jaw[0], floor + 0.025, floor - 0.12, -0.02, -0.02), '#e9e3d6');
  fillShape(ctx, view, band(0, restLine + 0.12, restLine - 0.085, -0.02, 0), '#f7f3ea');
  ctx.restore();
}

function drawLips(ctx, view, c, shape) {
  const closed = (a, b) => [...a, ...b.slice().reverse()];
  fillShape(ctx, view, closed(shape.lowerInner, shape.lowerOuter), lipColors.lower);
  fillShape(ctx, view, closed(shape.upperOuter, shape.upperInner), lipColors.upper);
  const squeezed = clamp01(average(c, 'mouthPress') + (c.mouthRollUpper + c.mouthRollLower) / 2);
  strokeLine(ctx, view, shape.upperInner, lipColors.line, 0.02 + 0.014 * squeezed, 0.9);
  strokeLine(ctx, view, shape.lowerInner, lipColors.line, 0.02 + 0.014 * squeezed, 0.9);
  const shine = shape.lowerInner.slice(11, 22).map(([x, y, z], i) => [x, mix(y, shape.lowerOuter[i + 11][1], 0.45), z + 0.02]);
  strokeLine(ctx, view, shine, '#f2bdb2', 0.025, 0.5 * (1 - c.mouthRollLower));
}

function drawTongue(ctx, view, c, shape) {
  if (c.tongueOut <= 0.01) return;
  const middle = shape.lowerInner[16], x = middle[0], top = middle[1] + 0.05;
  const reach = 0.06 + 0.3 * c.tongueOut, half = 0.15;
  const side = s => Array.from({length: 10}, (_, i) => {
    const t = i / 9;
    return onSkin(x + s * half * Math.sqrt(1 - 0.9 * t ** 3), top - reach * t, 0.1 + 0.2 * c.tongueOut * Math.sqrt(t));
  });
  const tongue = [...side(-1), ...side(1).reverse()];
  fillShape(ctx, view, tongue, lipColors.tongue);
  strokeLine(ctx, view, tongue, lipColors.line, 0.014, 0.7);
  const groove = [0.1, 0.4, 0.75].map(t => onSkin(x, top - reach * t, 0.12 + 0.2 * c.tongueOut * Math.sqrt(t)));
  strokeLine(ctx, view, groove, lipColors.line, 0.02, 0.5);
}

// Folds beside the mouth: nose to corner, dimple, stretched skin, pressed corner.
function drawMouthSide(ctx, view, c, shape, side) {
  const of = name => c[name + sideName(side)];
  const corner = shape.corners[side], x = shape.centre + side * corner.x;
  const fold = 0.15 + 0.6 * of('mouthSmile') + 0.6 * of('noseSneer') + 0.4 * of('mouthUpperUp') + 0.3 * of('mouthDimple');
  const wing = [side * 0.2, -0.36 + 0.06 * of('noseSneer')];
  strokeLine(ctx, view, skinCurve(wing, [x + side * 0.12, -0.47 + 0.04 * of('mouthSmile')],
    [x + side * 0.12, corner.y - 0.02]), skin.line, 0.024, Math.min(0.8, fold));
  strokeLine(ctx, view, skinCurve([x + side * 0.045, corner.y + 0.06], [x + side * 0.10, corner.y],
    [x + side * 0.045, corner.y - 0.06]), skin.dark, 0.03, 0.85 * of('mouthDimple'));
  for (const k of [0.07, 0.13]) {
    const pulled = skinCurve([x + side * k, corner.y + 0.08], [x + side * (k + 0.04), corner.y - 0.02],
      [x + side * k, corner.y - 0.14]);
    strokeLine(ctx, view, pulled, skin.line, 0.018, 0.6 * of('mouthStretch'));
  }
  const bulge = skinCurve([x + side * 0.02, corner.y + 0.07], [x + side * 0.07, corner.y + 0.03],
    [x + side * 0.06, corner.y - 0.05]);
  strokeLine(ctx, view, bulge, skin.line, 0.022, 0.7 * of('mouthPress'));
  const droop = skinCurve([x, corner.y - 0.02], [x + side * 0.05, corner.y - 0.06], [x + side * 0.05, corner.y - 0.16]);
  strokeLine(ctx, view, droop, skin.line, 0.022, 0.7 * of('mouthFrown'));
}

// Above and below the mouth: the philtrum, puckered skin, the crease of the chin.
function drawMouthMiddle(ctx, view, c, shape) {
  const top = shape.upperOuter[16], bottom = shape.lowerOuter[16], jaw = jawShift(c);
  for (const dx of [-0.04, 0.04]) {
    strokeLine(ctx, view, skinCurve([dx * 0.7, -0.44], [dx, -0.5], [shape.centre + dx, top[1] + 0.02]), skin.line, 0.016, 0.3);
  }
  for (const k of [-2, -1, 1, 2]) {
    const x = shape.centre + 0.065 * k;
    const line = skinCurve([x, top[1] + 0.03], [x * 1.1, top[1] + 0.07], [x * 1.25, top[1] + 0.12]);
    strokeLine(ctx, view, line, skin.line, 0.018, 0.6 * c.mouthPucker);
  }
  const y = bottom[1] - 0.075, x = shape.centre + 0.6 * jaw[0];
  const crease = skinCurve([x - 0.15, y - 0.02], [x, y + 0.03], [x + 0.15, y - 0.02], 0.03);
  strokeLine(ctx, view, crease, skin.line, 0.03, 0.3 + 0.6 * c.mouthShrugLower + 0.3 * c.jawForward);
  const chin = -1.1 + jaw[1];
  for (const [dx, dy] of [[-0.09, 0], [0, 0.03], [0.09, 0], [-0.04, -0.05], [0.05, -0.05]]) {
    const at = [jaw[0] + dx, chin + dy];
    strokeLine(ctx, view, skinCurve(at, [at[0], at[1] - 0.01], [at[0] + 0.02, at[1] - 0.015], 0.05),
               skin.line, 0.025, 0.5 * c.mouthShrugLower);
  }
  const tip = skinCurve([jaw[0] - 0.14, chin - 0.02], [jaw[0], chin - 0.1], [jaw[0] + 0.14, chin - 0.02], 0.05);
  strokeLine(ctx, view, tip, skin.line, 0.024, 0.12 + 0.6 * c.jawForward);
}

// Lips stand out and may pass the outlines of a turned head; folds of the skin may not.
function drawMouth(ctx, view, c, outlines) {
  const shape = mouthShape(c);
  clipTo(ctx, outlines);
  drawMouthMiddle(ctx, view, c, shape);
  for (const side of [-1, 1]) drawMouthSide(ctx, view, c, shape, side);
  ctx.restore();
  drawInside(ctx, view, c, shape);
  drawLips(ctx, view, c, shape);
  drawTongue(ctx, view, c, shape);
}
