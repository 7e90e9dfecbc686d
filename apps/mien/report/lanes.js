// Groups of curves, one lane each, over a common time axis. A click seeks; Ctrl and the wheel or
// two fingers zoom; the wheel sideways scrolls.

class Lane {
  constructor(lane, take) {
    Object.assign(this, {lane, take});
    this.element = document.createElement('section');
    this.element.className = 'lane';
    this.element.dataset.lane = lane.key;
    const title = Object.assign(document.createElement('h3'), {textContent: lane.title});
    this.legend = document.createElement('span');
    this.legend.className = 'legend';
    title.append(this.legend);
    this.canvas = document.createElement('canvas');
    this.canvas.setAttribute('role', 'img');
    this.element.append(title, this.canvas);
    this.wave = lane.wave ? new Wave(take) : null;
    this.update();
  }

  get shown() { return this.lane.series.filter(series => series.shown); }

  // Called after a switch changed.
  update() {
    const {shown} = this;
    this.element.hidden = !shown.length;
    this.range = shown.length ? this.lane.range(shown) : [0, 1];
    this.values = shown.map(series => {
      const name = document.createElement('span'), value = document.createElement('b');
      name.className = `key hue-${series.hue}${series.paler ? ' paler' : ''}`;
      name.append(`${series.name} `, value);
      return {series, name, value};
    });
    this.legend.replaceChildren(...this.values.map(({name}) => name));
    this.canvas.setAttribute('aria-label', `${this.lane.title}: ${shown.map(({name}) => name).join(', ')}`);
  }

  draw(view, losses, first) {
    const fit = fitted(this.canvas);
    if (!fit) return;
    const {ctx, width, ratio} = fit, margin = 6 * ratio, [low, high] = this.range;
    const height = value => mix(fit.height - margin, margin, (value - low) / (high - low));
    for (const {start_ms, end_ms} of losses) {
      const x = view.fraction(start_ms) * width;
      ctx.fillStyle = styleColor('gap');
      ctx.fillRect(x, 0, Math.max(ratio, view.fraction(end_ms) * width - x), fit.height);
    }
    this.drawGrid(fit, height);
    const pixels = width === first.length - 1 ? first : framesAtPixels(this.take, view, width);
    for (const series of this.shown) drawSeries(fit, series, this.take, view, pixels, height);
    this.wave?.draw(fit, view, margin, fit.height - margin, styleColor('wave'));
    this.drawLabels(fit, height);
  }

  get marks() {
    const [low, high] = this.range;
    return low < 0 && high > 0 ? [low, 0, high] : [low, high];
  }

  drawGrid({ctx, width, ratio}, height) {
    ctx.fillStyle = styleColor('line');
    for (const mark of this.marks) ctx.fillRect(0, Math.round(height(mark)), width, ratio);
  }

  drawLabels({ctx, ratio}, height) {
    ctx.font = `${10 * ratio}px system-ui, sans-serif`;
    ctx.fillStyle = styleColor('faint');
    this.marks.forEach((mark, i, all) => {
      ctx.textBaseline = i === all.length - 1 ? 'top' : i === 0 ? 'bottom' : 'middle';
      ctx.fillText(`${mark}${this.lane.unit ?? ''}`, 4 * ratio, height(mark));
    });
  }

  show(i) {
    for (const {series, value} of this.values) {
      const text = series.text(i);
      if (value.textContent !== text) value.textContent = text;
    }
  }
}

class Lanes {
  constructor(take, view, losses, seek) {
    Object.assign(this, {take, view, losses, seek});
    this.lanes = makeLanes(take).map(lane => new Lane(lane, take));
    this.place = document.getElementById('lanes');
    this.cursor = document.getElementById('cursor');
    this.ruler = document.getElementById('ruler');
    this.place.append(...this.lanes.map(({element}) => element));
    this.fingers = new Map();
    view.onChange(() => this.redraw());
    new ResizeObserver(() => this.redraw()).observe(this.place);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.redraw());
    this.connect();
  }

  get series() { return this.lanes.flatMap(({lane}) => lane.series); }

  update() {
    for (const lane of this.lanes) lane.update();
    this.redraw();
    this.show(this.t_ms ?? data.start_ms);
  }

  // Redraws once before the next frame, however often it is requested.
  redraw() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => this.draw());
  }

  draw() {
    this.asked = false;
    drawRuler(this.ruler, this.view);
    const seen = this.lanes.filter(({element}) => !element.hidden), width = Math.round(this.ruler.clientWidth * (devicePixelRatio || 1));
    const first = framesAtPixels(this.take, this.view, width);
    for (const lane of seen) lane.draw(this.view, this.losses, first);
    this.moveCursor();
  }

  show(t_ms) {
    this.t_ms = t_ms;
    const i = this.take.frameAt(t_ms);
    for (const lane of this.lanes) if (!lane.element.hidden) lane.show(i);
    this.moveCursor();
  }

  moveCursor() {
    const fraction = this.view.fraction(this.t_ms ?? data.start_ms);
    this.cursor.hidden = fraction < 0 || fraction > 1;
    this.cursor.style.transform = `translateX(${fraction * this.place.clientWidth}px)`;
  }

  connect() {
    const {place} = this;
    place.addEventListener('pointerdown', event => this.press(event));
    place.addEventListener('pointermove', event => this.move(event));
    for (const end of ['pointerup', 'pointercancel']) place.addEventListener(end, ({pointerId}) => this.fingers.delete(pointerId));
    place.addEventListener('wheel', event => this.wheel(event), {passive: false});
  }

  timeOf(clientX) {
    const {left, width} = this.place.getBoundingClientRect();
    return this.view.timeAt((clientX - left) / width);
  }

  press(event) {
    if (event.button !== 0 || event.target.tagName !== 'CANVAS') return;
    this.fingers.set(event.pointerId, event.clientX);
    this.place.setPointerCapture(event.pointerId);
    if (this.fingers.size === 1) this.seek(this.timeOf(event.clientX));
  }

  move(event) {
    if (!this.fingers.has(event.pointerId)) return;
    const before = [...this.fingers.values()];
    this.fingers.set(event.pointerId, event.clientX);
    if (this.fingers.size === 1) return this.seek(this.timeOf(event.clientX));
    this.pinch(before, [...this.fingers.values()]);
  }

  // Keeps the times under both fingers.
  pinch([a, b], [c, d]) {
    const held = this.timeOf((a + b) / 2);
    this.view.zoom(Math.max(1, Math.abs(d - c)) / Math.max(1, Math.abs(b - a)), held);
    this.view.pan(held - this.timeOf((c + d) / 2));
  }

  wheel(event) {
    const sideways = event.shiftKey ? event.deltaY || event.deltaX : event.deltaX;
    if (event.ctrlKey || event.metaKey) this.view.zoom(Math.exp(-event.deltaY / 300), this.timeOf(event.clientX));
    else if (sideways && Math.abs(sideways) >= Math.abs(event.shiftKey ? 0 : event.deltaY)) this.view.pan(sideways / this.place.clientWidth * this.view.length_ms);
    else return;
    event.preventDefault();
  }
}
