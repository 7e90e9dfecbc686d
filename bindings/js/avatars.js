// Moves avatars of three.js by results, without depending on three.js. Runs where the avatar is: results may come from a worker.
import {makeDrivers} from './drivers.js';

const sided = ['eyeBlink', 'eyeLookDown', 'eyeLookIn', 'eyeLookOut', 'eyeLookUp', 'eyeSquint', 'eyeWide'];
const pairs = names => names.flatMap(name => [name + 'Left', name + 'Right']);

/** ARKit's names, in the order of result.controls. */
export const controlNames = Object.freeze([
  ...sided.map(name => name + 'Left'), ...sided.map(name => name + 'Right'),
  'jawForward', 'jawLeft', 'jawRight', 'jawOpen', 'mouthClose', 'mouthFunnel', 'mouthPucker', 'mouthLeft', 'mouthRight',
  ...pairs(['mouthSmile', 'mouthFrown', 'mouthDimple', 'mouthStretch']), 'mouthRollLower', 'mouthRollUpper', 'mouthShrugLower', 'mouthShrugUpper',
  ...pairs(['mouthPress', 'mouthLowerDown', 'mouthUpperUp', 'browDown']), 'browInnerUp', ...pairs(['browOuterUp']), 'cheekPuff',
  ...pairs(['cheekSquint', 'noseSneer']), 'tongueOut']);
const drivers = makeDrivers(controlNames);
const clamp = value => Math.min(1, Math.max(0, value));

// All 52 controls by name; those that the level of detail does not predict are 0.
const byName = ({controls}) => Object.fromEntries(controlNames.map((name, i) => [name, controls[i]]));

export function controlsByName({controls, supportedControls}) {
  return Object.fromEntries(controlNames.map((name, i) => [name, controls[i]]).filter((_, i) => supportedControls >> BigInt(i) & 1n));
}

const bindings = new WeakMap();  // of avatars, whose names are read once

function bindingOf(avatar, bind) {
  if (!bindings.has(avatar)) bindings.set(avatar, bind());
  return bindings.get(avatar);
}

function bindMorphs(root) {
  const targets = [];
  root.traverse(node => {
    for (const [name, index] of Object.entries(node.morphTargetDictionary ?? {})) {
      const driver = drivers.morph(name);
      if (driver) targets.push({of: driver.of, set: value => { node.morphTargetInfluences[index] = value; }});
    }
  });
  return targets;
}

function bindExpressions({expressionManager}) {
  const names = expressionManager.expressions.map(({expressionName}) => expressionName), targets = [];
  for (const name of names) {
    if (name === 'blink' && names.includes('blinkLeft')) continue;  // each eye has its own
    const driver = drivers.expression(name);
    if (driver) targets.push({...driver, set: value => expressionManager.setValue(name, value)});
  }
  const arkit = targets.filter(({vocabulary}) => vocabulary === 'ARKit');
  return arkit.length > 20 ? arkit : targets;  // "perfect sync" replaces the presets
}

function move(targets, result) {
  const controls = byName(result);
  for (const {of, set} of targets) set(clamp(of(controls)));
  return targets.length;
}

export function applyToMorphs(root, result) {
  return move(bindingOf(root, () => bindMorphs(root)), result);
}

export function applyToVRM(vrm, result) {
  const moved = move(bindingOf(vrm, () => bindExpressions(vrm)), result);
  const head = vrm.humanoid?.getNormalizedBoneNode('head'), [x, y, z, w] = result.rotation;
  const facing = vrm.meta?.metaVersion === '0' ? -1 : 1;  // VRM 0 looks along -z
  head?.quaternion.set(facing * x, y, facing * z, w);
  return moved;
}
