// Selects the quality of drawing: the finest that the browser sustains. The measure is the time from the arrival of a
// result until it is drawn and the browser requests the next frame: one and a half display frames under low load.

// Each takes about half the time of the previous one when the processor draws.
export const qualities = [
  {smooth: true, scale: 1}, {smooth: false, scale: 1}, {smooth: false, scale: 0.7}, {smooth: false, scale: 0.5}, {smooth: false, scale: 0.33}];

const enough = 12, minimum = 3;  // faces per decision; the minimum suffices if they took long
const settling = 3;  // images after a change that are not measured: shaders are compiled and memory is allocated
const long_ms = 55;  // more than one and a half frames of a 30 Hz display
const short_ms = 32;
const patience_ms = 5000, maxPatience_ms = 80000;  // time before a finer quality is tried; doubles after each failed attempt

const median = values => [...values].sort((a, b) => a - b)[values.length >> 1];

export class Quality {
  constructor() {
    this.step = 0;
    this.patience_ms = patience_ms;
    this.begin(0);
  }

  get now() { return qualities[this.step]; }

  begin(time_ms) {
    this.times = [];
    this.skip = settling;
    this.since_ms = time_ms;
  }

  // A face took `took_ms`, until `time_ms`. Returns whether the quality changes.
  took(took_ms, time_ms) {
    if (this.skip > 0) {
      --this.skip;
      return false;
    }
    this.times.push(took_ms);
    const {length} = this.times, all_ms = this.times.reduce((a, b) => a + b, 0);
    if (length < minimum || (length < enough && all_ms < enough * long_ms)) return false;
    const usual_ms = median(this.times);
    this.times = [];
    if (usual_ms > long_ms) return this.coarser(usual_ms, time_ms);
    if (usual_ms < short_ms && time_ms - this.since_ms > this.patience_ms) return this.finer(time_ms);
    return false;
  }

  coarser(usual_ms, time_ms) {
    const to = Math.min(qualities.length - 1, this.step + Math.ceil(Math.log2(usual_ms / long_ms)));
    if (this.tried) this.patience_ms = Math.min(maxPatience_ms, this.patience_ms * 2);
    return this.change(to, time_ms, false);
  }

  finer(time_ms) { return this.change(Math.max(0, this.step - 1), time_ms, true); }

  // `tried`: the finer quality is an attempt.
  change(step, time_ms, tried) {
    const changes = step !== this.step;
    this.step = step;
    this.tried = tried && changes;
    if (changes) this.begin(time_ms);
    return changes;
  }
}
