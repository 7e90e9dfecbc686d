// Screenshots of the page for review: both themes on a desktop and a phone, and two levels beside each other.
// usage: node tests/screenshots.mjs FOLDER
import {join} from 'node:path';
import {following, openPage, openStudio} from './page.mjs';

const folder = process.argv[2] ?? '.';
const devices = {desktop: {viewport: {width: 1280, height: 900}}, phone: {viewport: {width: 390, height: 844}, deviceScaleFactor: 2, isMobile: true}};
const studio = await openStudio();
try {
  for (const colorScheme of ['light', 'dark']) {
    for (const [device, options] of Object.entries(devices)) {
      const {page, context} = await openPage(studio, {colorScheme, ...options});
      await page.click('#camera');
      await following(page);
      if (device === 'desktop' && colorScheme === 'dark') await page.check('#compare', {timeout: 120000});
      if (colorScheme === 'dark') await page.click('summary');
      await page.waitForTimeout(4000);
      const path = join(folder, `page-${device}-${colorScheme}.png`);
      await page.screenshot({path, fullPage: true, timeout: 120000});
      console.log(path);
      await context.close();
    }
  }
} finally {
  await studio.close();
}
