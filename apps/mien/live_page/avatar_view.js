// Draws the avatar for the frames of the program.

class AvatarView {
  constructor(canvas) {
    this.view = new FaceView(canvas);
    const tick = now => {
      this.view.draw(now);
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  show(frame) {
    const time_ms = performance.now(), since_ms = Math.min(1000, time_ms - (this.shown_ms ?? time_ms));
    this.shown_ms = time_ms;
    this.view.show(frame, since_ms);
  }
}
