// An overview of the whole clip: audio, intervals without a face, and the visible range.

class Overview {
  constructor(take, view, losses, seek) {
    Object.assign(this, {take, view, losses, canvas: document.getElementById('overview'), all: new View(view.first_ms, view.last_ms)});
    this.wave = take.column('sound_low').steps.length ? new Wave(take) : null;
    view.onChange(() => this.draw());
    new ResizeObserver(() => this.draw()).observe(this.canvas);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.draw());
    const go = event => seek(this.all.timeAt(event.offsetX / this.canvas.clientWidth));
    this.canvas.addEventListener('pointerdown', event => { this.canvas.setPointerCapture(event.pointerId); go(event); });
    this.canvas.addEventListener('pointermove', event => { if (this.canvas.hasPointerCapture(event.pointerId)) go(event); });
  }

  show(t_ms) {
    const x = Math.round(this.all.fraction(t_ms) * this.canvas.width);
    this.t_ms = t_ms;
    if (x !== this.cursorAt) this.draw();
  }

  draw() {
    const fit = fitted(this.canvas);
    if (!fit) return;
    const {ctx, width, height, ratio} = fit, strip = 6 * ratio;
    this.wave?.draw(fit, this.all, 2 * ratio, height - strip - 2 * ratio, styleColor('wave'));
    ctx.fillStyle = styleColor('bar');
    ctx.fillRect(0, height - strip, width, strip);
    for (const {start_ms, end_ms} of this.losses) {
      const x = this.all.fraction(start_ms) * width, length = Math.max(2 * ratio, this.all.fraction(end_ms) * width - x);
      ctx.fillStyle = styleColor('gap');
      ctx.fillRect(x, 0, length, height);
      ctx.fillStyle = styleColor('alert');
      ctx.fillRect(x, height - strip, length, strip);
    }
    this.drawWindow(fit);
    this.cursorAt = Math.round(this.all.fraction(this.t_ms ?? this.all.start_ms) * width);
    ctx.fillStyle = styleColor('ink');
    ctx.fillRect(this.cursorAt - ratio / 2, 0, 1.5 * ratio, height);
  }

  drawWindow({ctx, width, height, ratio}) {
    if (this.view.whole) return;
    const from = this.all.fraction(this.view.start_ms) * width, to = Math.max(from + 4 * ratio, this.all.fraction(this.view.end_ms) * width);
    ctx.fillStyle = styleColor('veil');
    ctx.fillRect(0, 0, from, height);
    ctx.fillRect(to, 0, width - to, height);
    ctx.strokeStyle = styleColor('accent');
    ctx.lineWidth = 2 * ratio;
    ctx.strokeRect(from, ratio, to - from, height - 2 * ratio);
  }
}
