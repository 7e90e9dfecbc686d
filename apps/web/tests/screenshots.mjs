// Screenshots of the page for review: both themes on a desktop, a tablet and a phone, and two levels beside each other.
// The first one, page.png, has the size of a window.
// usage: node tests/screenshots.mjs FOLDER
import {join} from 'node:path';
import {following, openPage, openStudio, spareDrawing} from './page.mjs';

const folder = process.argv[2] ?? '.';
const devices = {
  desktop: {viewport: {width: 1280, height: 900}}, tablet: {viewport: {width: 768, height: 1024}},
  phone: {viewport: {width: 390, height: 844}, deviceScaleFactor: 2, isMobile: true}};
const drawFinely = page => page.evaluate(async () => {
  document.getElementById('video').pause();  // at the image that the face shows
  await new Promise(done => setTimeout(done, 300));
  window.drawAgain();
  for (const view of [window.page.first, window.page.second].filter(Boolean)) {
    view.quality.change(0, performance.now(), false);
    view.resize();
    view.draw(performance.now());
    view.draw = () => {};
  }
});
const studio = await openStudio();
try {
  for (const colorScheme of ['light', 'dark']) {
    for (const [device, options] of Object.entries(devices)) {
      const {page, context} = await openPage(studio, {colorScheme, ...options});
      await page.click('#camera');
      await following(page);
      if (device === 'desktop' && colorScheme === 'dark') await page.check('#compare', {timeout: 120000});
      if (colorScheme === 'dark') await page.click('summary');
      // Figures and image as on a machine with a graphics card: without one, drawing takes the time of the tracker.
      await spareDrawing(page);
      await page.waitForTimeout(6000);
      await drawFinely(page);
      if (device === 'desktop' && colorScheme === 'light') await page.screenshot({path: join(folder, 'page.png'), timeout: 120000});
      const path = join(folder, `page-${device}-${colorScheme}.png`);
      await page.screenshot({path, fullPage: true, timeout: 120000});
      console.log(path);
      await context.close();
    }
  }
} finally {
  await studio.close();
}
