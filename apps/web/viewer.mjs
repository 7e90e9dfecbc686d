// Writes the viewer of users' avatars that reports contain, and the hash that their policy names: apps/mien/report/viewer.js.z (a zlib stream)
// and viewer.js.sha256. Both are in the repository, so that building the program needs neither npm nor a network.
// usage: node viewer.mjs
import {createHash} from 'node:crypto';
import {writeFile} from 'node:fs/promises';
import {deflateSync} from 'node:zlib';
import {bundled} from './bundle.mjs';

export const viewerFile = new URL('../mien/report/viewer.js', import.meta.url).pathname;

export async function viewer() {
  const [{text}] = await bundled(['src/model/model_avatar.js'], {format: 'iife', globalName: 'avatarViewer'});
  return {text, hash: `sha256-${createHash('sha256').update(text).digest('base64')}`};
}

if (process.argv[1] === new URL(import.meta.url).pathname) {
  const {text, hash} = await viewer();
  await writeFile(`${viewerFile}.z`, deflateSync(text, {level: 9}));
  await writeFile(`${viewerFile}.sha256`, hash);
}
