// Draws meshes on a canvas with WebGL 2.
import {creaseField, creaseSize} from './creases.js';
import {fragmentShader, vertexShader} from './shaders.js';

// Materials of a mesh: `kind` as in the shaders, colour in shadow, how far light wraps around, gloss, size of
// highlights, and brightness of the rim light. Ordered roughly from front to back, so that hidden pixels are not
// shaded.
const skin = {kind: 3, shadow: [0.70, 0.47, 0.44], wrap: 0.55, gloss: 0.10, shine: 22, edge: 0.16};
const plain = {kind: 3, shadow: [0.50, 0.45, 0.55], wrap: 0.35, gloss: 0, shine: 12, edge: 0.16};
const materials = {
  hair: {...plain, shadow: [0.45, 0.38, 0.42], wrap: 0.3, gloss: 0.22, shine: 16},
  brow: plain,
  dark: {...plain, edge: 0},
  skin: {...skin, kind: 0},
  lid: skin,
  eye: {...plain, kind: 1, shadow: [0.72, 0.68, 0.75], wrap: 0.7},
  cloth: {...plain, shadow: [0.55, 0.55, 0.68], gloss: 0.03},
  neck: skin,
  wet: {...plain, kind: 2, shadow: [0.62, 0.45, 0.48], gloss: 0.35, shine: 50}};
const names = Object.keys(materials);
const attributes = {positions: 3, normals: 3, colors: 3, rest: 3, turning: 1, material: 1};
const uniforms = ['head', 'pivot', 'scale', 'distanceToEye', 'height', 'shades', 'finishes', 'creaseField', 'pupil', 'lids'];
const eyeDistance = 8.5;
const pivot = [0, -0.75, -0.3];
const frame = {centre: -0.09, width: 2.56, height: 3.16};  // the part of the scene that must be visible

function compile(gl, type, source) {
  const shader = gl.createShader(type);
  gl.shaderSource(shader, source);
  gl.compileShader(shader);
  if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) throw new Error(gl.getShaderInfoLog(shader));
  return shader;
}

function link(gl) {
  const program = gl.createProgram();
  gl.attachShader(program, compile(gl, gl.VERTEX_SHADER, vertexShader));
  gl.attachShader(program, compile(gl, gl.FRAGMENT_SHADER, fragmentShader));
  Object.keys(attributes).forEach((name, i) => gl.bindAttribLocation(program, i, name));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) throw new Error(gl.getProgramInfoLog(program));
  return program;
}

const samples = 4;  // per pixel, for smooth edges

// All meshes in one buffer, which is drawn at once. Each mesh writes to its own part.
function join(meshes) {
  const count = meshes.reduce((sum, mesh) => sum + mesh.turning.length, 0), parts = names.map(() => []);
  const joined = Object.fromEntries(Object.entries(attributes).map(([name, components]) => [name, new Float32Array(count * components)]));
  let first = 0;
  for (const mesh of meshes) {
    const end = first + mesh.turning.length, material = names.indexOf(mesh.material);
    parts[material].push(...mesh.indices.map(i => i + first));
    joined.material.fill(material, first, end);
    for (const [name, components] of Object.entries(attributes)) {
      if (name === 'material') continue;
      const part = joined[name].subarray(first * components, end * components);
      part.set(mesh[name]);
      mesh[name] = part;
    }
    first = end;
  }
  return {...joined, indices: Uint16Array.from(parts.flat())};
}

export class Renderer {
  // `moving` meshes change from image to image, `still` ones never.
  constructor(canvas, moving, still) {
    this.canvas = canvas;
    this.mesh = join([...moving, ...still]);
    this.moving = moving.reduce((sum, mesh) => sum + mesh.positions.length, 0);
    const gl = this.gl = canvas.getContext('webgl2', {antialias: false});
    if (!gl) throw new Error('this browser has no WebGL 2, which the face needs; update it, or allow graphics acceleration in its settings');
    canvas.addEventListener('webglcontextlost', event => event.preventDefault());
    canvas.addEventListener('webglcontextrestored', () => this.prepare());
    this.prepare();
  }

