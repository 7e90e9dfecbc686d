// Headless Chromium, with WebGL rendered by the processor.
import {existsSync} from 'node:fs';
import {chromium} from 'playwright-core';

export const executable =
  process.env.CHROMIUM ?? ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find(existsSync);

export const launch = (flags = []) => chromium.launch({
  executablePath: executable,
  args: ['--headless=new', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
         '--disable-component-update', '--disable-sync', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', ...flags],
});
