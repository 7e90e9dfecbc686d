// Downloads of all exports, unpacked on demand.

const sizeText = bytes => (bytes >= 1e6 ? `${(bytes / 1e6).toFixed(1)}\u00a0MB` : `${Math.max(1, Math.round(bytes / 1e3))}\u00a0kB`);

function save(bytes, file) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob([bytes], {type: 'application/octet-stream'}));
  link.download = file;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

function base64Of(bytes) {
  const part = 3 << 13;
  let text = '';
  for (let from = 0; from < bytes.length; from += part) text += btoa(String.fromCharCode(...bytes.subarray(from, from + part)));
  return text;
}

// The text form of a GLB that the program wrote, so that the page holds the avatar once.
function gltfOf(glb) {
  const length = new DataView(glb).getUint32(12, true), json = new TextDecoder().decode(new Uint8Array(glb, 20, length));
  return json.replace(/\}\]\} *$/, `,"uri":"data:application/octet-stream;base64,${base64Of(new Uint8Array(glb, 28 + length))}"}]}\n`);
}

async function fileOf(format) {
  return await inflated(`export-${format}`) ?? gltfOf(await inflated('export-glb'));
}

function showDownloads() {
  document.getElementById('downloads').append(...data.exports.map(({format, file, holds, bytes}) => {
    const item = document.createElement('li'), button = Object.assign(document.createElement('button'), {type: 'button', textContent: format});
    button.dataset.format = format;
    button.addEventListener('click', async () => save(await fileOf(format), file));
    item.append(button, Object.assign(document.createElement('span'), {textContent: `${holds} · ${sizeText(bytes)}`}));
    return item;
  }));
}
