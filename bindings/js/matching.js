// Finds the drivers of an avatar's morph targets and expressions, by their names.
import {vocabularies} from './vocabularies.js';

const minimum = 3;  // with fewer matches, names such as "A" are probably not visemes or vowels, and what precedes them is no prefix

const withoutPath = name => name.replace(/^.*[.:|]/, '');
// The letters and digits of a name in lower case, with sides spelled out, and without what precedes a dot, colon or bar.
const plain = name => withoutPath(name).toLowerCase().replace(/_l$/, 'left').replace(/_r$/, 'right').replace(/[^a-z0-9]/g, '');

// Plain names to drivers; `others`: further spellings of names.
function table(title, drivers, others = {}) {
  const spelled = [...Object.entries(drivers), ...Object.entries(others).map(([other, name]) => [other, drivers[name]])];
  return new Map(spelled.map(([name, driver]) => [plain(name), {vocabulary: title, name, of: driver.of}]));
}

const withPrefix = prefix => Object.fromEntries(Object.keys(vocabularies.visemes).map(name => [prefix + name, name]));
const readyPlayerMe = {viseme_I: 'ih', viseme_O: 'oh', viseme_U: 'ou'};
const vroid = {
  Fcl_ALL_Joy: 'Joy', Fcl_ALL_Angry: 'Angry', Fcl_ALL_Sorrow: 'Sorrow', Fcl_ALL_Fun: 'Fun', Fcl_MTH_A: 'A', Fcl_MTH_I: 'I', Fcl_MTH_U: 'U', Fcl_MTH_E: 'E',
  Fcl_MTH_O: 'O', Fcl_EYE_Close_L: 'Blink_L', Fcl_EYE_Close_R: 'Blink_R'};
const faces = new Map([...table('Roblox', vocabularies.roblox), ...table('ARKit', vocabularies.arkit)]);
const visemes = table('Oculus', vocabularies.visemes, {...withPrefix('viseme_'), ...withPrefix('v_'), ...readyPlayerMe});
const vrm1 = table('VRM', vocabularies.vrm1), vrm0 = table('VRM', vocabularies.vrm0, vroid);
const bothEyes = {vocabulary: 'VRM', name: 'blink', of: c => (c.eyeBlinkLeft + c.eyeBlinkRight) / 2};

const kinds = found => new Set([...found.values()].map(({name}) => name)).size;
const found = (names, drivers) => new Map(names.filter(name => drivers.has(plain(name))).map(name => [name, drivers.get(plain(name))]));

// The same behind prefixes that end in an underscore, each shared by several names: Head_jawOpen, Head_jawLeft, Head_jawRight.
function foundBehindPrefixes(names, drivers) {
  const groups = new Map();
  for (const name of names) {
    const text = withoutPath(name);
    for (const {index} of text.matchAll(/_/g)) {
      const prefix = text.slice(0, index), driver = drivers.get(plain(text.slice(index + 1)));
      if (driver) groups.set(prefix, new Map(groups.get(prefix)).set(name, driver));
    }
  }
  return new Map([...groups.values()].filter(group => kinds(group) >= minimum).flatMap(group => [...group]));
}

// Short names, such as VRoid's of parts of the face, are not looked for behind prefixes if the vocabulary is there without one.
function foundShort(names, drivers) {
  const direct = found(names, drivers);
  return kinds(direct) < minimum ? foundBehindPrefixes(names, drivers) : direct;
}

/**
 * Drivers by the names of morph targets, as mien_vocabulary_match finds them. Visemes and VRM's vowels move the mouth if no
 * name of ARKit or Roblox does.
 */
export function morphDrivers(names) {
  const face = new Map([...foundBehindPrefixes(names, faces), ...found(names, faces)]);
  if ([...face.values()].some(({name}) => name === 'jawOpen' || name === 'JawDrop')) return face;
  const [mouth] = [visemes, vrm1, vrm0].map(drivers => foundShort(names, drivers)).sort((a, b) => kinds(b) - kinds(a));
  return kinds(mouth) < minimum ? face : new Map([...face, ...mouth]);
}

/** Drivers by the names of a VRM's expressions: ARKit's, if it has them, otherwise the presets. */
export function expressionDrivers(names) {
  const arkit = new Map([...found(names, faces)].filter(([, {vocabulary}]) => vocabulary === 'ARKit'));
  if (arkit.size > 20) return arkit;  // "perfect sync" replaces the presets
  const presets = new Map([...found(names, vrm0), ...found(names, vrm1)]);
  if (names.includes('blink') && !presets.has('blinkLeft')) presets.set('blink', bothEyes);
  return new Map([...arkit, ...presets]);
}
