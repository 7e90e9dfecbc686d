// Curves and statistics, shown after the vote.

// The colours of the current style, light or dark.
const styleColor = name => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`);
const degrees = radians => radians === null ? null : radians * 180 / Math.PI;

// A curve: its name, the values of both files, and the range of its axis.
function chartable(name) {
  const k = data.controls.indexOf(name);
  if (k >= 0) return {name, low: 0, high: 1, values: file => file.controls[k]};
  const values = file => file[name].map(degrees);
  const present = [data.a, data.b].flatMap(values).filter(angle => angle !== null);
  const reach = Math.max(10, ...[0.01, 0.99].map(fraction =>
    Math.abs(present.slice().sort((p, q) => p - q)[Math.floor(fraction * (present.length - 1))] ?? 0) * 1.15));
  return {name, low: -reach, high: reach, values};
}

class Chart {
  constructor(name, seek) {
    this.of = chartable(name);
    this.element = document.createElement('div');
    this.element.className = 'chart';
    this.element.dataset.name = name;
    this.element.innerHTML = `<h3>${name} <span class="key-a">A</span> <span class="key-b">B</span></h3>`;
    this.canvas = document.createElement('canvas');
    this.cursor = document.createElement('div');
    this.cursor.className = 'cursor';
    this.element.append(this.canvas, this.cursor);
    this.canvas.addEventListener('click', event =>
      seek(mix(data.start_ms, data.end_ms, event.offsetX / this.canvas.clientWidth)));
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }

  fraction(t_ms) { return (t_ms - data.start_ms) / (data.end_ms - data.start_ms); }

  draw() {
    const {canvas} = this;
    canvas.width = canvas.clientWidth * devicePixelRatio;
    canvas.height = canvas.clientHeight * devicePixelRatio;
    const ctx = canvas.getContext('2d');
    this.drawGrid(ctx);
    for (const key of ['a', 'b']) this.drawCurve(ctx, data[key], styleColor(key));
  }

  height(value) {
    const margin = 6 * devicePixelRatio;
    return mix(this.canvas.height - margin, margin, (value - this.of.low) / (this.of.high - this.of.low));
  }

  drawGrid(ctx) {
    const {low, high} = this.of;
    ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
    for (const value of [low, (low + high) / 2, high]) {
      ctx.fillStyle = styleColor('line');
      ctx.fillRect(0, this.height(value), this.canvas.width, 1);
      ctx.fillStyle = styleColor('faint');
      ctx.textBaseline = value === high ? 'top' : 'bottom';
      ctx.fillText(high === 1 ? value : `${value.toFixed(0)}°`, 4 * devicePixelRatio, this.height(value));
    }
  }

  // Missing values interrupt the line.
  drawCurve(ctx, file, color) {
    const values = this.of.values(file);
    if (!values) return;
    ctx.beginPath();
    values.forEach((value, i) => {
      if (value === null) return;
      const x = this.fraction(file.t_ms[i]) * this.canvas.width, y = this.height(value);
      if (i > 0 && values[i - 1] !== null) ctx.lineTo(x, y); else ctx.moveTo(x, y);
    });
    ctx.strokeStyle = color;
    ctx.lineWidth = 1.5 * devicePixelRatio;
    ctx.lineJoin = 'round';
    ctx.stroke();
  }

  show(t_ms) { this.cursor.style.left = `${100 * this.fraction(t_ms)}%`; }
}

const columns = ['mean |A−B|', 'max |A−B|', 'at, s', 'correlation', 'mean A', 'mean B', 'jitter A', 'jitter B', 'frames'];
const fixed = (value, digits) => value === null ? '–' : value.toFixed(digits);

function cells(d) {
  if (!d.frames) return columns.map((_, i) => (i === columns.length - 1 ? '0' : '–'));
  return [fixed(d.mean_abs, 4), fixed(d.max_abs, 3), fixed(d.max_at_ms / 1000, 2), fixed(d.correlation, 2),
          fixed(d.mean_a, 3), fixed(d.mean_b, 3), fixed(d.jitter_a, 5), fixed(d.jitter_b, 5), String(d.frames)];
}

// Angles in degrees. Columns that do not exist for head poses stay empty.
function angleCells(d, frames) {
  if (!frames) return cells({frames: 0});
  return [fixed(d.mean_abs_deg, 2) + '°', fixed(d.max_abs_deg, 1) + '°', fixed(d.max_at_ms / 1000, 2),
          '', '', '', '', '', String(frames)];
}

class Results {
  constructor(seek) {
    this.seek = seek;
    this.charts = new Map();
    this.differences = data.differences;
  }

  open() {
    document.getElementById('results').hidden = false;
    const {matched_frames: matched, head} = this.differences;
    const note = document.getElementById('results-note');
    note.textContent = `A: ${data.a.name}, ${data.a.t_ms.length} frames. B: ${data.b.name}, ${data.b.t_ms.length} frames. ` +
      `${matched} frames match in time. Click a curve to seek; click a row below to show or hide its curve.`;
    document.getElementById('head-note').textContent = head.frames ?
      `The mean angle between both heads is ${fixed(head.rotation.mean_abs_deg, 2)}°, the maximum ${fixed(head.rotation.max_abs_deg, 1)}°.` :
      'No matched frame has a head pose in both files.';
    this.fillTable();
    for (const name of this.mostDifferent(3)) this.toggle(name);
  }

  mostDifferent(count) {
    const of = name => this.differences.controls[data.controls.indexOf(name)];
    return data.controls.filter(name => of(name).frames > 0)
      .sort((p, q) => of(q).mean_abs - of(p).mean_abs).slice(0, count);
  }

  fillTable() {
    const table = document.getElementById('statistics');
    const head = table.createTHead().insertRow();
    for (const text of ['control', ...columns]) {
      head.append(Object.assign(document.createElement('th'), {textContent: text}));
    }
    this.body = table.createTBody();
    this.row('all', cells(this.differences.all)).className = 'all';
    const {head: pose} = this.differences;
    for (const angle of ['pitch', 'yaw', 'roll']) {
      this.choice(angle, angleCells(pose[angle], pose.frames), hasHead(data.a) || hasHead(data.b));
    }
    data.controls.forEach((name, k) =>
      this.choice(name, cells(this.differences.controls[k]), drives(data.a, name) || drives(data.b, name)));
  }

  row(name, texts) {
    const row = this.body.insertRow();
    for (const text of [name, ...texts]) row.insertCell().textContent = text;
    return row;
  }

  choice(name, texts, chartable) {
    const row = this.row(name, texts);
    row.dataset.name = name;
    row.className = chartable ? 'choice' : 'undriven';
    if (chartable) row.addEventListener('click', () => this.toggle(name));
  }

  toggle(name) {
    const chart = this.charts.get(name);
    if (chart) {
      chart.element.remove();
      this.charts.delete(name);
      return;
    }
    const added = new Chart(name, this.seek);
    this.charts.set(name, added);
    document.getElementById('charts').append(added.element);
  }

  show(t_ms) { for (const chart of this.charts.values()) chart.show(t_ms); }
}
