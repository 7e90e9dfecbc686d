// Numeric columns of the report: integers, one per frame (or per interval of audio).

const none = -32768;  // stands for a missing value

async function inflated(id) {
  const blob = await blobOf(id);
  return blob && new Response(blob.stream().pipeThrough(new DecompressionStream('deflate'))).arrayBuffer();
}

// Converts differences to values, in place. Typed arrays overflow like the integers of the writer.
function summed(differences) {
  for (let i = 1; i < differences.length; ++i) differences[i] += differences[i - 1];
  return differences;
}

class Column {
  constructor(steps, unit) { Object.assign(this, {steps, unit}); }
  at(i) { return i >= 0 && i < this.steps.length && this.steps[i] !== none ? this.steps[i] * this.unit : null; }
  get empty() { return !this.steps.some(step => step !== none); }
}

class Take {
  // `columns`: their description in the page's data, in the order of their bytes.
  constructor(columns, buffer) {
    this.columns = new Map();
    let at = 0;
    for (const {name, unit, bytes, count} of columns) {
      const steps = summed(bytes === 4 ? new Int32Array(buffer, at, count) : new Int16Array(buffer, at, count));
      this.columns.set(name, new Column(steps, unit));
      at += bytes * count;
    }
    const times = this.column('t_ms');
    this.t_ms = Float64Array.from(times.steps, step => step * times.unit);
  }

  column(name) { return this.columns.get(name); }
  get frames() { return this.t_ms.length; }

  // The index of the first frame at or after `t_ms`.
  firstFrom(t_ms) {
    let low = 0, high = this.t_ms.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.t_ms[middle] < t_ms) low = middle + 1; else high = middle;
    }
    return low;
  }

  // The index of the frame displayed at `t_ms`; -1 before the first. Players round times.
  frameAt(t_ms) { return this.firstFrom(t_ms + 0.6) - 1; }
}
