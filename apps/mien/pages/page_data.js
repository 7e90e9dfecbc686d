// What the program put into the page. `data` has `start_ms` and `end_ms`, the time that the page plays.

const mix = (a, b, t) => a + (b - a) * t;
const data = JSON.parse(document.getElementById('data').textContent);

const blockText = id => document.getElementById(id)?.textContent.trim();

function bytesOf(base64) {
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

// What a large block of base64 holds, as a Blob, read in parts: a page must not stand still for long. Nothing where there is no such
// block, or an empty one.
async function blobOf(id, type) {
  const base64 = blockText(id), part = 1 << 20, parts = [];
  if (!base64) return null;
  for (let from = 0; from < base64.length; from += part) {
    parts.push(bytesOf(base64.slice(from, from + part)));
    if (from + part < base64.length) await new Promise(done => setTimeout(done));
  }
  return new Blob(parts, {type});
}
