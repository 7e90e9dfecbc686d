// Each control changes the right part of the face only, and mirrored controls change mirrored parts.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {after, before, test} from 'node:test';
import {controlNames} from '../avatar/avatar.js';
import {serve} from '../serve.mjs';
import {launch} from './browser.mjs';

// The expected centre of each control's change in the image (0..1 from left and top), and its maximum distance. The
// subject's left is on the right.
const places = {
  eyeLeft: {x: [0.55, 0.78], y: [0.33, 0.52]}, browLeft: {x: [0.50, 0.80], y: [0.18, 0.42]}, cheekLeft: {x: [0.55, 0.85], y: [0.38, 0.66]},
  noseLeft: {x: [0.48, 0.70], y: [0.35, 0.72]}, mouthLeft: {x: [0.48, 0.78], y: [0.52, 0.82]}, mouth: {x: [0.40, 0.60], y: [0.54, 0.85]},
  sideways: {x: [0.36, 0.64], y: [0.50, 0.88]}, forehead: {x: [0.42, 0.58], y: [0.15, 0.42]}, cheeks: {x: [0.42, 0.58], y: [0.45, 0.75]}};
const mirrored = ({x: [from, to], y}) => ({x: [1 - to, 1 - from], y});
const of = [
  [/^eye/, 'eyeLeft'], [/^brow(Down|OuterUp)/, 'browLeft'], [/^cheekSquint/, 'cheekLeft'], [/^noseSneer/, 'noseLeft'],
  [/^browInnerUp/, 'forehead'], [/^cheekPuff/, 'cheeks'], [/^(jaw|mouth)(Left|Right)$/, 'sideways'],
  [/^mouth.*(Left|Right)$/, 'mouthLeft'], [/./, 'mouth']];
function placeOf(name) {
  const place = of.find(([pattern]) => pattern.test(name))[1];
  return /Left$/.test(place) && /Right$/.test(name) ? mirrored(places[place]) : places[place];
}

let browser, server, page;
before(async () => {
  const served = await serve(new URL('..', import.meta.url).pathname);
  server = served.server;
  browser = await launch();
  page = await browser.newPage();
  await page.goto(served.url + 'tests/contact_sheet.html');
  await page.evaluate(() => import('/tests/avatar_probe.js'));
});
after(async () => {
  await browser?.close();
  server?.close();
});

test('each control changes the expected part of the face', async () => {
  const problems = [];
  for (const name of controlNames) {
    const {changed, x, y, below} = await page.evaluate(control => window.change({[control]: 1}), name), place = placeOf(name);
    if (changed < 150) problems.push(`${name} changes ${changed} pixels`);
    if (below > 0) problems.push(`${name} moves the shoulders`);
    if (x < place.x[0] || x > place.x[1] || y < place.y[0] || y > place.y[1]) {
      problems.push(`${name} changes the face around ${x.toFixed(2)}, ${y.toFixed(2)}`);
    }
  }
  assert.deepEqual(problems, []);
});

test('a higher value of a control changes more pixels', async () => {
  for (const name of controlNames) {
    const [half, whole] = await page.evaluate(control => [0.5, 1].map(value => window.change({[control]: value}).sum), name);
    assert.ok(whole > half * 1.1 && half > 0, `${name}: ${half} and ${whole}`);
  }
});

test('left and right mirror each other', async () => {
  const pairs = controlNames.filter(name => name.endsWith('Left')).map(name => [name, name.replace(/Left$/, 'Right')]);
  for (const [left, right] of pairs) {
    const shared = await page.evaluate(names => window.mirrorOverlap(...names), [left, right]);
    assert.ok(shared > 0.5, `${left} and ${right} share ${shared.toFixed(2)} in the mirror`);
    assert.ok(await page.evaluate(names => window.mirrorOffset(...names), [left, right]) < 1e-4, `${left} does not move like ${right}`);
  }
});

