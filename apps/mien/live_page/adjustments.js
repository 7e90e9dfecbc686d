// Gain and dead zone of each control, with its current value.

const sendInterval_ms = 50;

class Adjustments {
  constructor(box, details) {
    this.details = details;
    this.rows = new Map();
    this.changed = new Map();
    this.send = throttled(() => this.sendChanges(), sendInterval_ms);
    box.append(this.head());
    for (const {title, of} of controlGroups) {
      const heading = document.createElement('h3');
      heading.textContent = title;
      box.append(heading, ...controlNames.filter(name => of.test(name)).map(name => this.row(name)));
    }
  }

  head() {
    const row = document.createElement('div');
    row.className = 'adjustment head';
    row.append(...['Control', 'Gain', 'Dead zone'].map(text => Object.assign(document.createElement('span'), {textContent: text})));
    return row;
  }

  row(name) {
    const row = document.createElement('div'), label = document.createElement('span');
    const slider = (what, max, step) => {
      const input = document.createElement('input');
      Object.assign(input, {type: 'range', min: 0, max, step, ariaLabel: `${what} of ${name}`});
      input.addEventListener('input', () => this.change(name));
      return input;
    };
    Object.assign(label, {className: 'name', textContent: name});
    const gain = slider('Gain', 4, 0.05), deadZone = slider('Dead zone', 0.9, 0.01);
    row.className = 'adjustment';
    row.append(label, gain, deadZone);
    this.rows.set(name, {label, gain, deadZone});
    return row;
  }

  change(name) {
    const {gain, deadZone} = this.rows.get(name);
    this.set({[name]: {gain: Number(gain.value), dead_zone: Number(deadZone.value)}});
  }

  // Changes controls, given as {jawOpen: {gain, dead_zone}}.
  set(changes) {
    for (const [control, change] of Object.entries(changes)) this.changed.set(control, {control, ...change});
    this.send();
  }

  reset() { this.set(Object.fromEntries(controlNames.map(name => [name, {gain: 1, dead_zone: 0}]))); }

  sendChanges() {
    const controls = [...this.changed.values()];
    this.changed.clear();
    command('adjust', {controls}).catch(error => complain(error.message));
  }

  // [gain, dead zone] of each control; a slider that the user moves is left alone.
  show(adjustments) {
    controlNames.forEach((name, i) => {
      const {gain, deadZone} = this.rows.get(name);
      if (document.activeElement === gain || document.activeElement === deadZone) return;
      [gain.value, deadZone.value] = adjustments[i];
      gain.title = `gain ${adjustments[i][0]}`;
      deadZone.title = `dead zone ${adjustments[i][1]}`;
    });
  }

  showValues(controls) {
    if (!this.details.open) return;
    controlNames.forEach((name, i) => this.rows.get(name).label.style.setProperty('--value', controls[i] ?? 0));
  }
}
