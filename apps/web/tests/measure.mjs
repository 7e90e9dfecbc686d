// Measures the page in Chromium with the demo clip as camera and microphone, and writes a report.
// usage: node tests/measure.mjs OUT.md
import {execFileSync} from 'node:child_process';
import {readdirSync, statSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {cpus, loadavg} from 'node:os';
import {bestCorrelation, readTruth} from './correlation.mjs';
import {dist, following, openPage, openStudio, spareDrawing, truthFile} from './page.mjs';

const out = process.argv[2] ?? '/dev/stdout';
const median = values => [...values].sort((a, b) => a - b)[values.length >> 1];
const seconds = 17;

// Starts the camera and says after how long the first result was there.
const firstResult = page => page.evaluate(() => new Promise(done => {
  let camera;
  document.getElementById('video').addEventListener('playing', () => { camera = performance.now(); }, {once: true});
  document.addEventListener('mien-results', () => done({
    afterCamera: Math.max(0, performance.now() - (camera ?? performance.now())), afterClick: performance.now() - began}), {once: true});
  const began = performance.now();
  document.getElementById('camera').click();
}));

// Jaw of the avatar, times of tracking and of pictures drawn, for some seconds at a level.
const watch = (page, level, seconds) => page.evaluate(([level, seconds]) => new Promise(done => {
  const select = document.getElementById('level'), view = window.page.first, {vertices, mesh} = view.avatar.head;
  select.value = String(level);
  select.dispatchEvent(new Event('change'));
  const lip = vertices.findIndex(v => !v.inner && v.t < 0.01 && v.sine < -0.999), jaw = [], took = [], shaped = [];
  const listen = ({detail}) => {
    const began = performance.now();
    view.draw(began);
    shaped.push(performance.now() - began);
    jaw.push([detail.timeMs, vertices[lip].at[1] - mesh.positions[lip * 3 + 1]]);
    took.push(detail.results[0].tookMs);
    if (detail.timeMs - jaw[0][0] < seconds * 1000) return;
    document.removeEventListener('mien-results', listen);
    done({jaw, took, shaped});
  };
  document.addEventListener('mien-results', listen);
}), [level, seconds]);

const studio = await openStudio();
try {
  const starts = [];
  for (let i = 0; i < 3; ++i) {
    const {page, context} = await openPage(studio);
    starts.push(await firstResult(page));
    await context.close();
  }
  const {page} = await openPage(studio);
  await page.click('#camera');
  await following(page);
  const drawn = await watch(page, 4, 6);
  await spareDrawing(page);
  const truth = readTruth(truthFile, 'jawOpen'), rows = [];
  for (const level of [1, 2, 3, 4]) {
    const {jaw, took, shaped} = await watch(page, level, seconds);
    const rate = (jaw.length - 1) * 1000 / (jaw.at(-1)[0] - jaw[0][0]);
    rows.push(`| ${level} | ${bestCorrelation(jaw, truth).correlation.toFixed(3)} | ${rate.toFixed(1)} | ${median(took).toFixed(2)} | ${median(shaped).toFixed(2)} |`);
  }
  const bytes = readdirSync(dist, {recursive: true}).map(name => statSync(join(dist, name))).filter(info => info.isFile())
    .reduce((sum, {size}) => sum + size, 0);
  const rate = ({jaw}) => ((jaw.length - 1) * 1000 / (jaw.at(-1)[0] - jaw[0][0])).toFixed(1);
  const chromium = studio.browser.version(), node = execFileSync('node', ['--version']).toString().trim();
  writeFileSync(out, `# The page, measured

Made by \`scripts/web.sh measure\`: Chromium ${chromium} without a window, whose camera and microphone play \`tests/data/demo.mp4\`, on
${cpus().length} cores of ${cpus()[0].model}, Node ${node}. The load of the machine was ${loadavg()[0].toFixed(1)} (processes that want a
core), so times are upper bounds. There is no graphics card: what WebGL draws, processors draw (SwiftShader).

| | |
|---|---|
| the whole page, weights included | ${bytes} bytes |
| first result after the camera plays, three starts | ${starts.map(({afterCamera}) => Math.round(afterCamera)).join(', ')} ms |
| first result after the button is pressed | ${starts.map(({afterClick}) => Math.round(afterClick)).join(', ')} ms |
| frames tracked a second while every face is drawn by processors, level 4 | ${rate(drawn)} |

Below, faces are shaped but not drawn, which leaves the processors to the tracker as a graphics card would. The jaw is that of the avatar:
how far the middle of its lower lip has come down, against \`jawOpen\` of \`tests/data/demo_truth.csv\`, over ${seconds} s (two loops of the clip; the lag
that fits best). Tracking is one frame in the worker, picture and sound; shaping is what the avatar computes before it is drawn.

| level | correlation of the jaw | frames a second | tracking, median ms | shaping, median ms |
|---|---|---|---|---|
${rows.join('\n')}
`);
  console.log(out);
} finally {
  await studio.close();
}
