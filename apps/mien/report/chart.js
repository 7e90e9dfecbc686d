// Draws on canvases whose x axis is time.

// The colours of the current style, light or dark.
const styleColor = name => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

// Sets the size of a canvas to physical pixels. Returns null if the canvas is hidden.
function fitted(canvas) {
  const ratio = devicePixelRatio || 1, width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
  if (!width || !height) return null;
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
  const ctx = canvas.getContext('2d');
  ctx.clearRect(0, 0, width, height);
  return {ctx, width, height, ratio};
}

// The first frame at or after the start of each pixel column, one more than there are columns.
function framesAtPixels(take, view, width) {
  const first = new Int32Array(width + 1);
  for (let x = 0, i = take.firstFrom(view.start_ms); x <= width; ++x) {
    const t_ms = view.timeAt(x / width);
    while (i < take.frames && take.t_ms[i] < t_ms) ++i;
    first[x] = i;
  }
  return first;
}

// Draws many frames per pixel: their range, joined to the previous frame.
function traceSpans(ctx, series, first, height) {
  const scale = series.column.unit * series.scale;
  let open = false;
  for (let x = 0; x + 1 < first.length; ++x) {
    if (first[x] === first[x + 1]) continue;
    const span = series.pyramid.range(Math.max(0, first[x] - 1), first[x + 1]);
    if (!span) { open = false; continue; }
    const [low, high] = span.map(step => height(step * scale));
    if (open) ctx.lineTo(x + 0.5, low); else ctx.moveTo(x + 0.5, low);
    ctx.lineTo(x + 0.5, high + (low === high ? 0.01 : 0));
    open = true;
  }
}

// Draws few frames: from frame to frame. Missing values interrupt the line.
function traceFrames(ctx, series, take, view, width, height) {
  let open = false;
  const last = Math.min(take.frames - 1, take.firstFrom(view.end_ms));
  for (let i = Math.max(0, take.firstFrom(view.start_ms) - 1); i <= last; ++i) {
    const value = series.value(i);
    if (value === null) { open = false; continue; }
    const x = view.fraction(take.t_ms[i]) * width, y = height(value);
    if (open) ctx.lineTo(x, y); else ctx.moveTo(x, y);
    open = true;
  }
}

function drawSeries({ctx, width, ratio}, series, take, view, first, height) {
  ctx.beginPath();
  if (first[width] - first[0] > 1.5 * width) traceSpans(ctx, series, first, height);
  else traceFrames(ctx, series, take, view, width, height);
  ctx.strokeStyle = styleColor(`hue-${series.hue}`);
  ctx.globalAlpha = series.paler ? 0.55 : 1;
  ctx.lineWidth = 1.4 * ratio;
  ctx.lineJoin = 'round';
  ctx.stroke();
  ctx.globalAlpha = 1;
}

// Draws the waveform between `top` and `bottom`, scaled to its maximum.
class Wave {
  constructor(take) {
    const [low, high] = ['sound_low', 'sound_high'].map(name => take.column(name).steps);
    Object.assign(this, {low: new Pyramid(low), high: new Pyramid(high), count: low.length});
    const [quiet, loud] = [this.low.range(0, this.count)?.[0] ?? 0, this.high.range(0, this.count)?.[1] ?? 0];
    this.loudest = Math.max(8, -quiet, loud);
  }

  draw({ctx, width}, view, top, bottom, color) {
    const middle = (top + bottom) / 2, reach = (bottom - top) / 2 / this.loudest;
    const bin = x => Math.min(this.count, Math.max(0, Math.floor((view.timeAt(x / width) - data.sound_start_ms) / data.sound_bin_ms)));
    ctx.fillStyle = color;
    for (let x = 0; x < width; ++x) {
      const from = bin(x), to = Math.max(from + 1, bin(x + 1));
      if (from >= this.count) break;
      const high = this.high.range(from, to)[1] * reach, low = this.low.range(from, to)[0] * reach;
      ctx.fillRect(x, middle - high, 1, Math.max(1, high - low));
    }
  }
}

// An interval of time labels that do not overlap.
const niceStep_ms = least => [1, 2, 5, 10, 20, 50, 100, 200, 500, 1e3, 2e3, 5e3, 1e4, 15e3, 3e4, 6e4, 12e4, 3e5, 6e5, 18e5, 36e5]
  .find(step => step >= least) ?? 72e5;

const timeText = (t_ms, digits = 1) => {
  const minutes = Math.floor(t_ms / 6e4), seconds = (t_ms / 1e3 - minutes * 60).toFixed(digits).padStart(digits ? 3 + digits : 2, '0');
  return `${minutes}:${seconds}`;
};

function drawRuler(canvas, view) {
  const fit = fitted(canvas);
  if (!fit) return;
  const {ctx, width, height, ratio} = fit, step = niceStep_ms(view.length_ms * 70 * ratio / width);
  ctx.font = `${11 * ratio}px system-ui, sans-serif`;
  ctx.textBaseline = 'middle';
  for (let t = Math.ceil(view.start_ms / step) * step; t < view.end_ms; t += step) {
    const x = Math.round(view.fraction(t) * width);
    ctx.fillStyle = styleColor('line');
    ctx.fillRect(x, height * 0.25, ratio, height * 0.75);
    ctx.fillStyle = styleColor('faint');
    ctx.fillText(timeText(t, step >= 1000 ? 0 : step >= 100 ? 1 : step >= 10 ? 2 : 3), x + 4 * ratio, height * 0.5);
  }
}
