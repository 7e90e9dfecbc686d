// Moves avatars of three.js by results, without depending on three.js. Results may come from a worker.
import {expressionDrivers, morphDrivers} from './matching.js';
import {valuesOf} from './vocabularies.js';

/** The morph targets of an object that have known names: {vocabulary, name, of(values), set(value)}. */
export function morphTargets(root) {
  const nodes = [];
  root.traverse(node => node.morphTargetDictionary && nodes.push(node));
  const drivers = morphDrivers([...new Set(nodes.flatMap(node => Object.keys(node.morphTargetDictionary)))]);
  return nodes.flatMap(node => Object.entries(node.morphTargetDictionary).filter(([name]) => drivers.has(name)).map(
    ([name, index]) => ({...drivers.get(name), set: value => { node.morphTargetInfluences[index] = value; }})));
}

/** The same for the expressions of a VRM. */
export function expressionTargets(manager) {
  const drivers = expressionDrivers((manager?.expressions ?? []).map(({expressionName}) => expressionName));
  return [...drivers].map(([name, driver]) => ({...driver, set: value => manager.setValue(name, value)}));
}

const bindings = new WeakMap();  // of avatars, whose names are read once

function targetsOf(avatar, bind) {
  if (!bindings.has(avatar)) bindings.set(avatar, bind(avatar));
  return bindings.get(avatar);
}

/** `values`: those of valuesOf. */
export function move(targets, values) {
  for (const {of, set} of targets) set(Math.min(1, Math.max(0, of(values))));
  return targets.length;
}

export const applyToMorphs = (root, result) => move(targetsOf(root, morphTargets), valuesOf(result));

export function applyToVRM(vrm, result) {
  const moved = move(targetsOf(vrm, ({expressionManager}) => expressionTargets(expressionManager)), valuesOf(result));
  const head = vrm.humanoid?.getNormalizedBoneNode('head'), [x, y, z, w] = result.rotation;
  const facing = vrm.meta?.metaVersion === '0' ? -1 : 1;  // VRM 0 looks along -z
  head?.quaternion.set(facing * x, y, facing * z, w);
  return moved;
}
