// Correlates curves with the true ones of a clip that plays in a loop with an unknown start.
import {readFileSync} from 'node:fs';

export function readTruth(file, name) {
  const [header, ...rows] = readFileSync(file, 'utf8').trim().split(/\r?\n/).map(line => line.split(','));
  return rows.map(row => Number(row[header.indexOf(name)]));
}

export function correlate(a, b) {
  const mean = values => values.reduce((sum, value) => sum + value, 0) / values.length;
  const [ma, mb] = [mean(a), mean(b)];
  const product = (p, q, mp, mq) => p.reduce((sum, value, i) => sum + (value - mp) * (q[i] - mq), 0);
  return product(a, b, ma, mb) / Math.sqrt(product(a, a, ma, ma) * product(b, b, mb, mb));
}

// `samples`: [ms, value]; `truth`: values at 30 frames per second. The best lag is unambiguous for at least two loops.
export function bestCorrelation(samples, truth) {
  const frameMs = 1000 / 30, start = samples[0][0], values = samples.map(([, value]) => value);
  const candidates = truth.map((_, lag) => {
    const expected = samples.map(([ms]) => truth[(Math.round((ms - start) / frameMs) + lag) % truth.length]);
    return {correlation: correlate(values, expected), lagMs: lag * frameMs};
  });
  return candidates.reduce((best, one) => (one.correlation > best.correlation ? one : best));
}
