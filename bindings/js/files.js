// The module and the weights beside this file. Bundlers recognise this form of URL, and copy the files.
import {MienError} from './error.js';

export const urls = {
  module: new URL('./mien.wasm', import.meta.url),
  basenet: new URL('./models/basenet.mien', import.meta.url),
  proposal: new URL('./models/proposal.mien', import.meta.url),
  hifinet: new URL('./models/hifinet.mien', import.meta.url),
  audionet: new URL('./models/audionet.mien', import.meta.url),
};

export const absolute = url => new URL(url, globalThis.document?.baseURI ?? globalThis.location?.href).href;

// The same files in a folder of the caller's.
export function urlsIn(folder) {
  const base = absolute(folder).replace(/\/?$/, '/');
  const names = Object.keys(urls).filter(name => name !== 'module');
  return {module: new URL('mien.wasm', base), ...Object.fromEntries(names.map(name => [name, new URL(`models/${name}.mien`, base)]))};
}

export const node = {};  // node.js sets readFile, because fetch of Node does not read files

// `source`: URL of a file, or a Response with it.
export async function readFile(source) {
  if (node.readFile && String(source).startsWith('file:')) return node.readFile(new URL(source));
  const response = source instanceof Response ? source : await fetch(source);
  if (!response.ok) throw new MienError(`${response.url}: ${response.status} ${response.statusText}`);
  return response.arrayBuffer();
}
