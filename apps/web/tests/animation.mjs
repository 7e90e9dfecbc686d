// Draws the face for each row of a CSV file of curves: frame_0000.png, frame_0001.png, ... in OUT_DIR.
// usage: node tests/animation.mjs CURVES.csv OUT_DIR [WIDTH] [HEIGHT]
import {mkdir, readFile, writeFile} from 'node:fs/promises';
import {join} from 'node:path';
import {launch} from './browser.mjs';
import {serve} from '../serve.mjs';

const [curves, out, width = '320', height = '360'] = process.argv.slice(2);

function rows(text) {
  const [header, ...lines] = text.trim().split('\n').map(line => line.split(','));
  const at = name => header.indexOf(name), first = at('eyeBlinkLeft');
  return lines.map(cells => ({
    controls: Object.fromEntries(header.slice(first).map((name, i) => [name, Number(cells[first + i])])),
    pitch: Number(cells[at('pitch_rad')]), yaw: Number(cells[at('yaw_rad')]), roll: Number(cells[at('roll_rad')]),
  }));
}

const {server, url} = await serve(new URL('..', import.meta.url).pathname);
const browser = await launch();
try {
  const page = await browser.newPage();
  page.on('pageerror', error => console.error(error));
  await page.goto(url + 'tests/animation.html');
  await mkdir(out, {recursive: true});
  for (const [i, frame] of rows(await readFile(curves, 'utf8')).entries()) {
    const picture = await page.evaluate(([one, w, h]) => window.drawFrame(one, w, h), [frame, Number(width), Number(height)]);
    await writeFile(join(out, `frame_${String(i).padStart(4, '0')}.png`), Buffer.from(picture.split(',')[1], 'base64'));
  }
} finally {
  await browser.close();
  server.close();
}
