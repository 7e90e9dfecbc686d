// The numbers of the take: columns of whole steps, one value for each frame (or for each short while of sound).

const none = -32768;  // stands for no number

async function inflated(id) {
  const blob = await blobOf(id);
  return blob && new Response(blob.stream().pipeThrough(new DecompressionStream('deflate'))).arrayBuffer();
}

// Differences to values, in place; typed arrays overflow as the writer's numbers do.
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
  // `columns`: what the page's data says of them, in the order of their bytes.
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

  // Index of the first frame from `t_ms` on.
  firstFrom(t_ms) {
    let low = 0, high = this.t_ms.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.t_ms[middle] < t_ms) low = middle + 1; else high = middle;
    }
    return low;
  }

  // Index of the frame that is seen at `t_ms`; -1 before the first. Players round times.
  frameAt(t_ms) { return this.firstFrom(t_ms + 0.6) - 1; }
}
