// Converts frames of the browser to images for the tracker: copies a VideoFrame in one of mien's formats, and draws
// other frames on a canvas. One at a time, because the next frame reuses the memory.

const formats = {I420: 'i420', NV12: 'nv12', RGBA: 'rgba', RGBX: 'rgba', BGRA: 'bgra', BGRX: 'bgra'};

export class FrameReader {
  constructor() { this.buffer = new Uint8Array(0); }

  async read(frame) {
    const format = formats[frame.format];
    return format ? this.copy(frame, format) : this.draw(frame);
  }

  async copy(frame, format) {
    const {width, height} = frame.visibleRect, bytes = frame.allocationSize();
    if (this.buffer.length < bytes) this.buffer = new Uint8Array(bytes);
    const layout = await frame.copyTo(this.buffer);
    const planes = layout.map(({offset}, i) => this.buffer.subarray(offset, layout[i + 1]?.offset ?? bytes));
    return {format, width, height, planes, rowStrideBytes: layout.map(({stride}) => stride), fullRange: frame.colorSpace?.fullRange ?? false};
  }

  draw(frame) {
    const width = frame.displayWidth ?? frame.width, height = frame.displayHeight ?? frame.height;
    if (this.canvas?.width !== width || this.canvas?.height !== height) {
      this.canvas = new OffscreenCanvas(width, height);
      this.context = this.canvas.getContext('2d', {willReadFrequently: true});
    }
    this.context.drawImage(frame, 0, 0, width, height);
    return this.context.getImageData(0, 0, width, height);
  }
}
