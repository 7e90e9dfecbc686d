// Measures the CPU time of drawing the face without a graphics card, at every quality of the page.
import {launch} from './browser.mjs';
import {processorTime} from './processor_time.mjs';
import {serve} from '../serve.mjs';
import {qualities} from '../src/ui/quality.js';

const rounds = 6, pictures = 6;

// The minimum of interleaved rounds that wait for each image: [{smooth, scale, ms}].
export async function drawingCosts(width, height) {
  const {server, url} = await serve(new URL('..', import.meta.url).pathname);
  const browser = await launch();
  try {
    const page = await browser.newPage();
    await page.goto(url + 'tests/contact_sheet.html');
    await page.evaluate(async ([width, height, qualities]) => {
      const {Avatar} = await import('/avatar/avatar.js');
      const avatars = qualities.map(({scale}) =>
        new Avatar(Object.assign(document.createElement('canvas'), {width: Math.round(width * scale), height: Math.round(height * scale)})));
      window.drawSome = (which, pictures) => {
        const {gl} = avatars[which].renderer, pixel = new Uint8Array(4);
        for (let i = 0; i < pictures; ++i) {
          avatars[which].draw({controls: {jawOpen: 0.2 + 0.1 * i, mouthSmileLeft: 0.4, browInnerUp: 0.3}, yaw: 0.05 * i}, qualities[which]);
          gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
        }
      };
    }, [width, height, qualities]);
    const least = qualities.map(() => Infinity);
    for (let round = 0; round <= rounds; ++round) {
      for (const which of qualities.keys()) {
        const before = processorTime().all;
        await page.evaluate(([which, pictures]) => window.drawSome(which, pictures), [which, pictures]);
        const took = (processorTime().all - before) / pictures;
        if (round > 0) least[which] = Math.min(least[which], took);  // the first one compiles shaders
      }
    }
    return qualities.map((quality, i) => ({...quality, ms: least[i]}));
  } finally {
    await browser.close();
    server.close();
  }
}
