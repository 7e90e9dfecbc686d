// The 52 controls and their values in other vocabularies, as vocabulary_tables.h of the library defines them: one driver per name.
// Visemes, which are mixtures, come with a result.
import {MienError} from './error.js';

const sides = ['Left', 'Right'], eyes = ['eyeBlink', 'eyeLookDown', 'eyeLookIn', 'eyeLookOut', 'eyeLookUp', 'eyeSquint', 'eyeWide'];
const pairs = (...names) => names.flatMap(name => sides.map(side => name + side));

/** ARKit's names, in the order of result.controls. */
export const controlNames = Object.freeze([
  ...sides.flatMap(side => eyes.map(name => name + side)), 'jawForward', 'jawLeft', 'jawRight', 'jawOpen', 'mouthClose', 'mouthFunnel', 'mouthPucker',
  'mouthLeft', 'mouthRight', ...pairs('mouthSmile', 'mouthFrown', 'mouthDimple', 'mouthStretch'), 'mouthRollLower', 'mouthRollUpper', 'mouthShrugLower',
  'mouthShrugUpper', ...pairs('mouthPress', 'mouthLowerDown', 'mouthUpperUp', 'browDown'), 'browInnerUp', ...pairs('browOuterUp'), 'cheekPuff',
  ...pairs('cheekSquint', 'noseSneer'), 'tongueOut']);
const visemeNames = ['sil', 'PP', 'FF', 'TH', 'DD', 'kk', 'CH', 'SS', 'nn', 'RR', 'aa', 'E', 'ih', 'oh', 'ou'];

// A driver computes a value from `values`: the controls by name, and visemes. `has(name)`: whether a control is supported.
const mean = (...names) => ({
  of: values => names.reduce((sum, name) => sum + values[name], 0) / Math.max(1, names.length),
  supported: has => names.length > 0 && names.every(has)});
const max = (...names) => ({of: values => Math.max(...names.map(name => values[name])), supported: has => names.some(has)});
const min = (...names) => ({...mean(...names), of: values => Math.min(...names.map(name => values[name]))});
const none = mean();

const robloxSides = {
  CheekPuff: () => mean('cheekPuff'), Dimpler: side => mean('mouthDimple' + side), LipCornerDown: side => mean('mouthFrown' + side),
  LowerLipDepressor: side => mean('mouthLowerDown' + side), LipCornerPuller: side => mean('mouthSmile' + side),
  LipStretcher: side => mean('mouthStretch' + side), UpperLipRaiser: side => mean('mouthUpperUp' + side), BrowLowerer: side => mean('browDown' + side),
  OuterBrowRaiser: side => mean('browOuterUp' + side), NoseWrinkler: side => mean('noseSneer' + side), InnerBrowRaiser: () => mean('browInnerUp'),
  CheekRaiser: side => max('eyeSquint' + side, 'cheekSquint' + side), EyeUpperLidRaiser: side => mean('eyeWide' + side),
  EyeClosed: side => mean('eyeBlink' + side)};
const roblox = {
  ChinRaiserUpperLip: mean('mouthShrugUpper'), ChinRaiser: mean('mouthShrugLower'), FlatPucker: none, Funneler: mean('mouthFunnel'),
  LowerLipSuck: mean('mouthRollLower'), LipPresser: mean('mouthPressLeft', 'mouthPressRight'), LipsTogether: mean('mouthClose'),
  MouthLeft: mean('mouthLeft'), MouthRight: mean('mouthRight'), Pucker: mean('mouthPucker'), UpperLipSuck: mean('mouthRollUpper'),
  JawDrop: mean('jawOpen'), JawLeft: mean('jawLeft'), JawRight: mean('jawRight'), Corrugator: min('browDownLeft', 'browDownRight'),
  EyesLookDown: mean(...pairs('eyeLookDown')), EyesLookLeft: mean('eyeLookOutLeft', 'eyeLookInRight'), EyesLookUp: mean(...pairs('eyeLookUp')),
  EyesLookRight: mean('eyeLookInLeft', 'eyeLookOutRight'), TongueDown: none, TongueOut: mean('tongueOut'), TongueUp: none};
for (const [name, driver] of Object.entries(robloxSides)) for (const side of sides) roblox[side + name] = driver(side);

const vrm1 = {
  happy: mean(...pairs('mouthSmile')), angry: mean(...pairs('browDown')), sad: mean(...pairs('mouthFrown')), relaxed: none, aa: mean('jawOpen'),
  ih: mean(...pairs('mouthStretch')), ou: mean('mouthPucker'), ee: mean(...pairs('mouthLowerDown', 'mouthUpperUp')), oh: mean('mouthFunnel'),
  blinkLeft: mean('eyeBlinkLeft'), blinkRight: mean('eyeBlinkRight')};
const vrm0 = {
  Joy: vrm1.happy, Angry: vrm1.angry, Sorrow: vrm1.sad, Fun: none, A: vrm1.aa, I: vrm1.ih, U: vrm1.ou, E: vrm1.ee, O: vrm1.oh,
  Blink_L: vrm1.blinkLeft, Blink_R: vrm1.blinkRight};

const arkit = Object.fromEntries(controlNames.map(name => [name, mean(name)]));
const mediapipe = Object.fromEntries(['_neutral', ...controlNames.filter(name => name !== 'tongueOut').sort()].map(name => [name, arkit[name] ?? none]));
const viseme = i => ({of: ({visemes}) => visemes?.[i] ?? 0, supported: (_, supportedVisemes) => Boolean(supportedVisemes >> i & 1)});
const visemes = Object.fromEntries(visemeNames.map((name, i) => [name, viseme(i)]));

export const vocabularies = {arkit, mediapipe, roblox, vrm0, vrm1, visemes};

export const valuesOf = ({controls, visemes}) => ({...Object.fromEntries(controlNames.map((name, i) => [name, controls[i]])), visemes});

export function controlsByName(result, vocabulary = 'arkit') {
  const drivers = vocabularies[vocabulary];
  if (!drivers) throw new MienError(`vocabulary: unknown (got '${vocabulary}', expected ${Object.keys(vocabularies).join(', ')})`, -3);
  const values = valuesOf(result), has = name => Boolean(result.supportedControls >> BigInt(controlNames.indexOf(name)) & 1n);
  const supported = Object.entries(drivers).filter(([, driver]) => driver.supported(has, result.supportedVisemes));
  return Object.fromEntries(supported.map(([name, driver]) => [name, driver.of(values)]));
}
