// The data that the program embeds in the page. `data.start_ms` and `data.end_ms` are the time
// range that the page plays.

const mix = (a, b, t) => a + (b - a) * t;
const data = JSON.parse(document.getElementById('data').textContent);

const blockText = id => document.getElementById(id)?.textContent.trim();

function bytesOf(base64) {
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

// Decodes a large block of base64 to a Blob, in parts to keep the page responsive. Returns null if
// the block is absent or empty.
async function blobOf(id, type) {
  const base64 = blockText(id), part = 1 << 20, parts = [];
  if (!base64) return null;
  for (let from = 0; from < base64.length; from += part) {
    parts.push(bytesOf(base64.slice(from, from + part)));
    if (from + part < base64.length) await new Promise(done => setTimeout(done));
  }
  return new Blob(parts, {type});
}
