// The user's own head: its names are recognized, and it moves.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {after, before, test} from 'node:test';
import {inflateSync} from 'node:zlib';
import {controlNames} from '../avatar/avatar.js';
import {animationGlb} from '../src/recording/glb.js';
import {morphDrivers} from '../../../bindings/js/matching.js';
import {viewer, viewerFile} from '../viewer.mjs';
import {bodyModel, dracoModel, headModel, ktx2Model, meshoptModel, vrmBodyModel, vrmModel} from './models.mjs';
import {openPage, openStudio, until} from './page.mjs';

const driver = name => morphDrivers([name]).get(name);
const controls = values => ({...Object.fromEntries(controlNames.map(name => [name, 0])), ...values});

test('names are found in any case', () => {
  for (const name of ['jawOpen', 'JawOpen', 'jaw_open', 'Face.jawOpen', 'blendShape1.jawOpen']) {
    assert.equal(driver(name)?.of(controls({jawOpen: 0.5})), 0.5, name);
  }
  for (const name of ['mouthSmileLeft', 'mouthSmile_L', 'MouthSmileLeft']) assert.equal(driver(name).of(controls({mouthSmileLeft: 1})), 1, name);
  assert.equal(driver('mouthSmile_R').of(controls({mouthSmileLeft: 1})), 0);
  assert.equal(driver('hairLength'), undefined);
});

test("every control has a name, and the 47 of Roblox with a counterpart as well", () => {
  for (const name of controlNames) assert.equal(driver(name).vocabulary, 'ARKit');
  const roblox = `ChinRaiserUpperLip ChinRaiser Funneler LowerLipSuck LipPresser LipsTogether MouthLeft MouthRight Pucker UpperLipSuck
    LeftCheekPuff LeftDimpler LeftLipCornerDown LeftLowerLipDepressor LeftLipCornerPuller LeftLipStretcher LeftUpperLipRaiser RightCheekPuff
    RightDimpler RightLipCornerDown RightLowerLipDepressor RightLipCornerPuller RightLipStretcher RightUpperLipRaiser JawDrop JawLeft JawRight
    Corrugator LeftBrowLowerer LeftOuterBrowRaiser LeftNoseWrinkler LeftInnerBrowRaiser RightBrowLowerer RightOuterBrowRaiser
    RightInnerBrowRaiser RightNoseWrinkler EyesLookDown EyesLookLeft EyesLookUp EyesLookRight LeftCheekRaiser LeftEyeUpperLidRaiser
    LeftEyeClosed RightCheekRaiser RightEyeUpperLidRaiser RightEyeClosed TongueOut`.split(/\s+/);
  assert.equal(roblox.length, 47);
  for (const name of roblox) assert.ok(driver(name), name);
  assert.equal(driver('EyesLookLeft').of(controls({eyeLookOutLeft: 1, eyeLookInRight: 1})), 1);
  assert.equal(driver('RightCheekRaiser').of(controls({cheekSquintRight: 0.7})), 0.7);
});

test('reports contain the current viewer', async () => {
  const {text, hash} = await viewer(), stale = 'apps/mien/report/viewer.js.z: not the viewer of apps/web (run node viewer.mjs)';
  assert.ok(inflateSync(readFileSync(`${viewerFile}.z`)).toString() === text, stale);
  assert.equal(readFileSync(`${viewerFile}.sha256`, 'utf8'), hash, stale);
});

let studio;
before(async () => { studio = await openStudio(); });
after(() => studio?.close());

