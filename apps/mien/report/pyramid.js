// The minimum and maximum of any range of a column in logarithmic time: each level has those of
// eight values of the level below. Drawing time depends on pixels, not on the length of a curve.

const branching = 8;

function coarser({low, high}) {
  const count = Math.ceil(low.length / branching), above = {low: new Int16Array(count).fill(32767), high: new Int16Array(count).fill(none)};
  for (let i = 0; i < low.length; ++i) {
    const k = Math.floor(i / branching);
    if (low[i] < above.low[k]) above.low[k] = low[i];
    if (high[i] > above.high[k]) above.high[k] = high[i];
  }
  return above;
}

class Pyramid {
  constructor(steps) {
    this.levels = [{low: steps.map(step => (step === none ? 32767 : step)), high: steps}];
    while (this.levels.at(-1).low.length > branching) this.levels.push(coarser(this.levels.at(-1)));
  }

  // The range of the values from index `from` to before `to`; null if it is empty.
  range(from, to) {
    let least = 32767, most = none;
    const look = (level, i) => {
      least = Math.min(least, level.low[i]);
      most = Math.max(most, level.high[i]);
    };
    for (let k = 0; from < to; ++k) {
      const level = this.levels[k], last = k === this.levels.length - 1;
      while (from < to && (last || from % branching)) look(level, from++);
      while (from < to && to % branching) look(level, --to);
      from /= branching;
      to /= branching;
    }
    return most === none ? null : [least, most];
  }
}
