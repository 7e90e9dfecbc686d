// The time range that the curves show.

const shortest_ms = 200;

class View {
  constructor(start_ms, end_ms) {
    Object.assign(this, {first_ms: start_ms, last_ms: end_ms, start_ms, end_ms, listeners: []});
  }

  get length_ms() { return this.end_ms - this.start_ms; }
  get whole() { return this.start_ms <= this.first_ms && this.end_ms >= this.last_ms; }
  onChange(listener) { this.listeners.push(listener); }

  set(start_ms, length_ms) {
    const all = this.last_ms - this.first_ms, length = Math.min(all, Math.max(Math.min(all, shortest_ms), length_ms));
    this.start_ms = Math.min(this.last_ms - length, Math.max(this.first_ms, start_ms));
    this.end_ms = this.start_ms + length;
    for (const listener of this.listeners) listener();
  }

  // Keeps the value at `at_ms` in place.
  zoom(factor, at_ms) {
    const length = Math.max(shortest_ms, this.length_ms / factor);
    this.set(at_ms - (at_ms - this.start_ms) * length / this.length_ms, length);
  }

  pan(ms) { this.set(this.start_ms + ms, this.length_ms); }
  all() { this.set(this.first_ms, this.last_ms - this.first_ms); }
  fraction(t_ms) { return (t_ms - this.start_ms) / this.length_ms; }
  timeAt(fraction) { return mix(this.start_ms, this.end_ms, fraction); }

  // Scrolls by a page when the current time leaves the range.
  keep(t_ms) {
    if (t_ms < this.start_ms || t_ms > this.end_ms) this.set(t_ms - 0.1 * this.length_ms, this.length_ms);
  }
}