test('shapes are anatomically plausible', async () => {
  const lips = controls => page.evaluate(c => window.lips(c), controls), rest = await lips({});
  const gap = ({upper, lower}) => upper[1] - lower[1], width = ({left, right}) => left[0] - right[0];
  assert.ok(Math.abs(rest.left[1] - rest.upper[1]) < 0.015, `the mouth does not smile at rest: ${rest.left[1] - rest.upper[1]}`);
  const open = await lips({jawOpen: 1}), funnel = await lips({mouthFunnel: 1}), pucker = await lips({mouthPucker: 1});
  assert.ok(gap(rest) < 0.01 && gap(open) > 0.25, 'the jaw opens the mouth');
  assert.ok(gap(await lips({jawOpen: 1, mouthClose: 1})) < 0.04, 'mouthClose closes the lips over an open jaw');
  assert.ok((await lips({jawOpen: 1, mouthClose: 1})).chin[1] < rest.chin[1] - 0.15, 'and leaves the jaw open');
  assert.ok(gap(funnel) > 0.1 && width(funnel) < width(rest) * 0.8, 'the lips of a funnel are open and round');
  assert.ok(gap(pucker) < 0.03 && width(pucker) < width(rest) * 0.6 && pucker.upper[2] > rest.upper[2] + 0.1, 'the lips of a pucker are small, closed and protruded');
  const smile = await lips({mouthSmileLeft: 1});
  assert.ok(smile.left[1] > rest.left[1] + 0.08 && Math.abs(smile.right[1] - rest.right[1]) < 0.01, 'a smile lifts its own corner');
  assert.ok((await lips({mouthFrownRight: 1})).right[1] < rest.right[1] - 0.08, 'a frown lowers its own corner');
  assert.ok((await lips({jawLeft: 1})).chin[0] > 0.1 && (await lips({jawRight: 1})).chin[0] < -0.1, "the jaw goes to the subject's side");
  assert.ok((await lips({jawForward: 1})).chin[2] > rest.chin[2] + 0.1, 'the jaw goes forward');
  assert.ok((await lips({mouthStretchLeft: 1})).left[0] > rest.left[0] + 0.08, 'stretching moves a corner outwards');
  assert.ok((await lips({mouthLowerDownLeft: 1, mouthLowerDownRight: 1})).lower[1] < rest.lower[1] - 0.08, 'the lower lip goes down');
  assert.ok((await lips({mouthUpperUpLeft: 1, mouthUpperUpRight: 1})).upper[1] > rest.upper[1] + 0.08, 'the upper lip goes up');
  assert.ok((await lips({mouthRollLower: 1})).red[1] > rest.red[1] + 0.04, 'a rolled lip is hidden');
});

test('eyeBlink at 1 closes the eyes fully', async () => {
  const green = controls => page.evaluate(c => window.noseAt({}, c).count, controls), open = await green({});
  assert.ok(open > 300, `${open} pixels of the irises`);
  assert.equal(await green({eyeBlinkLeft: 1, eyeBlinkRight: 1}), 0);
});

test('the head rotates by its angles', async () => {
  const turned = await page.evaluate(() => ['yaw', 'pitch', 'roll'].map(angle => window.change({}, {[angle]: 0.4})));
  for (const {changed} of turned) assert.ok(changed > 5000);
  assert.ok((await page.evaluate(() => window.noseAt({yaw: 0.4}))).x > 0.55, "positive yaw turns to the subject's left");
  assert.ok((await page.evaluate(() => window.noseAt({pitch: 0.4}))).y > (await page.evaluate(() => window.noseAt({}))).y, 'positive pitch looks down');
});

test('missing or invalid values are 0', async () => {
  const {changed} = await page.evaluate(() => window.change({jawOpen: NaN, nothing: 1, mouthPucker: -1}));
  assert.equal(changed, 0);
});

test('the code of docs/web.md draws a face', async () => {
  const root = new URL('../../..', import.meta.url).pathname;
  const code = execFileSync(root + 'tests/docs/code_blocks.py', ['docs/web.md', 'js'], {encoding: 'utf8'});
  const body = example => `<canvas width="200" height="200"></canvas><script type="module">
    const canvas = document.querySelector('canvas');
    ${example}
    document.title = 'drawn';
  </script>`;
  const other = await browser.newPage(), images = [];
  for (const example of [code, code.replace('jawOpen: 0.4', 'jawOpen: 0')]) {
    await other.route('**/example.html', route => route.fulfill({contentType: 'text/html', body: body(example)}));
    await other.goto(new URL('/example.html', page.url()).href);
    for (const end = Date.now() + 15000; await other.title() !== 'drawn' && Date.now() < end;) await other.waitForTimeout(50);
    assert.equal(await other.title(), 'drawn');
    images.push((await other.screenshot()).toString('base64'));
    await other.unroute('**/example.html');
  }
  assert.notEqual(images[0], images[1]);
  await other.close();
});
