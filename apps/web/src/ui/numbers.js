// Displays figures of the tracker: rates, times, voice activity, and every control as a bar.
import {trackerParts} from './parts.js';

const element = (tag, text) => Object.assign(document.createElement(tag), {textContent: text});
const ms = value => `${value.toFixed(value < 10 ? 2 : 1)} ms`;
const refresh_ms = 250;

export class Numbers {
  constructor(list, bars, details) {
    Object.assign(this, {list, bars, details, cells: new Map(), shownAt: 0, average: new Map()});
  }

  setControls(names) {
    this.items = names.map(name => element('li', name));
    this.bars.replaceChildren(...this.items);
  }

  cell(name) {
    if (!this.cells.has(name)) {
      const cell = element('dd', '');
      this.list.append(element('dt', name), cell);
      this.cells.set(name, cell);
    }
    return this.cells.get(name);
  }

  // A running mean, so that figures are readable.
  mean(name, value) {
    const mean = this.average.has(name) ? this.average.get(name) * 0.9 + value * 0.1 : value;
    this.average.set(name, mean);
    return mean;
  }

  show(result, {rate, dropped}) {
    const whole = this.mean('frame', result.tookMs);
    const times = Object.entries(trackerParts).map(([name, stages]) => [name, this.mean(name, stages.reduce((sum, stage) => sum + result.stageNs[stage], 0) / 1e6)]);
    if (this.details.open) this.showBars(result);
    if (performance.now() - this.shownAt < refresh_ms) return;
    this.shownAt = performance.now();
    const put = (name, text) => { if (this.cell(name).textContent !== text) this.cell(name).textContent = text; };
    put('Face', `${result.status}, ${Math.round(result.faceProbability * 100)} %`);
    put('Voice', `${Math.round(result.voiceActivity * 100)} %`);
    put('Level', String(result.lod));
    put('Tracking', `${ms(whole)} per frame`);
    put('Parts', times.filter(([, value]) => value >= 0.05).map(([name, value]) => `${name} ${value.toFixed(1)}`).join(', ') + ' ms');
    put('Frame rate', `${rate.toFixed(0)} per second`);
    put('Dropped frames', String(dropped));
    put('Head', ['pitch', 'yaw', 'roll'].map(name => `${name}\u00a0${Math.round(result[name] * 180 / Math.PI)}°`).join(', '));
  }

  showBars({controls, supportedControls}) {
    this.items.forEach((item, i) => {
      item.style.setProperty('--value', controls[i].toFixed(3));
      item.classList.toggle('undriven', (supportedControls >> BigInt(i) & 1n) === 0n);
    });
  }
}
