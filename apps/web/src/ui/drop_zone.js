// Files dropped anywhere on the page.

export function takeDrops(note, onFile) {
  let depth = 0;
  const holdsFiles = event => event.dataTransfer?.types.includes('Files');
  const show = change => {
    depth = change === 0 ? 0 : depth + change;
    note.hidden = depth <= 0;
  };
  addEventListener('dragenter', event => { if (holdsFiles(event)) show(1); });
  addEventListener('dragleave', event => { if (holdsFiles(event)) show(-1); });
  addEventListener('dragover', event => { if (holdsFiles(event)) event.preventDefault(); });
  addEventListener('drop', event => {
    event.preventDefault();
    show(0);
    const [file] = event.dataTransfer.files;
    if (file) onFile(file);
  });
}

export const isModel = file => /\.(glb|vrm)$/i.test(file.name);

export function download(name, content, type) {
  const url = URL.createObjectURL(new Blob([content], {type}));
  Object.assign(document.createElement('a'), {href: url, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(url), 60000);
}
