// Times every *.onnx of a folder in ONNX Runtime on one thread. usage: node onnxruntime_bench.mjs DIR
import { createRequire } from 'node:module';
import { readdirSync } from 'node:fs';
import { join } from 'node:path';

const directory = process.argv[2];
const ort = createRequire(join(directory, 'package.json'))('onnxruntime-node');
const WARM_UP = 200;
const RUNS = 2000;
const SHAPES = { basenet_encoder: [1, 3, 65, 65], hifinet_encoder: [1, 3, 129, 109] };

const results = {};
for (const file of readdirSync(directory).filter((name) => name.endsWith('.onnx'))) {
  const name = file.slice(0, -'.onnx'.length);
  const session = await ort.InferenceSession.create(join(directory, file), {
    intraOpNumThreads: 1, interOpNumThreads: 1, executionMode: 'sequential',
    graphOptimizationLevel: 'all',
  });
  const shape = SHAPES[name];
  const pixels = Float32Array.from({ length: shape.reduce((a, b) => a * b) }, () => Math.random() * 2 - 1);
  const feed = { [session.inputNames[0]]: new ort.Tensor('float32', pixels, shape) };
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
