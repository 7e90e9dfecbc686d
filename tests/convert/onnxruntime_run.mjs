// Runs ONNX files in ONNX Runtime. usage: node onnxruntime_run.mjs NODE_MODULES JOBS.json
// A job: {model, steps: [{input: {file, shape}}], feedback: {input: output of the step before}, out}. Raw little-endian float32 goes in
// and out; of every output the steps are written one after another to out.INDEX. Prints {model: error} of those that failed.
import { createRequire } from 'node:module';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

const [modules, jobs] = process.argv.slice(2);
const ort = createRequire(join(modules, 'package.json'))('onnxruntime-node');

function tensor({ file, shape }) {
  const bytes = readFileSync(file);
  return new ort.Tensor('float32', new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length)), shape);
}

const failures = {};
for (const job of JSON.parse(readFileSync(jobs, 'utf8'))) {
  try {
    const session = await ort.InferenceSession.create(job.model, { intraOpNumThreads: 1, logSeverityLevel: 3 });
    const outputs = session.outputNames.map(() => []);
    let last = null;
    for (const step of job.steps) {
      const feed = {};
      for (const [name, array] of Object.entries(step)) feed[name] = tensor(array);
      for (const [name, output] of Object.entries(last ? job.feedback : {})) feed[name] = last[output];
      last = await session.run(feed);
      session.outputNames.forEach((name, i) => outputs[i].push(Buffer.from(Float32Array.from(last[name].data).buffer)));
    }
    outputs.forEach((parts, i) => writeFileSync(`${job.out}.${i}`, Buffer.concat(parts)));
  } catch (error) {
    failures[job.model] = String(error);
  }
}
console.log(JSON.stringify(failures));
