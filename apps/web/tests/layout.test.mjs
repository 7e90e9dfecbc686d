// The page's layout in both themes on phones, tablets and desktops, while the camera runs.
import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {following, openPage, openStudio, spareDrawing, until} from './page.mjs';

let studio;
before(async () => { studio = await openStudio(); });
after(() => studio?.close());

const boxes = (page, selector) => page.evaluate(selector => [...document.querySelectorAll(selector)].filter(each => each.checkVisibility()).map(
  each => (({left, top, right, bottom}) => ({left, top, right, bottom}))(each.getBoundingClientRect())), selector);
const box = async (page, selector) => (await boxes(page, selector))[0];

function alike(values, what) {
  assert.ok(Math.max(...values) - Math.min(...values) <= 1, `${what}: ${values.map(value => value.toFixed(1)).join(', ')}`);
}

// Draws open mouths in several poses, and returns the boxes of what their lower lips move, in the window, with what else is there.
const mouths = (page, face) => page.evaluate(face => {
  const view = window.page[face], {canvas} = view, {width, height} = canvas, ctx = new OffscreenCanvas(width, height).getContext('2d', {willReadFrequently: true});
  const pixels = (angles, lips) => {
    view.avatar.draw({controls: {jawOpen: 0.6, mouthLowerDownLeft: lips, mouthLowerDownRight: lips}, ...angles});
    ctx.clearRect(0, 0, width, height);
    ctx.drawImage(canvas, 0, 0);
    return ctx.getImageData(0, 0, width, height).data;
  };
  const mirrored = Boolean(canvas.closest('.mirrored')), at = canvas.getBoundingClientRect();
  return [{}, {yaw: 0.4, pitch: 0.2}, {yaw: -0.4, pitch: 0.2}].map(angles => {
    const [a, b] = [0, 1].map(lips => pixels(angles, lips)), x = [], y = [];
    for (let i = 0; i < a.length; i += 4) {
      if (Math.abs(a[i] - b[i]) + Math.abs(a[i + 1] - b[i + 1]) < 40) continue;
      x.push((i / 4 % width + 0.5) / width);
      y.push((Math.floor(i / 4 / width) + 0.5) / height);
    }
    const [first, last] = [x.reduce((p, q) => Math.min(p, q)), x.reduce((p, q) => Math.max(p, q))];
    const [left, right] = (mirrored ? [1 - last, 1 - first] : [first, last]).map(value => at.left + at.width * value);
    const [top, bottom] = [y[0], y.at(-1)].map(value => at.top + at.height * value), covers = new Set();
    for (let i = 0; i <= 8; ++i) for (let k = 0; k <= 8; ++k) {
      const {id, tagName} = document.elementFromPoint(left + (right - left) * i / 8, top + (bottom - top) * k / 8) ?? {tagName: 'nothing'};
      if (id !== canvas.id) covers.add(id || tagName);
    }
    return {left, right, top, bottom, covers: [...covers]};
  });
}, face);

async function checkMouths(page, face, canvas) {
  const at = await box(page, canvas);
  for (const {left, right, top, bottom, covers} of await mouths(page, face)) {
    const mouth = `mouth ${[left, top, right, bottom].map(Math.round)} of the face ${JSON.stringify(at)}`;
    assert.ok(right - left > 0.05 * (at.right - at.left) && bottom - top > 0.02 * (at.bottom - at.top), mouth);
    assert.ok(top > (at.top + at.bottom) / 2 && bottom < at.bottom, mouth);
    assert.deepEqual(covers, [], mouth);
  }
}

for (const colorScheme of ['light', 'dark']) {
  test(`a phone shows clip and face together, and nothing covers the mouth: ${colorScheme}`, async () => {
    const {page, context, complaints} = await openPage(studio, {colorScheme, viewport: {width: 390, height: 844}});
    await page.click('#camera');
    await following(page);
    for (const height of [844, 670]) {
      await page.setViewportSize({width: 390, height});
      await page.evaluate(() => scrollTo(0, 0));
      const [face, preview] = [await box(page, '#face-a'), await box(page, '#preview')];
      for (const each of [face, preview]) assert.ok(each.top >= 0 && each.bottom <= height && each.left >= 0 && each.right <= 390, JSON.stringify(each));
      assert.ok(preview.right - preview.left >= 80 && face.bottom - face.top >= 300, JSON.stringify({face, preview}));
      await page.waitForTimeout(200);  // the canvas gets its size
      await page.evaluate(() => window.page.first.quality.change(1, performance.now(), false));
      await page.evaluate(() => window.page.first.resize());
      await checkMouths(page, 'first', '#face-a');
    }
    assert.deepEqual(complaints, []);
    await context.close();
  });

  test(`cards line up: ${colorScheme}`, async () => {
    const {page, context} = await openPage(studio, {colorScheme});
    await page.click('#camera');
    await following(page);
    await spareDrawing(page);
    await until(page, () => document.querySelectorAll('#numbers dd').length > 5);
    for (const width of [1280, 768, 390]) {
      await page.setViewportSize({width, height: 900});
      const [header, stage] = [await box(page, 'header'), await box(page, '#stage')], cards = await boxes(page, '#panels section');
      assert.equal(cards.length, 5);
      const edge = (name, which) => which.map(i => cards[i][name]);
      alike([stage.left, header.left], `${width}: left of the page`);
      if (width === 768) {
        alike([stage.left, ...edge('left', [0, 3, 4])], '768: left');
        alike([stage.right, ...edge('right', [1, 2, 3, 4])], '768: right');
        alike(edge('left', [1, 2]), '768: left of the second column');
        alike(edge('top', [0, 1]), '768: top');
        alike(edge('bottom', [0, 2]), '768: bottom');
      } else {
        for (const side of ['left', 'right']) alike(edge(side, [0, 1, 2, 3, 4]), `${width}: ${side}`);
        alike([header.right, cards[0].right], `${width}: right of the page`);
        if (width === 390) alike([stage.right, cards[0].right], '390: right'); else alike([stage.top, cards[0].top], '1280: top');
      }
    }
    await context.close();
  });
}

test('nothing covers the mouths of two levels', async () => {
  const {page, context} = await openPage(studio, {viewport: {width: 390, height: 844}});
  await page.click('#camera');
  await following(page);
  await page.check('#compare');
  await until(page, () => document.getElementById('caption-b').textContent.startsWith('level 1'), 40);
  for (const [face, canvas] of [['first', '#face-a'], ['second', '#face-b']]) await checkMouths(page, face, canvas);
  await context.close();
});
