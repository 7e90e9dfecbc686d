// Connects the parts of the page.
import {Avatar, controlNames} from '../avatar/avatar.js';
import {Recording} from './recording/recording.js';
import {curvesCsv} from './recording/csv.js';
import {animationGlb} from './recording/glb.js';
import {liveLinkCsv} from './recording/live_link_face.js';
import {Sound} from './sources/sound.js';
import {Source} from './sources/source.js';
import {Tracking} from './tracking/tracking.js';
import {download, isModel, takeDrops} from './ui/drop_zone.js';
import {FaceView} from './ui/faces.js';
import {Numbers} from './ui/numbers.js';

const $ = id => document.getElementById(id);
const levels = [[0, 'automatic'], [1, '1, cheapest'], [2, '2'], [3, '3'], [4, '4, finest']];
const formats = {
  csv: {name: 'mien.csv', type: 'text/csv', make: curvesCsv},
  llf: {name: 'mien-live-link-face.csv', type: 'text/csv', make: liveLinkCsv},
  glb: {name: 'mien.glb', type: 'model/gltf-binary', make: animationGlb}};
const calibrating = 0x10;  // MIEN_RESULT_CAPTURING_NEUTRAL

function say(text) {
  if ($('status').textContent !== text) $('status').textContent = text;
}

// Stays until the user dismisses it.
function complain(text) {
  $('error').firstElementChild.textContent = text;
  $('error').hidden = !text;
}

class Page {
  constructor() {
    this.first = new FaceView($('face-a'));
    this.numbers = new Numbers($('numbers'), $('bars'), $('bars-box'));
    this.numbers.setControls(controlNames);
    this.recording = new Recording();
    this.tracking = new Tracking({
      onReady: () => this.ready(), onResults: message => this.show(message), onError: message => this.fail(message)});
    this.source = new Source($('video'), new Sound(this.tracking), this.tracking);
    this.source.onEnd = why => {
      this.stop();
      if (why) complain(why); else say('The input has ended.');
    };
    this.connect();
    const tick = now => {
      this.first.draw(now);
      this.second?.draw(now);
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  connect() {
    for (const id of ['level', 'other']) {
      $(id).append(...levels.map(([value, text]) => new Option(text, String(value))));
      $(id).addEventListener('change', () => this.setLevels());
    }
    $('other').value = '1';
    const on = (id, event, action) => $(id).addEventListener(event, action);
    on('camera', 'click', () => this.open(() => this.source.openCamera()));
    $('error').lastElementChild.addEventListener('click', () => complain(''));
    on('stop', 'click', () => this.stop());
    on('file', 'change', ({target}) => target.files[0] && this.openFile(target.files[0]));
    on('model', 'change', ({target}) => target.files[0] && this.openFile(target.files[0]));
    on('own-face', 'click', () => this.useOwnFace());
    on('mirror', 'change', () => this.mirror());
    on('compare', 'change', () => this.setLevels());
    on('calibrate', 'click', () => this.tracking.calibrate());
    on('record', 'click', () => this.record());
    for (const button of $('downloads').children) button.addEventListener('click', () => this.download(button.dataset.format));
    takeDrops($('drop-note'), file => this.openFile(file));
    this.mirror();
  }

  ready() {
    $('camera').disabled = false;
    this.isReady = true;
    if (!this.running) say('Ready.');
    if (this.waiting) this.open(this.waiting);
  }

  fail(message) {
    complain(message);
    if (!this.isReady) say('The tracker is not available.');
  }

  async open(how) {
    if (!this.isReady) {
      this.waiting = how;
      return;
    }
    say('Opening …');
    $('camera').disabled = true;
    const opening = how(), {generation} = this.source;
    const isStale = () => generation !== this.source.generation;  // another source was opened, or this one was stopped
    try {
      const {missing, problem} = await opening ?? {};
      if (isStale()) return;
      this.tracking.reset();
      this.setRunning(true);
      this.openedAt = performance.now();
      this.missing = missing ? `, without ${missing}` : '';
      if (problem) complain(problem);
    } catch (error) {
      if (isStale()) return;
      this.stop();
      complain(error.message);
    }
  }

  openFile(file) {
    if (isModel(file)) return this.useModel(file);
    $('mirror').checked = false;
    this.mirror();
    return this.open(() => this.source.openFile(file));
  }

  stop() {
    this.source.close();
    this.setRunning(false);
    if (this.recording.active) this.record();
    if (this.isReady) say('Stopped.');
  }

  setRunning(running) {
    this.running = running;
    $('stop').hidden = !running;
    $('camera').hidden = running;
    $('camera').disabled = false;
    $('preview').hidden = !running || !this.source.hasVideo;
    for (const id of ['calibrate', 'record']) $(id).disabled = !running;
  }

  mirror() { $('stage').classList.toggle('mirrored', $('mirror').checked); }

  setLevels() {
    const both = $('compare').checked;
    for (const id of ['second', 'other-label']) $(id).hidden = !both;
    $('caption-a').hidden = !both;
    this.second ??= both ? new FaceView($('face-b')) : undefined;
    const chosen = ['level', ...(both ? ['other'] : [])].map(id => Number($(id).value));
    this.tracking.setLevels(chosen);
  }

  show({timeMs, results}) {
    if (!this.running) return;
    const [result, other] = results, sinceMs = Math.min(1000, Math.max(0, timeMs - (this.shownMs ?? timeMs)));
    this.shownMs = timeMs;
    this.firstResultMs ??= performance.now() - this.openedAt;
    this.first.show(result, sinceMs);
    if (other) this.second?.show(other, sinceMs);
    this.recording.add(timeMs, result);
    this.numbers.show(result, {rate: this.first.rate, dropped: this.tracking.dropped});
    this.caption(result, other);
    if (result.flags & calibrating) say('Calibrating: look straight ahead, relaxed …');
    else if (!this.source.hasVideo) say('Audio only' + this.missing);
    else say({searching: 'No face', tracking: 'Tracking', lost: 'Face lost'}[result.status] + this.missing);
    if (this.recording.active) $('recorded').textContent = `${this.recording.seconds.toFixed(1)} s, ${this.recording.frames.length} frames`;
    document.dispatchEvent(new CustomEvent('mien-results', {detail: {timeMs, results}}));
  }

  caption(result, other) {
    const text = ({lod, tookMs}) => `level ${lod}: ${tookMs.toFixed(1)} ms`;
    if (!other) return;
    $('caption-a').textContent = text(result);
    $('caption-b').textContent = text(other);
  }

  record() {
    if (this.recording.active) this.recording.stop(); else this.recording.start();
    const {active, frames} = this.recording;
    $('record').textContent = active ? 'Stop recording' : 'Record';
    $('record').setAttribute('aria-pressed', String(active));
    for (const button of $('downloads').children) button.disabled = active || !frames.length;
  }

  download(format) {
    const {name, type, make} = formats[format];
    download(name, make(this.recording.frames, controlNames), type);
  }

  async useModel(file) {
    try {
      const {openModel} = await import('./model/page_model.js');
      await this.first.use(canvas => openModel(file, canvas));
      say(`${file.name}: ${this.first.avatar.targets.length} names of ${this.first.avatar.vocabularies.join(', ')}`);
      $('own-face').hidden = false;
    } catch (error) {
      complain(error.message);
    }
  }

  async useOwnFace() {
    await this.first.use(canvas => new Avatar(canvas));
    $('own-face').hidden = true;
  }
}

try {
  window.page = new Page();
} catch (error) {
  complain(error.message);
}
if ('serviceWorker' in navigator) navigator.serviceWorker.register('service_worker.js');
