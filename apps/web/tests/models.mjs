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
export function headModel(targetNames, extensions, {nodes = [], roots = [], head = [0, 0, 0], pack = (_, binary) => binary} = {}) {
  const positions = Float32Array.from([-0.1, 1.4, 0, 0.1, 1.4, 0, 0, 1.7, 0]), offset = new Float32Array(9).fill(0.05);
  const view = (byteOffset, byteLength) => ({buffer: 0, byteOffset, byteLength});
  const accessor = (bufferView, min, max) => ({bufferView, componentType: 5126, count: 3, type: 'VEC3', min, max});
  const json = {
    asset: {version: '2.0'}, scene: 0, scenes: [{nodes: [0]}],
    nodes: [{name: 'root', children: [1, ...roots]}, {name: 'Head', children: [2, 3, 4], translation: head}, {name: 'LeftEye'}, {name: 'RightEye'},
            {name: 'face', mesh: 0, translation: head.map(value => -value)}, ...nodes],
    meshes: [{primitives: [{attributes: {POSITION: 0}, targets: targetNames.map(() => ({POSITION: 1}))}], weights: targetNames.map(() => 0), extras: {targetNames}}],
    buffers: [{byteLength: 72}], bufferViews: [view(0, 36), view(36, 36)],
    accessors: [accessor(0, [-0.1, 1.4, 0], [0.1, 1.7, 0]), accessor(1, [0.05, 0.05, 0.05], [0.05, 0.05, 0.05])], ...extensions};
  const binary = new Uint8Array(Float32Array.from([...positions, ...offset]).buffer);
  return glb(json, pack(json, binary));
}

// The same on a body whose arms point sideways, with Mixamo's names, in a mesh of its own that reaches 3 m to each side.
const body = {roots: [5, 7, 9], head: [0, 1.4, 0], nodes: [
  {name: 'mixamorig:LeftArm', translation: [0.2, 1.3, 0], children: [6]}, {name: 'mixamorig:LeftForeArm', translation: [0.5, 0, 0]},
  {name: 'mixamorig:RightArm', translation: [-0.2, 1.3, 0], children: [8]}, {name: 'mixamorig:RightForeArm', translation: [-0.5, 0, 0]},
  {name: 'body', mesh: 0, translation: [0, -1.4, 0], scale: [30, 0.8, 1]}]};
export const bodyModel = () => headModel(['jawOpen'], {}, body);

// The head with the positions of its mesh compressed by meshopt.
export async function meshoptModel(targetNames) {
  const {MeshoptEncoder} = await import('meshoptimizer');
  await MeshoptEncoder.ready;
  return headModel(targetNames, {}, {pack(json, binary) {
    const packed = MeshoptEncoder.encodeGltfBuffer(binary.subarray(0, 36), 3, 12, 'ATTRIBUTES');
    json.buffers.push({byteLength: 36, extensions: {EXT_meshopt_compression: {fallback: true}}});
    json.buffers[0].byteLength = 72 + packed.length;
    json.bufferViews[0] = {buffer: 1, byteLength: 36, extensions: {EXT_meshopt_compression: {
      buffer: 0, byteOffset: 72, byteLength: packed.length, byteStride: 12, count: 3, mode: 'ATTRIBUTES'}}};
    json.extensionsUsed = json.extensionsRequired = ['EXT_meshopt_compression'];
    return Buffer.concat([binary.fill(0, 0, 36), packed]);
  }});
}

// The same with bytes of another encoder behind its binary data. `refer` adds what refers to bufferView 2.
const packedModel = (extension, bytes, refer) => headModel(['jawOpen'], {}, {pack(json, binary) {
  json.extensionsUsed = json.extensionsRequired = [extension];
  json.bufferViews.push({buffer: 0, byteOffset: 72, byteLength: bytes.length});
  json.buffers[0].byteLength = 72 + bytes.length;
  refer(json);
  return Buffer.concat([binary, bytes]);
}});

