// Downloads of all exports, unpacked on demand.

const sizeText = bytes => (bytes >= 1e6 ? `${(bytes / 1e6).toFixed(1)}\u00a0MB` : `${Math.max(1, Math.round(bytes / 1e3))}\u00a0kB`);

function save(bytes, file) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob([bytes], {type: 'application/octet-stream'}));
  link.download = file;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

function showDownloads() {
  document.getElementById('downloads').append(...data.exports.map(({format, file, holds, bytes}) => {
    const item = document.createElement('li'), button = Object.assign(document.createElement('button'), {type: 'button', textContent: format});
    button.dataset.format = format;
    button.addEventListener('click', async () => save(await inflated(`export-${format}`), file));
    item.append(button, Object.assign(document.createElement('span'), {textContent: `${holds} · ${sizeText(bytes)}`}));
    return item;
  }));
}
