// Draws every control at 1, the neutral face and a few expressions into one image.
// usage: node tests/contact_sheet.mjs OUT.jpg [CELL_WIDTH] [NAME...]
import {writeFile} from 'node:fs/promises';
import {launch} from './browser.mjs';
import {serve} from '../serve.mjs';

const [out = '../../docs/images/avatar.jpg', width = '200', ...only] = process.argv.slice(2);
const {server, url} = await serve(new URL('..', import.meta.url).pathname);
const browser = await launch();
try {
  const page = await browser.newPage();
  page.on('console', message => console.error(message.text()));
  page.on('pageerror', error => console.error(error));
  await page.goto(url + 'tests/contact_sheet.html');
  const picture = await page.evaluate(([cell, names, type]) => window.drawSheet(cell, names, type),
    [Number(width), only, out.endsWith('.png') ? 'image/png' : 'image/jpeg']);
  await writeFile(out, Buffer.from(picture.split(',')[1], 'base64'));
  console.log(out);
} finally {
  await browser.close();
  server.close();
}
