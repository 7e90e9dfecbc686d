// How finely faces are drawn: as finely as the browser keeps up with. What tells is how long a face takes from when it is there
// until it is drawn and the browser asks for the next: one and a half ticks of the screen where all is well.

// Each takes about half as long as the one before it where processors draw.
export const qualities = [
  {smooth: true, scale: 1}, {smooth: false, scale: 1}, {smooth: false, scale: 0.7}, {smooth: false, scale: 0.5}, {smooth: false, scale: 0.33}];

const enough = 12, fewest = 3;  // faces to judge by; few where they took long
const settling = 3;      // pictures after a change that say nothing: shaders are compiled and memory is taken
const long_ms = 55;      // more than one and a half ticks of a screen of 30 pictures a second
const short_ms = 32;
const patience_ms = 5000, mostPatience_ms = 80000;  // before something finer is tried; twice as long after each time that it was too much

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

  // A face took `took_ms`, until `time_ms`. Says whether this changes how the next ones are to be drawn.
  took(took_ms, time_ms) {
    if (this.skip > 0) {
      --this.skip;
      return false;
    }
    this.times.push(took_ms);
    const {length} = this.times, all_ms = this.times.reduce((a, b) => a + b, 0);
    if (length < fewest || (length < enough && all_ms < enough * long_ms)) return false;
    const usual_ms = median(this.times);
    this.times = [];
    if (usual_ms > long_ms) return this.coarser(usual_ms, time_ms);
    if (usual_ms < short_ms && time_ms - this.since_ms > this.patience_ms) return this.finer(time_ms);
    return false;
  }

  coarser(usual_ms, time_ms) {
    const to = Math.min(qualities.length - 1, this.step + Math.ceil(Math.log2(usual_ms / long_ms)));
    if (this.tried) this.patience_ms = Math.min(mostPatience_ms, this.patience_ms * 2);
    return this.change(to, time_ms, false);
  }

  finer(time_ms) { return this.change(Math.max(0, this.step - 1), time_ms, true); }

  // `tried`: it may turn out to be too much.
  change(step, time_ms, tried) {
    const changes = step !== this.step;
    this.step = step;
    this.tried = tried && changes;
    if (changes) this.begin(time_ms);
    return changes;
  }
}
