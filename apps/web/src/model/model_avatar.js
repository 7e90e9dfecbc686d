// The user's own head: a GLB or VRM file whose morph targets or expressions have known names.
import {
  AmbientLight, Box3, Color, DirectionalLight, Euler, PerspectiveCamera, Quaternion, Scene, Vector3, WebGLRenderer,
} from 'three';
import {OrbitControls} from 'three/examples/jsm/controls/OrbitControls.js';
import {VRMUtils} from '@pixiv/three-vrm';
import {expressionTargets, morphTargets, move} from '../../../../bindings/js/avatars.js';
import {loadModel} from './loader.js';

const gazeAngle = 0.485;  // radians of a control at 1
// Bones by their names in VRM, and patterns of the letters of other names: of Mixamo, Ready Player Me, VRoid, Unreal and Blender.
const boneNames = {
  head: /(?<!fore)head$/, leftEye: /(lefteye|eyeleft|eyel|l(face)?eye)$/, rightEye: /(righteye|eyeright|eyer|r(face)?eye)$/,
  leftUpperArm: /(left(upper)?arm|upperarml(eft)?|lupperarm)$/, rightUpperArm: /(right(upper)?arm|upperarmr(ight)?|rupperarm)$/};

// Throws an error with a message for the user if the file is not usable.
export async function openModel(file, canvas, makeDecoders) {
  const bytes = await file.arrayBuffer();
  if (new DataView(bytes).byteLength < 20 || new DataView(bytes).getUint32(0, true) !== 0x46546c67) {
    throw new Error(`${file.name}: not a binary glTF file (.glb or .vrm)`);
  }
  const renderer = new WebGLRenderer({canvas, antialias: true, alpha: true});
  try {
    const gltf = await loadModel(bytes, renderer, makeDecoders).catch(error => { throw new Error(`${file.name}: ${error.message}`); });
    return new ModelAvatar(gltf, renderer, file.name);
  } catch (error) {
    renderer.dispose();
    throw error;
  }
}

const rotation = (pitch, yaw, roll) => new Quaternion().setFromEuler(new Euler(pitch, yaw, roll, 'YXZ'));

// An eyeball that can turn in its place.
function isAroundOrigin({geometry, isSkinnedMesh}) {
  if (isSkinnedMesh) return false;
  geometry.computeBoundingSphere();
  return geometry.boundingSphere.containsPoint(new Vector3());
}

class ModelAvatar {
  constructor(gltf, renderer, name) {
    this.vrm = gltf.userData.vrm;
    this.root = this.vrm?.scene ?? gltf.scene;
    this.targets = this.vrm ? expressionTargets(this.vrm.expressionManager) : morphTargets(this.root);
    if (!this.targets.length) throw new Error(`${name}: no morph target or expression has a name of ARKit, VRM, Oculus or Roblox`);
    if (this.vrm?.meta.metaVersion === '0') VRMUtils.rotateVRM0(this.vrm);
    this.renderer = renderer;
    this.findBones();
    this.stage(renderer.domElement);
  }

  get vocabularies() { return [...new Set(this.targets.map(({vocabulary}) => vocabulary))]; }

  bone(name) {
    let found = this.vrm?.humanoid?.getNormalizedBoneNode(name) ?? null, best = 0;
    const rank = node => (!node.isMesh ? 2 : name.endsWith('Eye') && isAroundOrigin(node) ? 1 : 0);
    const matches = node => boneNames[name].test(node.name.replace(/[^a-z]/gi, '').toLowerCase());
    if (!this.vrm) {
      this.root.traverse(node => {
        if (rank(node) > best && matches(node)) [found, best] = [node, rank(node)];
      });
    }
    return found && {node: found, rest: found.quaternion.clone()};
  }

  findBones() {
    this.headBone = this.bone('head');
    const moves = this.targets.every(({vocabulary}) => vocabulary !== 'Roblox');
    this.eyeBones = moves ? [[1, this.bone('leftEye')], [-1, this.bone('rightEye')]].filter(([, found]) => found) : [];
  }

