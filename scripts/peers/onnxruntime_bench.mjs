// Times the networks of a folder's shapes.json in ONNX Runtime on one thread. usage: node onnxruntime_bench.mjs DIR
import { createRequire } from 'node:module';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';

const directory = process.argv[2];
const ort = createRequire(join(directory, 'package.json'))('onnxruntime-node');
const WARM_UP = 200;
const RUNS = 2000;
const shapes = JSON.parse(readFileSync(join(directory, 'shapes.json'), 'utf8'));

const results = {};
for (const [name, inputs] of Object.entries(shapes)) {
  const session = await ort.InferenceSession.create(join(directory, `${name}.onnx`), {
    intraOpNumThreads: 1, interOpNumThreads: 1, executionMode: 'sequential',
    graphOptimizationLevel: 'all',
  });
  const feed = {};
  for (const [input, shape] of Object.entries(inputs)) {
    const values = Float32Array.from({ length: shape.reduce((a, b) => a * b) }, () => Math.random() * 2 - 1);
    feed[input] = new ort.Tensor('float32', values, shape);
  }
  const times = [];
  for (let i = 0; i < WARM_UP + RUNS; ++i) {
    const begin = process.hrtime.bigint();
    await session.run(feed);
    if (i >= WARM_UP) times.push(Number(process.hrtime.bigint() - begin) / 1e6);
  }
  times.sort((a, b) => a - b);
  results[name] = { min_ms: times[0], median_ms: times[RUNS / 2] };
}
console.log(JSON.stringify(results));
