// A binary glTF file: a JSON document and one buffer.

const componentTypes = new Map([[Uint8Array, 5121], [Uint16Array, 5123], [Uint32Array, 5125], [Float32Array, 5126]]);
const components = {SCALAR: 1, VEC3: 3, VEC4: 4};
export const targets = {vertices: 34962, indices: 34963};  // of buffer views

function bounds(data, count) {
  const min = new Array(count).fill(Infinity), max = new Array(count).fill(-Infinity);
  data.forEach((value, i) => {
    min[i % count] = Math.min(min[i % count], value);
    max[i % count] = Math.max(max[i % count], value);
  });
  return {min, max};
}

export class GlbFile {
  constructor() { Object.assign(this, {parts: [], bytes: 0, views: [], accessors: []}); }

  view(data, target) {
    this.views.push({buffer: 0, byteOffset: this.bytes, byteLength: data.byteLength, ...(target && {target})});
    this.parts.push({data, at: this.bytes});
    this.bytes += data.byteLength + 3 & ~3;
    return this.views.length - 1;
  }

  // `data`: a typed array. Returns the accessor.
  add(data, type, {bounded = false, target, normalized} = {}) {
    return this.accessor(data, type, {bufferView: this.view(data, target), ...(normalized && {normalized}), ...(bounded && bounds(data, components[type]))});
  }

  // Stores only the vectors that are not 0.
  addSparse(data) {
    const moved = Uint16Array.from(Array(data.length / 3).keys()).filter(i => data[i * 3] || data[i * 3 + 1] || data[i * 3 + 2]);
    const values = Float32Array.from([...moved].flatMap(i => [...data.subarray(i * 3, i * 3 + 3)]));
    const sparse = moved.length && {
      count: moved.length, indices: {bufferView: this.view(moved), componentType: componentTypes.get(Uint16Array)}, values: {bufferView: this.view(values)}};
    return this.accessor(data, 'VEC3', {...bounds(data, 3), ...(sparse && {sparse})});
  }

  accessor(data, type, more) {
    this.accessors.push({componentType: componentTypes.get(data.constructor), type, count: data.length / components[type], ...more});
    return this.accessors.length - 1;
  }

  // The file: JSON chunk and binary chunk, each padded to four bytes.
  finish(document) {
    const json = JSON.stringify({...document, accessors: this.accessors, bufferViews: this.views, buffers: [{byteLength: this.bytes}]});
    const text = new TextEncoder().encode(json), textBytes = text.length + 3 & ~3, first = 28 + textBytes;
    const file = new Uint8Array(first + this.bytes), view = new DataView(file.buffer);
    [0x46546c67, 2, file.length, textBytes, 0x4e4f534a].forEach((value, i) => view.setUint32(i * 4, value, true));
    file.fill(0x20, 20, first - 8);
    file.set(text, 20);
    view.setUint32(first - 8, this.bytes, true);
    view.setUint32(first - 4, 0x004e4942, true);
    for (const {data, at} of this.parts) file.set(new Uint8Array(data.buffer, data.byteOffset, data.byteLength), first + at);
    return file;
  }
}