// Morph targets of a dropped head under `face`, and its rotation.
async function moved(bytes, name, face) {
  const {page, context, complaints} = await openPage(studio);
  await page.setInputFiles('#model', {name, mimeType: '', buffer: bytes});
  await until(page, () => document.getElementById('own-face').hidden === false || !document.getElementById('error').hidden, 60);
  assert.equal(await page.textContent('#error p'), '');
  const result = await page.evaluate(controls => {
    const {avatar} = window.page.first;
    avatar.draw({controls, pitch: 0.2, yaw: 0.3});
    let weights;
    avatar.root.traverse(node => { weights ??= node.morphTargetInfluences; });
    const {geometry, material} = avatar.root.getObjectByName('face'), {mipmaps} = material.map ?? {};
    const {node} = avatar.headBone, ahead = avatar.vrm?.meta.metaVersion === '0' ? -1 : 1;
    const looks = node.position.clone().set(0, 0, ahead).applyQuaternion(node.getWorldQuaternion(node.quaternion.clone()));
    return {weights: [...weights], positions: [...geometry.attributes.position.array], pixels: mipmaps && mipmaps[0].data.length,
            status: document.getElementById('status').textContent, looks: looks.toArray()};
  }, controls(face));
  assert.deepEqual(complaints, []);
  await context.close();
  return result;
}

const turns = looks => [Math.sin(0.3) * Math.cos(0.2), -Math.sin(0.2), Math.cos(0.3) * Math.cos(0.2)].forEach(
  (value, i) => assert.ok(Math.abs(looks[i] - value) < 1e-6, `the head looks along ${looks}`));

test('a GLB with names of ARKit moves', async () => {
  const {weights, status, looks} = await moved(headModel(['jawOpen', 'mouthSmile_L', 'unknown']), 'arkit.glb', {jawOpen: 0.6, mouthSmileLeft: 0.25});
  assert.deepEqual(weights, [0.6, 0.25, 0]);
  assert.match(status, /arkit\.glb: 2 names of ARKit/);
  turns(looks);
});

test('a GLB with names behind a prefix that they share moves', async () => {
  const {weights, status} = await moved(headModel(['Head_jawOpen', 'Head_mouthSmile_L', 'Head_cheekPuff', 'Hat_jawOpen']), 'prefix.glb', {jawOpen: 0.5, mouthSmileLeft: 0.25});
  assert.deepEqual(weights, [0.5, 0.25, 0, 0]);
  assert.match(status, /3 names of ARKit/);
});

test('a GLB with names of Roblox moves', async () => {
  const {weights} = await moved(headModel(['JawDrop', 'LeftEyeClosed', 'Pucker']), 'roblox.glb', {jawOpen: 0.5, eyeBlinkLeft: 1, mouthPucker: 0.2});
  assert.deepEqual(weights, [0.5, 1, 0.2]);
});

for (const version of [0, 1]) {
  test(`the expressions of a VRM ${version} move it`, async () => {
    const {weights, status, looks} = await moved(vrmModel(version), 'person.vrm', {jawOpen: 0.5, eyeBlinkLeft: 1});
    assert.deepEqual(weights, [0.5, 1]);
    assert.match(status, /names of VRM/);
    turns(looks);
  });
}

test('a head without known names is rejected with a message', async () => {
  const {page, context} = await openPage(studio);
  await page.setInputFiles('#model', {name: 'mute.glb', mimeType: '', buffer: headModel(['a1', 'a2'])});
  await until(page, () => document.querySelector('#error p').textContent === 'mute.glb: no morph target or expression has a name of ARKit, VRM, Oculus or Roblox');
  await context.close();
});

const triangle = [-0.1, 1.4, 0, 0.1, 1.4, 0, 0, 1.7, 0].map(Math.fround);
for (const [name, make] of [['meshopt', () => meshoptModel(['jawOpen'])], ['Draco', dracoModel]]) {
  test(`a GLB compressed by ${name} moves`, async () => {
    const {weights, positions} = await moved(await make(), `${name}.glb`, {jawOpen: 0.5});
    assert.deepEqual(weights, [0.5]);
    assert.deepEqual(positions, triangle);
  });
}

test('a GLB with a texture in KTX2 moves', async () => {
  const {weights, pixels} = await moved(ktx2Model(), 'ktx2.glb', {jawOpen: 0.5});
  assert.deepEqual(weights, [0.5]);
  assert.ok(pixels >= 8, `${pixels} bytes`);
});

