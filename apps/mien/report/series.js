// All curves: each series has a lane, a colour and a switch.

const hues = 8;  // --hue-0 ... of the style

class Series {
  // `scale`: factor from the column's values to displayed values.
  constructor(name, column, {hue, paler = false, scale = 1, shown = false, unit = ''}) {
    Object.assign(this, {name, column, hue, paler, scale, shown, unit});
  }
  get pyramid() { return this.tree ??= new Pyramid(this.column.steps); }
  value(i) {
    const value = this.column.at(i);
    return value === null ? null : value * this.scale;
  }
  text(i) {
    const value = this.value(i);
    const text = value?.toFixed(this.unit === '°' ? 0 : 2);
    return value === null ? '–' : text.replace(/^-(?=[0.]*$)/, '') + this.unit;  // no -0
  }
  // The range of all values.
  get range() {
    const found = this.pyramid.range(0, this.column.steps.length);
    return found?.map(step => step * this.column.unit * this.scale) ?? [0, 1];
  }
}

// Left and right have the same hue; the right one is paler.
function controlSeries(take, names, main) {
  const bases = [];
  return names.map(name => {
    const base = name.replace(/(Left|Right)$/, ''), isRight = name.endsWith('Right') && names.includes(`${base}Left`);
    if (!bases.includes(base)) bases.push(base);
    return new Series(name, take.column(name), {hue: bases.indexOf(base) % hues, paler: isRight, shown: main.test(name)});
  });
}

const mainControls = /^(eyeBlink|browInnerUp|jawOpen|mouthSmile|mouthPucker|mouthClose)/;
const fixedRange = () => [0, 1];

// The end of an axis for values up to `value`.
function axisEnd(value) {
  const power = 10 ** Math.floor(Math.log10(value)), found = [1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10].find(step => step * power > value * 0.9999);
  return Number((found * power).toPrecision(2));
}
const largest = shown => Math.max(...shown.map(series => series.range[1])), smallest = shown => Math.min(...shown.map(series => series.range[0]));

// For controls: up to the largest displayed value, but noise stays small.
const upToLargest = shown => [0, Math.min(1, axisEnd(Math.max(0.1, largest(shown))))];

// For values of both signs, at least `least` large; the shorter half keeps room for its label.
const aroundZero = least => shown => {
  const [low, high] = [-smallest(shown), largest(shown)], minimum = Math.max(least, low, high) / 4;
  return [-axisEnd(Math.max(low, minimum)), axisEnd(Math.max(high, minimum))];
};

// For values far from 0: those that occur, at least `least` apart.
const occurring = least => shown => {
  const [low, high] = [smallest(shown), largest(shown)], step = 10 ** Math.floor(Math.log10(Math.max(least, high - low)));
  return [Math.floor(low / step), Math.floor(high / step) + 1].map(steps => Number((steps * step).toPrecision(6)));
};

// For times: a few outliers are outside the range.
function mostOf([series]) {
  const sorted = series.column.steps.slice().sort();
  return [0, axisEnd(Math.max(0.1, 1.2 * sorted[Math.floor(0.99 * (sorted.length - 1))] * series.column.unit))];
}

// Lanes in display order: title, series, and the range of the axis.
function makeLanes(take) {
  const of = (name, column, options) => new Series(name, take.column(column), options);
  const degrees = {scale: 180 / Math.PI, unit: '°', shown: true};
  const lanes = [
    {key: 'sound', title: 'Audio', wave: true, range: fixedRange,
      series: [of('voice activity', 'voice_activity', {hue: 1, shown: true})]},
    {key: 'head', title: 'Head', range: aroundZero(10), unit: '°',
      series: ['pitch', 'yaw', 'roll'].map((name, hue) => of(name, name, {hue, ...degrees}))},
    {key: 'place', title: 'Head position', range: aroundZero(0.02), unit: ' m',
      series: ['x', 'y'].map((name, hue) => of(`${name}, metres`, `${name}_m`, {hue, unit: ' m'}))},
    {key: 'depth', title: 'Head position, depth', range: occurring(0.02), unit: ' m', series: [of('z, metres', 'z_m', {hue: 2, unit: ' m'})]},
    ...controlGroups.map(({key, title, of: pattern}) => ({key, title, range: upToLargest,
      series: controlSeries(take, controlNames.filter(name => pattern.test(name)), mainControls)})),
    {key: 'tracker', title: 'Tracker', range: fixedRange, series: [of('face probability', 'face_probability', {hue: 0})]},
    {key: 'time', title: 'Time per frame', range: mostOf, unit: ' ms', series: [of('milliseconds', 'took_ms', {hue: 5, unit: ' ms'})]},
  ];
  for (const lane of lanes) lane.series = lane.series.filter(series => !series.column.empty);
  const hasSound = take.column('sound_low').steps.length > 0;
  return lanes.filter(lane => lane.series.length && (!lane.wave || hasSound));
}
