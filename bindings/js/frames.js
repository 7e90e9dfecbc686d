// Converts sources of pixels in browsers to images for pushVideo.
import {MienError} from './error.js';

const wrong = {argument: -1, size: -61};  // MIEN_ERROR_*
const expected = 'a video, VideoFrame, ImageBitmap, canvas, image, ImageData, or {format, width, height, data}';
const formats = {I420: 'i420', I420A: 'i420', NV12: 'nv12', RGBA: 'rgba', RGBX: 'rgba', BGRA: 'bgra', BGRX: 'bgra'};

// For each kind of source: its size, and the message if that is 0.
const empty = ({width, height}) => `no pixels (got ${width} x ${height})`;
const kinds = {
  HTMLVideoElement: {size: video => (video.readyState < 2 ? [0, 0] : [video.videoWidth, video.videoHeight]), missing: () => 'the video has no image yet'},
  HTMLImageElement: {size: image => [image.naturalWidth, image.naturalHeight], missing: () => 'the image is not loaded'},
  VideoFrame: {size: frame => [frame.displayWidth, frame.displayHeight], missing: () => 'the VideoFrame was closed'},
  ImageBitmap: {size: ({width, height}) => [width, height], missing: () => 'the ImageBitmap was closed'},
  HTMLCanvasElement: {size: ({width, height}) => [width, height], missing: empty},
  OffscreenCanvas: {size: ({width, height}) => [width, height], missing: empty},
};

// Unlike instanceof, also for objects of another window.
const kindOf = source => Object.prototype.toString.call(source).slice(8, -1);
const fail = (why, status = wrong.argument) => { throw new MienError(`source: ${why}`, status); };

// Size of a source that a canvas can draw; undefined for pixels.
function drawnSize(source) {
  const kind = kinds[kindOf(source)];
  if (!kind) {
    if (source?.data || source?.planes) return undefined;
    fail(`wrong type (got ${source === null ? 'null' : kindOf(source)}, expected ${expected})`);
  }
  const [width, height] = kind.size(source);
  if (!width || !height) fail(kind.missing(source), wrong.size);
  return {width, height};
}

// The browser refuses pixels of other origins.
function readable(read) {
  try {
    return read();
  } catch (error) {
    return error.name === 'SecurityError' ? fail('the pixels are of another origin, which must allow CORS, with crossorigin="anonymous"') : fail(error.message);
  }
}

/** Nanoseconds: the timestamp of a VideoFrame, otherwise now, on the clock of performance.now(). */
export const timeOf = source => (kindOf(source) === 'VideoFrame' ? BigInt(source.timestamp ?? 0) * 1000n : BigInt(Math.round(performance.now() * 1e6)));

// A frame to transfer to a worker; the source remains the caller's. Pixels are returned as they are.
export async function transferable(source, ptsNs) {
  if (!drawnSize(source)) return {frame: source, transfer: []};
  const timestamp = Number(BigInt(Math.round(Number(ptsNs))) / 1000n);
  const frame = globalThis.VideoFrame ? readable(() => new VideoFrame(source, {timestamp})) : await createImageBitmap(source);
  return {frame, transfer: [frame]};
}

// Reads one source at a time, because the next one reuses the memory.
export class FrameReader {
  constructor() { this.buffer = new Uint8Array(0); }

  async read(source) {
    const size = drawnSize(source);
    if (!size) return source;
    if (kindOf(source) !== 'HTMLVideoElement' || !globalThis.VideoFrame) return this.readFrame(source, size);
    const frame = readable(() => new VideoFrame(source, {timestamp: 0}));
    try {
      return await this.readFrame(frame, size);
    } finally {
      frame.close();
    }
  }

  readFrame(frame, size) {
    const format = formats[frame.format];
    return format ? this.copy(frame, format) : this.draw(frame, size);
  }

  // Without a canvas, and without a conversion to RGB.
  async copy(frame, format) {
    const {width, height} = frame.visibleRect, bytes = frame.allocationSize();
    if (this.buffer.length < bytes) this.buffer = new Uint8Array(bytes);
    const layout = await frame.copyTo(this.buffer), {fullRange = false, matrix} = frame.colorSpace ?? {};
    const planes = layout.map(({offset}, i) => this.buffer.subarray(offset, layout[i + 1]?.offset ?? bytes));
    return {
      format, width, height, planes, rowStrideBytes: layout.map(({stride}) => stride), fullRange: fullRange ?? false, bt709: matrix === 'bt709',
      rotation: frame.rotation ?? 0, mirrored: frame.flip ?? false};
  }

  draw(source, {width, height}) {
    if (this.canvas?.width !== width || this.canvas?.height !== height) {
      this.canvas = new OffscreenCanvas(width, height);
      this.context = this.canvas.getContext('2d', {willReadFrequently: true});
    }
    return readable(() => {
      this.context.drawImage(source, 0, 0, width, height);
      return this.context.getImageData(0, 0, width, height);
    });
  }
}
