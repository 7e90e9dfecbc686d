// The controls that drive a morph target, by its name: ARKit's names in any case and with _L and _R, Roblox's FACS
// names, and VRM's expressions, which combine several controls.

const plain = name => name.replace(/^.*[.:|]/, '').toLowerCase()
  .replace(/_l$/, 'left').replace(/_r$/, 'right').replace(/[^a-z0-9]/g, '');

const of = name => c => c[name];
const mean = (...names) => c => names.reduce((sum, name) => sum + c[name], 0) / names.length;
const max = (...names) => c => Math.max(...names.map(name => c[name]));

const roblox = {
  ChinRaiserUpperLip: of('mouthShrugUpper'), ChinRaiser: of('mouthShrugLower'), Funneler: of('mouthFunnel'),
  LowerLipSuck: of('mouthRollLower'), LipPresser: mean('mouthPressLeft', 'mouthPressRight'), LipsTogether: of('mouthClose'),
  Pucker: of('mouthPucker'), UpperLipSuck: of('mouthRollUpper'), JawDrop: of('jawOpen'),
  Corrugator: c => Math.min(c.browDownLeft, c.browDownRight),
  EyesLookDown: mean('eyeLookDownLeft', 'eyeLookDownRight'), EyesLookUp: mean('eyeLookUpLeft', 'eyeLookUpRight'),
  EyesLookLeft: mean('eyeLookOutLeft', 'eyeLookInRight'), EyesLookRight: mean('eyeLookInLeft', 'eyeLookOutRight'),
};
const robloxSides = {
  CheekPuff: () => of('cheekPuff'), Dimpler: s => of('mouthDimple' + s), LipCornerDown: s => of('mouthFrown' + s),
  LowerLipDepressor: s => of('mouthLowerDown' + s), LipCornerPuller: s => of('mouthSmile' + s), LipStretcher: s => of('mouthStretch' + s),
  UpperLipRaiser: s => of('mouthUpperUp' + s), BrowLowerer: s => of('browDown' + s), OuterBrowRaiser: s => of('browOuterUp' + s),
  InnerBrowRaiser: () => of('browInnerUp'), NoseWrinkler: s => of('noseSneer' + s), CheekRaiser: s => max('eyeSquint' + s, 'cheekSquint' + s),
  EyeUpperLidRaiser: s => of('eyeWide' + s), EyeClosed: s => of('eyeBlink' + s),
};

const clamp01 = value => Math.min(1, Math.max(0, value));
const smile = mean('mouthSmileLeft', 'mouthSmileRight'), frown = mean('mouthFrownLeft', 'mouthFrownRight');
const wide = mean('mouthStretchLeft', 'mouthStretchRight');
// VRM 1.0's presets, and their names in VRM 0.
const vrm = {
  blinkLeft: of('eyeBlinkLeft'), blinkRight: of('eyeBlinkRight'), blink: c => Math.min(c.eyeBlinkLeft, c.eyeBlinkRight),
  aa: c => clamp01(1.3 * c.jawOpen * (1 - Math.max(c.mouthFunnel, c.mouthPucker)) - 0.6 * c.mouthClose),
  oh: c => clamp01(1.2 * c.mouthFunnel), ou: c => clamp01(1.2 * c.mouthPucker),
  ih: c => clamp01(1.2 * wide(c)), ee: c => clamp01(0.5 * smile(c) * Math.min(1, 3 * c.jawOpen)),
  happy: c => clamp01(smile(c)), sad: c => clamp01(frown(c)),
  angry: c => clamp01(Math.min(c.browDownLeft, c.browDownRight)), surprised: c => clamp01(Math.min(c.eyeWideLeft, c.eyeWideRight)),
};
const vrm0 = {blink_l: 'blinkLeft', blink_r: 'blinkRight', a: 'aa', i: 'ih', u: 'ou', e: 'ee', o: 'oh', joy: 'happy', sorrow: 'sad', fun: 'happy'};

export function makeDrivers(controlNames) {
  const drivers = new Map();
  for (const name of controlNames) drivers.set(plain(name), {vocabulary: 'ARKit', of: of(name)});
  const addRoblox = (name, how) => {
    if (!drivers.has(plain(name))) drivers.set(plain(name), {vocabulary: 'Roblox', of: how});
  };
  for (const [name, how] of Object.entries(roblox)) addRoblox(name, how);
  for (const [name, how] of Object.entries(robloxSides)) {
    for (const side of ['Left', 'Right']) addRoblox(side + name, how(side));
  }
  return {
    // {vocabulary, of(controls)} or undefined.
    morph: name => drivers.get(plain(name)),
    expression: name => {
      const perfectSync = drivers.get(plain(name));
      if (perfectSync) return perfectSync;
      const preset = vrm[name] ?? vrm[vrm0[name.toLowerCase()]];
      return preset && {vocabulary: 'VRM', of: preset};
    }};
}
