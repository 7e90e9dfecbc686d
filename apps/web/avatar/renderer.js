// Draws meshes on a canvas with WebGL 2.
import {creaseField, paintCreases} from './creases.js';
import {fragmentShader, vertexShader} from './shaders.js';

const materials = {skin: 0, lid: 1, eye: 2, hair: 3, wet: 4, dark: 5, cloth: 6, neck: 7, brow: 8};
const attributes = {position: 3, normal: 3, color: 3, rest: 3, turning: 1};
const eyeDistance = 8.5;
const pivot = [0, -0.75, -0.3];
const frame = {centre: -0.09, width: 2.56, height: 3.16};  // what must be seen of the scene

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

export class Renderer {
  constructor(canvas, meshes) {
    this.canvas = canvas;
    this.meshes = meshes;
    const gl = this.gl = canvas.getContext('webgl2', {antialias: true, alpha: true, premultipliedAlpha: true});
    if (!gl) throw new Error('this browser has no WebGL 2, which the face needs');
    canvas.addEventListener('webglcontextlost', event => event.preventDefault());
    canvas.addEventListener('webglcontextrestored', () => this.prepare());
    this.prepare();
  }

  // Everything that lies in the graphics card; again after it was lost.
  prepare() {
    const {gl} = this;
    this.program = link(gl);
    gl.useProgram(this.program);
    this.location = Object.fromEntries(['head', 'pivot', 'scale', 'distanceToEye', 'height', 'material', 'creaseField',
      'leftDepths', 'rightDepths', 'pupil'].map(name => [name, gl.getUniformLocation(this.program, name)]));
    const {left, right, bottom, top} = creaseField;
    gl.uniform4f(this.location.creaseField, left, bottom, 1 / (right - left), 1 / (top - bottom));
    gl.uniform1f(this.location.distanceToEye, eyeDistance);
    gl.uniform1f(this.location.height, frame.centre);
    gl.uniform3fv(this.location.pivot, pivot);
    paintCreases().forEach((texture, i) => this.loadTexture(texture, i));
    this.buffers = this.meshes.map(mesh => this.loadMesh(mesh));
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.CULL_FACE);
  }

  loadTexture({size, data}, unit) {
    const {gl} = this;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, size, size, 0, gl.RGBA, gl.UNSIGNED_BYTE, data);
    gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    gl.uniform1i(gl.getUniformLocation(this.program, `creases${unit}`), unit);
  }

  loadMesh(mesh) {
    const {gl} = this, array = gl.createVertexArray(), buffers = {};
    gl.bindVertexArray(array);
    const data = {position: mesh.positions, normal: mesh.normals, color: mesh.colors, rest: mesh.rest, turning: mesh.turning};
    Object.entries(attributes).forEach(([name, components], i) => {
      buffers[name] = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffers[name]);
      gl.bufferData(gl.ARRAY_BUFFER, data[name], name === 'position' || name === 'normal' ? gl.DYNAMIC_DRAW : gl.STATIC_DRAW);
      gl.enableVertexAttribArray(i);
      gl.vertexAttribPointer(i, components, gl.FLOAT, false, 0, 0);
    });
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, mesh.indices, gl.STATIC_DRAW);
    return {array, buffers};
  }

  // `moved`: the meshes whose positions have changed.
  draw({rotation, creases, pupil, moved}) {
    const {gl, canvas, location} = this;
    if (gl.isContextLost()) return;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const unit = Math.min(canvas.width / frame.width, canvas.height / frame.height);
    gl.uniform2f(location.scale, 2 * unit / canvas.width, 2 * unit / canvas.height);
    gl.uniformMatrix3fv(location.head, false, rotation);
    gl.uniform4fv(location.leftDepths, creases.left);
    gl.uniform4fv(location.rightDepths, creases.right);
    gl.uniform3fv(location.pupil, pupil);
    this.meshes.forEach((mesh, i) => {
      const {array, buffers} = this.buffers[i];
      gl.bindVertexArray(array);
      if (moved.has(mesh)) {
        gl.bindBuffer(gl.ARRAY_BUFFER, buffers.position);
        gl.bufferSubData(gl.ARRAY_BUFFER, 0, mesh.positions);
        gl.bindBuffer(gl.ARRAY_BUFFER, buffers.normal);
        gl.bufferSubData(gl.ARRAY_BUFFER, 0, mesh.normals);
      }
      gl.uniform1i(location.material, materials[mesh.material]);
      gl.drawElements(gl.TRIANGLES, mesh.indices.length, gl.UNSIGNED_SHORT, 0);
    });
  }
}
