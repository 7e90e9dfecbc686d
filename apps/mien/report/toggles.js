// A switch per series, which also shows its current value.

class Toggles {
  constructor(lanes) {
    this.lanes = lanes;
    this.buttons = [];
    document.getElementById('toggles').append(...lanes.lanes.map(({lane}) => this.group(lane)));
    for (const button of document.querySelectorAll('#presets button')) button.addEventListener('click', () => this.preset(button.dataset.preset));
    const undriven = controlNames.filter(name => !lanes.series.some(series => series.name === name));
    document.getElementById('undriven').textContent = undriven.length ? `Unsupported controls: ${undriven.join(', ')}.` : '';
    this.usual = lanes.series.filter(series => series.shown);
  }

  group(lane) {
    const group = document.createElement('fieldset'), legend = Object.assign(document.createElement('legend'), {textContent: lane.title});
    group.append(legend, ...lane.series.map(series => this.button(series)));
    return group;
  }

  button(series) {
    const button = Object.assign(document.createElement('button'), {type: 'button', textContent: series.name});
    button.className = `toggle hue-${series.hue}${series.paler ? ' paler' : ''}`;
    button.dataset.name = series.name;
    button.addEventListener('click', () => { series.shown = !series.shown; this.update(); });
    button.setAttribute('aria-pressed', String(series.shown));
    this.buttons.push({button, series, isShare: series.unit === ''});
    return button;
  }

  preset(name) {
    for (const {series} of this.buttons) series.shown = name === 'all' || (name === 'main' && this.usual.includes(series));
    this.update();
  }

  update() {
    for (const {button, series} of this.buttons) button.setAttribute('aria-pressed', String(series.shown));
    this.lanes.update();
  }

  show(i) {
    for (const {button, series, isShare} of this.buttons) if (isShare) button.style.setProperty('--value', (series.value(i) ?? 0).toFixed(3));
  }
}