async function openBody(name, buffer) {
  const {page, context, complaints} = await openPage(studio);
  await page.setInputFiles('#model', {name, mimeType: '', buffer});
  await until(page, () => !document.getElementById('own-face').hidden, 60);
  const view = () => page.evaluate(() => {
    const {avatar} = window.page.first, {camera, controls, root} = avatar;
    const at = name => root.getObjectByName(name).getWorldPosition(camera.position.clone());
    return {camera: camera.position.toArray(), target: controls.target.toArray(), arms: ['Left', 'Right'].map(
      side => at(`mixamorig${side}ForeArm`).sub(at(`mixamorig${side}Arm`)).toArray())};
  });
  const {camera, target, arms} = await view();
  assert.ok(target[1] > 1.4 && target[1] < 1.8, `looks at ${target}`);
  assert.ok(camera[2] < 12, `from ${camera}`);  // 6 m wide, the body fits from 19 m only
  for (const [x, y] of arms) assert.ok(y < -0.4 && Math.abs(x) < 0.2, `an arm points to ${x}, ${y}`);
  return {page, context, complaints, view, camera};
}

test('a saved recording is an avatar whose head fills the view and whose eyes turn', async () => {
  const {page, context, complaints} = await openPage(studio);
  await page.setInputFiles('#model', {name: 'mien.glb', mimeType: '', buffer: Buffer.from(animationGlb([], controlNames))});
  await until(page, () => !document.getElementById('own-face').hidden, 60);
  const {corners, weight, eye} = await page.evaluate(controls => {
    const {avatar} = window.page.first, {camera, root} = avatar, face = root.getObjectByName('face');
    avatar.draw({controls});
    const heights = [...face.geometry.attributes.position.array].filter((_, i) => i % 3 === 1), onScreen = y => camera.position.clone().set(0, y, 0).project(camera).y;
    return {eye: root.getObjectByName('leftEye').quaternion.y, corners: [Math.min(...heights), Math.max(...heights)].map(onScreen), weight: face.morphTargetInfluences[face.morphTargetDictionary.jawOpen]};
  }, controls({jawOpen: 0.5, eyeLookOutLeft: 1}));
  assert.equal(weight, 0.5);
  assert.ok(Math.abs(eye - Math.sin(0.485 / 2)) < 1e-6, `${eye}`);
  assert.ok(corners[0] > -1 && corners[1] < 1 && corners[1] - corners[0] > 1.2, `${corners}`);
  assert.deepEqual(complaints, []);
  await context.close();
});

for (const version of [0, 1]) {
  test(`the head of a VRM ${version} with a body is framed, and arms are lowered`, async () => {
    const {context, complaints} = await openBody('body.vrm', vrmBodyModel(version));
    assert.deepEqual(complaints, []);
    await context.close();
  });
}

test('the head of a body is framed, arms are lowered, and the view turns, zooms and resets', async () => {
  const {page, context, complaints, view, camera} = await openBody('body.glb', bodyModel());
  const stage = await page.locator('#face-a').boundingBox(), middle = [stage.x + stage.width / 2, stage.y + stage.height / 2];
  const drag = async () => {
    await page.mouse.move(...middle);
    await page.mouse.down();
    await page.mouse.move(middle[0] + 80, middle[1], {steps: 4});
    await page.mouse.up();
    return (await view()).camera;
  };
  assert.ok((await drag())[0] > camera[0] + 0.2, 'in a mirrored view, the camera goes to the right');
  await page.mouse.dblclick(...middle);
  assert.deepEqual((await view()).camera.map(value => value.toFixed(6)), camera.map(value => value.toFixed(6)));
  await page.uncheck('#mirror');
  assert.ok((await drag())[0] < camera[0] - 0.2, 'otherwise to the left');
  await page.mouse.dblclick(...middle);
  await page.mouse.wheel(0, -300);
  await page.waitForTimeout(200);
  assert.ok((await view()).camera[2] < camera[2], 'the wheel zooms');
  assert.deepEqual(complaints, []);
  await context.close();
});
