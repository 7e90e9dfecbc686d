// The clock of a page: that of the video if there is one, else its own. Times are in milliseconds,
// as in the curves.

class PageClock {
  constructor() { this.at_ms = data.start_ms; this.rate = 1; this.playing = false; }
  get end_ms() { return data.end_ms; }
  get time_ms() {
    if (!this.playing) return this.at_ms;
    return Math.min(this.end_ms, this.at_ms + (performance.now() - this.since) * this.rate);
  }
  seek(t_ms) { this.at_ms = t_ms; this.since = performance.now(); }
  play() { this.since = performance.now(); this.playing = true; }
  pause() { this.at_ms = this.time_ms; this.playing = false; }
  setRate(rate) { this.seek(this.time_ms); this.rate = rate; }
}

class VideoClock {
  constructor(video) { this.video = video; }
  get end_ms() {
    const length = this.video.duration;
    return Number.isFinite(length) ? Math.min(data.end_ms, data.start_ms + length * 1000) : data.end_ms;
  }
  get playing() { return !this.video.paused && !this.video.ended; }
  get time_ms() { return data.start_ms + this.video.currentTime * 1000; }
  seek(t_ms) { this.video.currentTime = (t_ms - data.start_ms) / 1000; }
  play() { this.video.play(); }
  pause() { this.video.pause(); }
  setRate(rate) { this.video.playbackRate = rate; }
}

class Player {
  constructor(onFrame) {
    this.clock = new PageClock();
    this.onFrame = onFrame;
    this.element = id => document.getElementById(id);
    this.connect();
    const tick = () => { this.show(); requestAnimationFrame(tick); };
    requestAnimationFrame(tick);
  }

  // Uses the time of the video from now on.
  follow(video) {
    const {time_ms, playing} = this.clock;
    this.clock = new VideoClock(video);
    this.clock.setRate(Number(this.element('speed').value));
    if (time_ms > data.start_ms) this.clock.seek(time_ms);
    if (playing) this.clock.play();
  }

  connect() {
    const scrub = this.element('scrub');
    this.showRange();  // otherwise the range limits an early seek to 100
    scrub.addEventListener('input', () => this.seek(Number(scrub.value)));
    this.element('play').addEventListener('click', () => this.toggle());
    this.element('speed').addEventListener('change', event => this.clock.setRate(Number(event.target.value)));
    document.addEventListener('keydown', event => this.key(event));
  }

  // Space plays and pauses, arrows step by a frame, unless a form field has the focus.
  key(event) {
    if (event.target.closest?.('input, select, button, summary') || event.ctrlKey || event.altKey || event.metaKey) return;
    const steps = {ArrowLeft: -1, ArrowRight: 1};
    if (event.key === ' ') this.toggle();
    else if (event.key in steps) this.step(steps[event.key]);
    else return;
    event.preventDefault();
  }

  step(frames) { this.seek(this.clock.time_ms + frames * 1000 / 30); }

  toggle() {
    if (this.clock.playing) return this.clock.pause();
    if (this.clock.time_ms >= this.clock.end_ms - 1) this.clock.seek(data.start_ms);
    this.clock.play();
  }

  seek(t_ms) { this.clock.seek(Math.min(this.clock.end_ms, Math.max(data.start_ms, t_ms))); }

  atEnd() {
    if (!this.element('repeat').checked) return this.clock.pause();
    this.clock.seek(data.start_ms);
    this.clock.play();
  }

  showRange() {
    const scrub = this.element('scrub');
    scrub.min = Math.floor(data.start_ms);
    scrub.max = Math.ceil(this.clock.end_ms);
  }

  show() {
    const {clock} = this;
    if (clock.time_ms >= clock.end_ms - 1 && (clock.playing || clock.video?.ended)) this.atEnd();
    const t_ms = clock.time_ms;
    this.showRange();
    this.element('scrub').value = t_ms;
    this.element('play').textContent = clock.playing ? 'Pause' : 'Play';
    this.element('clock').textContent = `${(t_ms / 1000).toFixed(2)} / ${(clock.end_ms / 1000).toFixed(2)} s`;
    this.onFrame(t_ms);
  }
}
