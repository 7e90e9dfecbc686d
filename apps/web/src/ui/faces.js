// Draws one or two faces, mien's or the user's, when a result has arrived.
import {Avatar, controlNames} from '../../avatar/avatar.js';
import {Quality} from './quality.js';

const easing_ms = 400;  // time to return to the front after a loss

// The face to draw for a result; `turned` goes to 0 after a loss, so that the head returns to the front.
function faceOf(result, turned = 1) {
  return {
    controls: Object.fromEntries(controlNames.map((name, i) => [name, result.controls[i]])), visemes: result.visemes,
    pitch: result.pitch * turned, yaw: result.yaw * turned, roll: result.roll * turned};
}

export class FaceView {
  constructor(canvas) {
    this.canvas = canvas;
    this.avatar = new Avatar(canvas);
    this.face = {controls: Object.fromEntries(controlNames.map(name => [name, 0]))};
    this.turned = 0;
    this.changed = true;
    this.drawnAt = [];
    this.quality = new Quality();
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  resize() {
    const {scale} = this.quality.now, ratio = Math.min(2, devicePixelRatio) * scale, {clientWidth, clientHeight} = this.canvas;
    this.canvas.width = Math.max(1, Math.round(clientWidth * ratio));
    this.canvas.height = Math.max(1, Math.round(clientHeight * ratio));
    this.canvas.style.filter = scale < 1 ? `blur(${(0.45 / ratio).toFixed(2)}px)` : '';  // hides the steps at edges
    this.changed = true;
  }

  // `sinceMs`: time since the previous result.
  show(result, sinceMs) {
    const towards = result.status === 'tracking' ? 1 : 0, step = Math.min(1, sinceMs / easing_ms);
    this.turned = towards > this.turned ? 1 : this.turned - Math.min(step, this.turned - towards);
    this.face = faceOf(result, this.turned);
    this.thereAt ??= performance.now();
    this.changed = true;
  }

  // Called for every animation frame of the browser.
  draw(now) {
    this.measure();
    if (!this.changed || !this.canvas.clientWidth) return;
    this.avatar.draw(this.face, this.quality.now);
    this.changed = false;
    this.drawnThere = this.thereAt;
    this.thereAt = undefined;
    this.drawnAt.push(now);
    while (this.drawnAt.length > 60) this.drawnAt.shift();
  }

  // Measures the time from the arrival of the previous result to the end of its drawing.
  measure() {
    const time_ms = performance.now();
    if (this.drawnThere !== undefined && this.quality.took(time_ms - this.drawnThere, time_ms)) this.resize();
    this.drawnThere = undefined;
  }

  // Images drawn per second, over the latest ones.
  get rate() {
    const span = this.drawnAt.at(-1) - this.drawnAt[0];
    return this.drawnAt.length > 1 && performance.now() - this.drawnAt.at(-1) < 1000 ? (this.drawnAt.length - 1) * 1000 / span : 0;
  }

  // A canvas keeps its first type of context, so another head needs a new canvas.
  async use(makeAvatar) {
    const canvas = this.canvas.cloneNode();
    Object.assign(canvas, {width: this.canvas.width, height: this.canvas.height});
    const avatar = await makeAvatar(canvas);
    this.avatar.dispose?.();
    this.canvas.replaceWith(canvas);
    Object.assign(this, {canvas, avatar, changed: true});
    avatar.onChange = () => { this.changed = true; };  // the user turned the view
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }
}