  // Creates everything in the graphics card's memory; again after the context was lost.
  prepare() {
    const {gl} = this;
    this.program = link(gl);
    gl.useProgram(this.program);
    this.location = Object.fromEntries(uniforms.map(name => [name, gl.getUniformLocation(this.program, name)]));
    const {left, right, bottom, top} = creaseField;
    gl.uniform4f(this.location.creaseField, left, bottom, 1 / (right - left), 1 / (top - bottom));
    gl.uniform1f(this.location.distanceToEye, eyeDistance);
    gl.uniform1f(this.location.height, frame.centre);
    gl.uniform3fv(this.location.pivot, pivot);
    gl.uniform4fv(this.location.shades, Object.values(materials).flatMap(({shadow, wrap}) => [...shadow, wrap]));
    gl.uniform4fv(this.location.finishes, Object.values(materials).flatMap(({kind, gloss, shine, edge}) => [kind, gloss, shine, edge]));
    this.makeTexture();
    this.loadMesh();
    this.sampled = null;
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.CULL_FACE);
  }

  // The texture of the creases, which is soft enough without mipmaps.
  makeTexture() {
    const {gl} = this;
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RG8, creaseSize, creaseSize);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  }

  loadMesh() {
    const {gl, mesh} = this;
    this.buffers = Object.entries(attributes).map(([name, components], i) => {
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, mesh[name], i < 2 ? gl.DYNAMIC_DRAW : gl.STATIC_DRAW);
      gl.enableVertexAttribArray(i);
      gl.vertexAttribPointer(i, components, gl.FLOAT, false, 0, 0);
      return buffer;
    });
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, mesh.indices, gl.STATIC_DRAW);
  }

  // Uploads the parts that have changed.
  upload() {
    const {gl, mesh: {positions, normals}} = this;
    [positions, normals].forEach((data, i) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[i]);
      gl.bufferSubData(gl.ARRAY_BUFFER, 0, data, 0, this.moving);
    });
  }

  // A framebuffer of the canvas' size with several samples per pixel.
  makeSampled() {
    const {gl, canvas: {width, height}} = this;
    const attach = (attachment, format) => {
      const buffer = gl.createRenderbuffer();
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, format, width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, buffer);
      return buffer;
    };
    const framebuffer = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    const buffers = [attach(gl.COLOR_ATTACHMENT0, gl.RGBA8), attach(gl.DEPTH_ATTACHMENT, gl.DEPTH_COMPONENT24)];
    return {width, height, framebuffer, buffers};
  }

  dropSampled() {
    const {gl, sampled} = this;
    if (!sampled) return;
    gl.deleteFramebuffer(sampled.framebuffer);
    sampled.buffers.forEach(buffer => gl.deleteRenderbuffer(buffer));
    this.sampled = null;
  }

  // `creases`: see Creases; `smooth`: antialiasing.
  draw(scene) {
    const {gl, canvas: {width, height}} = this;
    if (gl.isContextLost()) return;
    if (!scene.smooth || this.sampled?.width !== width || this.sampled.height !== height) this.dropSampled();
    if (scene.smooth) this.sampled ??= this.makeSampled();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.sampled?.framebuffer ?? null);
    this.drawScene(scene);
    if (!this.sampled) return;
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
    gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    gl.invalidateFramebuffer(gl.READ_FRAMEBUFFER, [gl.COLOR_ATTACHMENT0, gl.DEPTH_ATTACHMENT]);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  drawScene({rotation, creases, pupil, lids}) {
    const {gl, canvas, location, mesh} = this;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const unit = Math.min(canvas.width / frame.width, canvas.height / frame.height);
    gl.uniform2f(location.scale, 2 * unit / canvas.width, 2 * unit / canvas.height);
    gl.uniformMatrix3fv(location.head, false, rotation);
    gl.uniform1f(location.pupil, pupil);
    gl.uniform2fv(location.lids, lids);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, creaseSize, creaseSize, gl.RG, gl.UNSIGNED_BYTE, creases);
    this.upload();
    gl.drawElements(gl.TRIANGLES, mesh.indices.length, gl.UNSIGNED_SHORT, 0);
  }
}