// The positions of the triangle, compressed by Google's encoder.
export const dracoModel = () => packedModel('KHR_draco_mesh_compression',
  Buffer.from('RFJBQ08CAgEAAAABAwEAAQIBAQAJAwAAAM3MzL0zM7M/AAAAAM3MzD0zM7M/AAAAAAAAAACamdk/AAAAAA==', 'base64'), json => {
    json.accessors.push({componentType: 5125, count: 3, type: 'SCALAR'});
    delete json.accessors[0].bufferView;
    Object.assign(json.meshes[0].primitives[0], {indices: 2, extensions: {KHR_draco_mesh_compression: {bufferView: 2, attributes: {POSITION: 0}}}});
  });

// A texture of 4 x 4 green pixels in UASTC.
export const ktx2Model = () => packedModel('KHR_texture_basisu', Buffer.from(
  'q0tUWCAyMLsNChoKAAAAAAEAAAAEAAAABAAAAAAAAAAAAAAAAQAAAAEAAAAAAAAAaAAAACwAAACUAAAALAAAAAAAAAAAAAAAAAAAAAAAAADAAAAAAAAAABAAAAAAAAAAEAAAAAAAAAAsAAAAAAAAAAIA' +
  'KACmAQIAAwMAABAAAAAAAAAAAAB/AAAAAAAAAAAA/////x8AAABLVFh3cml0ZXIAQmFzaXMgVW5pdmVyc2FsIDIuNTAAAAQAAAB/fwAAFwAZ4P8DHgAAAAAAAAAAAA==', 'base64'), json => {
  json.images = [{bufferView: 2, mimeType: 'image/ktx2'}];
  json.textures = [{extensions: {KHR_texture_basisu: {source: 0}}}];
  json.materials = [{pbrMetallicRoughness: {baseColorTexture: {index: 0}}}];
  json.meshes[0].primitives[0].material = 0;
});

// VRM whose presets `aa` and `blinkLeft` each move a target, and other expressions by `names` the further ones.
const trunk = ['hips', 'spine', 'leftUpperLeg', 'leftLowerLeg', 'leftFoot', 'rightUpperLeg', 'rightLowerLeg', 'rightFoot', 'leftUpperArm',
               'leftLowerArm', 'leftHand', 'rightUpperArm', 'rightLowerArm', 'rightHand'];
const bonesOf = bones => Object.entries({...Object.fromEntries(trunk.map(name => [name, 0])), head: 1, ...bones});
const vrm1 = (names, bones) => {
  const bind = index => ({morphTargetBinds: [{node: 4, index, weight: 1}]});
  return {extensionsUsed: ['VRMC_vrm'], extensions: {VRMC_vrm: {
    specVersion: '1.0',
    meta: {name: 'test', version: '1', authors: ['mien'], licenseUrl: 'https://vrm.dev/licenses/1.0/'},
    humanoid: {humanBones: Object.fromEntries(bonesOf(bones).map(([name, node]) => [name, {node}]))},
    expressions: {preset: {aa: bind(0), blinkLeft: bind(1)}, custom: Object.fromEntries(names.map((name, i) => [name, bind(2 + i)]))}}}};
};
const vrm0 = (names, bones) => {
  const group = (name, presetName, index) => ({name, presetName, binds: [{mesh: 0, index, weight: 100}]});
  return {extensionsUsed: ['VRM'], extensions: {VRM: {
    specVersion: '0.0', meta: {title: 'test', version: '1', author: 'mien', licenseName: 'CC0'},
    humanoid: {humanBones: bonesOf(bones).map(([bone, node]) => ({bone, node}))},
    blendShapeMaster: {blendShapeGroups: [group('A', 'a', 0), group('Blink_L', 'blink_l', 1), ...names.map((name, i) => group(name, 'unknown', 2 + i))]}}}};
};
export const vrmModel = (version, names = [], bones = {}, more = {}) =>
  headModel(['open', 'shut', ...names], {0: vrm0, 1: vrm1}[version](names, bones), more);
// The left is on the other side where the model looks along -z.
export const vrmBodyModel = version => vrmModel(version, [], version === 1 ?
  {leftUpperArm: 5, leftLowerArm: 6, rightUpperArm: 7, rightLowerArm: 8} : {leftUpperArm: 7, leftLowerArm: 8, rightUpperArm: 5, rightLowerArm: 6}, body);
