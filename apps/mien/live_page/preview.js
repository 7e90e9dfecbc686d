// Shows the images of the camera. The next one is requested after the previous one was drawn, so
// a slow browser gets fewer images.
const previewPause_ms = 50, previewRetry_ms = 1000;

class Preview {
  constructor(box, canvas, checkbox) {
    Object.assign(this, {box, canvas, checkbox, context: canvas.getContext('2d')});
    checkbox.addEventListener('change', () => this.update());
    this.update();
    this.run();
  }

  async run() {
    for (;;) {
      const pause_ms = this.wanted && !document.hidden ? await this.next() : previewRetry_ms / 4;
      await new Promise(done => setTimeout(done, pause_ms));
    }
  }

  async next() {
    try {
      const response = await fetch('preview');
      if (response.status !== 200) return this.lose();
      const image = await createImageBitmap(await response.blob());
      Object.assign(this.canvas, {width: image.width, height: image.height});
      this.context.drawImage(image, 0, 0);
      this.arrived = true;
      this.update();
      return previewPause_ms;
    } catch {
      return this.lose();
    }
  }

  lose() {
    this.arrived = false;
    this.update();
    return previewRetry_ms;
  }

  get wanted() { return this.checkbox.checked; }

  update() { this.box.hidden = !this.wanted || !this.arrived; }
}
