// Small models like those of users: a triangle whose morph targets have names, with bones for head and eyes.

const pad = (bytes, filler) => {
  const out = new Uint8Array(bytes.length + 3 & ~3).fill(filler);
  out.set(bytes);
  return out;
};

function glb(json, binary) {
  const text = pad(new TextEncoder().encode(JSON.stringify(json)), 0x20), body = pad(binary, 0);
  const header = values => new Uint8Array(Uint32Array.from(values).buffer);
  return Buffer.concat([header([0x46546c67, 2, 28 + text.length + body.length, text.length, 0x4e4f534a]), text, header([body.length, 0x004e4942]), body]);
}

// Nodes: 0 root > 1 head > 2 leftEye, 3 rightEye, 4 the mesh.
export function headModel(targetNames, extensions) {
  const positions = Float32Array.from([-0.1, 1.4, 0, 0.1, 1.4, 0, 0, 1.7, 0]), offset = new Float32Array(9).fill(0.05);
  const view = (byteOffset, byteLength) => ({buffer: 0, byteOffset, byteLength});
  const accessor = (bufferView, min, max) => ({bufferView, componentType: 5126, count: 3, type: 'VEC3', min, max});
  return glb({
    asset: {version: '2.0'}, scene: 0, scenes: [{nodes: [0]}],
    nodes: [{name: 'root', children: [1]}, {name: 'Head', children: [2, 3, 4], translation: [0, 0, 0]}, {name: 'LeftEye'}, {name: 'RightEye'}, {name: 'face', mesh: 0}],
    meshes: [{primitives: [{attributes: {POSITION: 0}, targets: targetNames.map(() => ({POSITION: 1}))}], weights: targetNames.map(() => 0), extras: {targetNames}}],
    buffers: [{byteLength: 72}], bufferViews: [view(0, 36), view(36, 36)],
    accessors: [accessor(0, [-0.1, 1.4, 0], [0.1, 1.7, 0]), accessor(1, [0.05, 0.05, 0.05], [0.05, 0.05, 0.05])], ...extensions,
  }, new Uint8Array(Float32Array.from([...positions, ...offset]).buffer));
}

// VRM 1.0 whose presets `aa` and `blinkLeft` each move a target.
export const vrmModel = () => headModel(['open', 'shut'], {
  extensionsUsed: ['VRMC_vrm'],
  extensions: {VRMC_vrm: {
    specVersion: '1.0',
    meta: {name: 'test', version: '1', authors: ['mien'], licenseUrl: 'https://vrm.dev/licenses/1.0/'},
    humanoid: {humanBones: Object.fromEntries([
      'hips', 'spine', 'leftUpperLeg', 'leftLowerLeg', 'leftFoot', 'rightUpperLeg', 'rightLowerLeg', 'rightFoot', 'leftUpperArm',
      'leftLowerArm', 'leftHand', 'rightUpperArm', 'rightLowerArm', 'rightHand'].map(name => [name, {node: 0}]).concat([['head', {node: 1}]]))},
    expressions: {preset: {
      aa: {morphTargetBinds: [{node: 4, index: 0, weight: 1}]}, blinkLeft: {morphTargetBinds: [{node: 4, index: 1, weight: 1}]}}},
  }}});
