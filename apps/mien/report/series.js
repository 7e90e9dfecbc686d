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

// The range of displayed values, at least `least`, symmetric around 0.
const balanced = least => shown => {
  const reach = Math.max(least, ...shown.flatMap(series => series.range.map(Math.abs))) * 1.1;
  return [-reach, reach];
};
// For times: a few outliers are outside the range.
function mostOf([series]) {
  const sorted = series.column.steps.slice().sort();
  return [0, Math.max(0.1, 1.5 * sorted[Math.floor(0.99 * (sorted.length - 1))] * series.column.unit)];
}

// Lanes in display order: title, series, and the range of the axis.
function makeLanes(take) {
  const of = (name, column, options) => new Series(name, take.column(column), options);
  const degrees = {scale: 180 / Math.PI, unit: '°', shown: true};
  const lanes = [
    {key: 'sound', title: 'Audio', wave: true, range: fixedRange, digits: 1,
      series: [of('voice activity', 'voice_activity', {hue: 1, shown: true})]},
    {key: 'head', title: 'Head', range: balanced(10), digits: 0, unit: '°',
      series: ['pitch', 'yaw', 'roll'].map((name, hue) => of(name, name, {hue, ...degrees}))},
    {key: 'place', title: 'Head position', range: balanced(0.05), digits: 2, unit: ' m',
      series: ['x', 'y', 'z'].map((name, hue) => of(`${name}, metres`, `${name}_m`, {hue, unit: ' m'}))},
    ...controlGroups.map(({key, title, of: pattern}) => ({key, title, range: fixedRange, digits: 1,
      series: controlSeries(take, controlNames.filter(name => pattern.test(name)), mainControls)})),
    {key: 'tracker', title: 'Tracker', range: fixedRange, digits: 1, series: [of('face probability', 'face_probability', {hue: 0})]},
    {key: 'time', title: 'Time per frame', range: mostOf, digits: 1, unit: ' ms', series: [of('milliseconds', 'took_ms', {hue: 5, unit: ' ms'})]},
  ];
  for (const lane of lanes) lane.series = lane.series.filter(series => !series.column.empty);
  const hasSound = take.column('sound_low').steps.length > 0;
  return lanes.filter(lane => lane.series.length && (!lane.wave || hasSound));
}
