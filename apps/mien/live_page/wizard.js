// Calibration step by step: relax, strong expressions, suggestions.

const rest_ms = 2000, expression_ms = 3000, neutralTimeout_ms = 15000;
const neutral_ms = 1900;  // of the tracker: 55 frames
const expressions = [
  'Open your mouth wide', 'Smile broadly', 'Pull the corners of your mouth down', 'Pucker your lips', 'Raise your brows',
  'Lower your brows', 'Squeeze your eyes shut', 'Open your eyes wide', 'Wrinkle your nose', 'Puff your cheeks'];

const pause = time_ms => new Promise(done => setTimeout(done, time_ms));

class Wizard {
  constructor({step, progress, button, adjustments}) {
    Object.assign(this, {step, progress, button, adjustments});
    this.idle = step.textContent;
    button.addEventListener('click', () => (this.running ? this.cancel() : this.run()));
  }

  showState({calibrating}) {
    this.captures ||= calibrating;
    this.calibrating = calibrating;
  }

  showFrame({raw}) { this.peaks?.add(raw); }

  cancel() {
    this.running = undefined;
    this.finish(this.idle);
  }

  finish(text) {
    this.peaks = undefined;
    this.running = undefined;
    this.button.textContent = 'Calibrate';
    this.progress.hidden = true;
    this.step.className = '';
    this.step.textContent = text;
  }

  async run() {
    const run = this.running = {};  // a new object per run, so that a cancelled one notices
    const stopped = () => this.running !== run;
    this.button.textContent = 'Cancel';
    this.progress.hidden = false;
    this.progress.value = 0;
    this.say('Look ahead and relax your face');
    try {
      if (!await this.captureNeutral(stopped)) {
        if (!stopped()) this.finish('No face was visible long enough. Check the camera and the light, and try again.');
        return;
      }
      const rest = await this.collect(rest_ms, stopped), strongest = await this.collectExpressions(stopped);
      if (stopped()) return;
      this.adjustments.set(suggestions(rest, strongest));
      this.finish('Done. Check the avatar, change single controls below, and save the profile.');
    } catch (error) {
      this.finish(this.idle);
      complain(error.message);
    }
  }

  say(text) {
    this.step.className = 'now';
    this.step.textContent = text;
  }

  // Returns whether the tracker has captured a neutral face.
  async captureNeutral(stopped) {
    this.captures = this.calibrating = false;
    await command('neutral');
    const begin_ms = performance.now();
    while (!stopped() && performance.now() - begin_ms < neutralTimeout_ms) {
      if (this.captures && !this.calibrating) return true;
      this.progress.value = this.part(0, Math.min(1, (performance.now() - begin_ms) / neutral_ms));
      await pause(50);
    }
    return false;
  }

  // The position of the progress bar: the neutral face, the rest, then the expressions.
  part(index, fraction) { return (index + fraction) / (2 + expressions.length); }

  // The highest value of each control within the time.
  async collect(time_ms, stopped, index = 1, peaks = new Peaks()) {
    this.peaks = peaks;
    for (const begin_ms = performance.now(); !stopped() && performance.now() - begin_ms < time_ms;) {
      this.progress.value = this.part(index, (performance.now() - begin_ms) / time_ms);
      await pause(50);
    }
    this.peaks = undefined;
    return peaks;
  }

  async collectExpressions(stopped) {
    const peaks = new Peaks();
    for (const [i, text] of expressions.entries()) {
      if (stopped()) break;
      this.say(text);
      await this.collect(expression_ms, stopped, 2 + i, peaks);
    }
    return peaks;
  }
}