  // Lowers arms that point sideways, as in a T-pose.
  lowerArms() {
    this.root.updateMatrixWorld(true);
    for (const name of ['leftUpperArm', 'rightUpperArm']) {
      const arm = this.bone(name), elbow = arm?.node.children.find(child => child.position.lengthSq() > 0);
      if (!elbow) continue;
      const along = elbow.getWorldPosition(new Vector3()).sub(arm.node.getWorldPosition(new Vector3())).normalize();
      if (along.y > -0.5) this.turn(arm, new Quaternion().setFromUnitVectors(along, new Vector3(0.2 * Math.sign(along.x), -1, 0).normalize()));
    }
    this.vrm?.update(0);
    this.root.updateMatrixWorld(true);
  }

  stage(canvas) {
    this.scene = new Scene();
    const key = new DirectionalLight(new Color(1, 0.98, 0.95), 2.2);
    key.position.set(-0.5, 0.8, 1);
    this.scene.add(this.root, key, new AmbientLight(new Color(0.9, 0.95, 1), 1.3));
    this.camera = new PerspectiveCamera(22, 1, 0.01, 1000);
    this.lowerArms();
    const {centre, size} = this.headBounds();
    this.camera.position.copy(centre).add(new Vector3(0, 0, size * 3.2));
    this.addControls(canvas, centre, size);
  }

  // Dragging turns the view, a wheel or two fingers zoom, a double click resets.
  addControls(canvas, centre, size) {
    canvas.title = 'Drag to turn, scroll to zoom, double-click to reset';
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.target.copy(centre);
    Object.assign(this.controls, {enablePan: false, minDistance: size, maxDistance: size * 12});
    this.controls.update();
    this.controls.saveState();
    const rotate = this.controls._rotateLeft.bind(this.controls);  // a mirrored view turns the other way
    this.controls._rotateLeft = angle => rotate(canvas.closest('.mirrored') ? -angle : angle);
    this.controls.addEventListener('change', () => this.onChange?.());
    canvas.addEventListener('dblclick', () => this.resetView());
  }

  // The head alone, if the model has a body below it: the nodes on its bone if they have a face, or else everything above the bone.
  headBounds() {
    const boxOf = node => new Box3().setFromObject(node, true), whole = box => {
      const {x, y} = box.getSize(new Vector3());
      return {centre: box.getCenter(new Vector3()), size: Math.max(x, y)};
    };
    let hasFace = false;
    this.headBone?.node.traverse(({morphTargetInfluences}) => { hasFace ||= Boolean(morphTargetInfluences); });
    if (hasFace) return whole(boxOf(this.headBone.node));
    const box = boxOf(this.root), at = this.headBone?.node.getWorldPosition(new Vector3()), height = box.max.y - (at?.y ?? 0);
    if (!at || height <= 0 || at.y - box.min.y < 0.6 * height) return whole(box);
    return {centre: new Vector3(at.x, at.y + height * 0.42, at.z), size: height * 1.5};
  }

  draw({controls, visemes, pitch = 0, yaw = 0, roll = 0}) {
    move(this.targets, {...controls, visemes});
    this.turn(this.headBone, rotation(pitch, yaw, roll));
    for (const [side, bone] of this.eyeBones) this.turn(bone, this.gaze(controls, side > 0 ? 'Left' : 'Right', side));
    this.vrm?.update(0);
    const {width, height} = this.renderer.domElement;
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.renderer.setViewport(0, 0, width, height);
    this.renderer.render(this.scene, this.camera);
  }

  gaze(c, name, side) {
    return rotation(gazeAngle * (c['eyeLookDown' + name] - c['eyeLookUp' + name]),
                     gazeAngle * side * (c['eyeLookOut' + name] - c['eyeLookIn' + name]), 0);
  }

  // Rotates a bone around the axes of the model, independently of the bone's own axes.
  turn(bone, turned) {
    if (!bone) return;
    const parent = bone.node.parent.getWorldQuaternion(new Quaternion());
    bone.node.quaternion.copy(parent.clone().invert().multiply(turned).multiply(parent).multiply(bone.rest));
  }

  resetView() { this.controls.reset(); }

  dispose() {
    this.controls.dispose();
    VRMUtils.deepDispose(this.root);
    this.renderer.dispose();
  }
}
