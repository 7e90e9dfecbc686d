// What the program put into the page. `data` has `start_ms` and `end_ms`, the time that the page plays.

const mix = (a, b, t) => a + (b - a) * t;
const data = JSON.parse(document.getElementById('data').textContent);

// The bytes of a block of base64, in parts: a page must not stand still for long. Nothing where there is no such block, or an empty one.
async function packedBytes(id) {
  const base64 = document.getElementById(id)?.textContent.trim();
  if (!base64) return null;
  const part = 1 << 20, bytes = new Uint8Array(base64.length / 4 * 3 - (base64.match(/=*$/)[0].length));
  for (let from = 0, at = 0; from < base64.length; from += part) {
    const text = atob(base64.slice(from, from + part));
    for (let i = 0; i < text.length; ++i) bytes[at++] = text.charCodeAt(i);
    if (from + part < base64.length) await new Promise(done => setTimeout(done));
  }
  return bytes;
}
