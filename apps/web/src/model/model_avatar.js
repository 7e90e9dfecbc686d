// The user's own head: a GLB or VRM file whose morph targets or expressions have known names.
import {
  AmbientLight, Box3, Color, DirectionalLight, Euler, PerspectiveCamera, Quaternion, Scene, Vector3, WebGLRenderer,
} from 'three';
import {GLTFLoader} from 'three/examples/jsm/loaders/GLTFLoader.js';
import {VRMLoaderPlugin, VRMUtils} from '@pixiv/three-vrm';
import {expressionTargets, morphTargets, move} from '../../../../bindings/js/avatars.js';

const gazeAngle = 0.485;  // radians of a control at 1

// Throws an error with a message for the user if the file is not usable.
export async function openModel(file, canvas) {
  const bytes = await file.arrayBuffer();
  if (new DataView(bytes).byteLength < 20 || new DataView(bytes).getUint32(0, true) !== 0x46546c67) {
    throw new Error(`${file.name}: not a binary glTF file (.glb or .vrm)`);
  }
  const loader = new GLTFLoader();
  loader.register(parser => new VRMLoaderPlugin(parser));
  const gltf = await loader.parseAsync(bytes, '').catch(error => { throw new Error(`${file.name}: ${error.message}`); });
  return new ModelAvatar(gltf, canvas, file.name);
}

class ModelAvatar {
  constructor(gltf, canvas, name) {
    this.vrm = gltf.userData.vrm;
    this.root = this.vrm?.scene ?? gltf.scene;
    this.targets = this.vrm ? expressionTargets(this.vrm.expressionManager) : morphTargets(this.root);
    if (!this.targets.length) throw new Error(`${name}: no morph target or expression has a name of ARKit, VRM, Oculus or Roblox`);
    if (this.vrm?.meta.metaVersion === '0') VRMUtils.rotateVRM0(this.vrm);
    this.findBones();
    this.stage(canvas);
  }

  get vocabularies() { return [...new Set(this.targets.map(({vocabulary}) => vocabulary))]; }

  findBones() {
    const bone = (vrmName, pattern) => {
      let found = this.vrm?.humanoid?.getNormalizedBoneNode(vrmName) ?? null;
      if (!this.vrm) this.root.traverse(node => { if (!found && pattern.test(node.name)) found = node; });
      return found && {node: found, rest: found.quaternion.clone()};
    };
    this.headBone = bone('head', /(^|[^a-z])head$/i);
    this.eyeBones = this.targets.some(({vocabulary}) => vocabulary === 'Roblox') ? [] :
      [[1, bone('leftEye', /^(left_?eye|eye_?l(eft)?)$/i)], [-1, bone('rightEye', /^(right_?eye|eye_?r(ight)?)$/i)]].filter(([, found]) => found);
  }

  stage(canvas) {
    this.renderer = new WebGLRenderer({canvas, antialias: true, alpha: true});
    this.scene = new Scene();
    const key = new DirectionalLight(new Color(1, 0.98, 0.95), 2.2);
    key.position.set(-0.5, 0.8, 1);
    this.scene.add(this.root, key, new AmbientLight(new Color(0.9, 0.95, 1), 1.3));
    this.camera = new PerspectiveCamera(22, 1, 0.01, 1000);
    this.root.updateMatrixWorld(true);
    const {centre, size} = this.headBounds();
    this.camera.position.copy(centre).add(new Vector3(0, 0, size * 3.2));
    this.camera.lookAt(centre);
  }

  // The head alone, if the model has a body.
  headBounds() {
    const box = new Box3().setFromObject(this.root, true), all = box.getSize(new Vector3());
    const bone = this.headBone?.node;
    if (!bone || all.y < 1.6 * Math.max(all.x, all.z)) return {centre: box.getCenter(new Vector3()), size: Math.max(all.x, all.y)};
    const at = bone.getWorldPosition(new Vector3()), height = box.max.y - at.y;
    return {centre: new Vector3(at.x, at.y + height * 0.42, at.z), size: height * 1.5};
  }

  draw({controls, visemes, pitch = 0, yaw = 0, roll = 0}) {
    move(this.targets, {...controls, visemes});
    this.turn(this.headBone, new Euler(pitch, yaw, roll, 'YXZ'));
    for (const [side, bone] of this.eyeBones) this.turn(bone, this.gaze(controls, side > 0 ? 'Left' : 'Right', side));
    this.vrm?.update(0);
    const {width, height} = this.renderer.domElement;
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.renderer.setViewport(0, 0, width, height);
    this.renderer.render(this.scene, this.camera);
  }

  gaze(c, name, side) {
    return new Euler(gazeAngle * (c['eyeLookDown' + name] - c['eyeLookUp' + name]),
                     gazeAngle * side * (c['eyeLookOut' + name] - c['eyeLookIn' + name]), 0, 'YXZ');
  }

  // Rotates a bone around the axes of the model, independently of the bone's own axes.
  turn(bone, euler) {
    if (!bone) return;
    const parent = bone.node.parent.getWorldQuaternion(new Quaternion());
    const turned = new Quaternion().setFromEuler(euler);
    bone.node.quaternion.copy(parent.clone().invert().multiply(turned).multiply(parent).multiply(bone.rest));
  }

  dispose() {
    VRMUtils.deepDispose(this.root);
    this.renderer.dispose();
  }
}
