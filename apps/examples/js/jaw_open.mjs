// Prints how far the mouth of the face in an image is open, 0 to 1. Runs in a folder where the npm package is installed.
//
// usage: node jaw_open.mjs IMAGE.ppm      ffmpeg -i face.jpg face.ppm creates the image
import {readFile} from 'node:fs/promises';
import {controlsByName, createTracker} from 'mien';

// A binary PPM of 8 bits.
async function readImage(path) {
  const bytes = await readFile(path);
  const header = /^P6\s+(\d+)\s+(\d+)\s+255\s/.exec(bytes.subarray(0, 64).toString('latin1'));
  if (!header) throw new Error(`${path}: not a binary PPM of 8 bits`);
  return {format: 'rgb', width: Number(header[1]), height: Number(header[2]), data: bytes.subarray(header[0].length)};
}

if (process.argv.length !== 3) {
  console.error('usage: node jaw_open.mjs IMAGE.ppm');
  process.exit(2);
}
const image = await readImage(process.argv[2]);
const tracker = await createTracker({lod: 1});
const result = await tracker.track(image);
console.log(result.status === 'tracking' ? `jawOpen ${controlsByName(result).jawOpen.toFixed(2)}` : 'no face');
