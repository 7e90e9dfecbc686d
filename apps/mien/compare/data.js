// Access to the data that the program embeds in the page.

// The index of the last frame at or before `t_ms`; -1 before the first.
function frameIndex(file, t_ms) {
  const rounding_ms = 0.5;
  let low = 0, high = file.t_ms.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (file.t_ms[middle] <= t_ms + rounding_ms) low = middle + 1; else high = middle;
  }
  return low - 1;
}

const neutralFace = () => ({
  controls: Object.fromEntries(data.controls.map(name => [name, 0])),
  pitch: 0, yaw: 0, roll: 0, present: true,
});

// The face to draw at a time. Frames are held until the next one and not smoothed, as in a video.
// Controls that a file does not have are 0.
function faceAt(file, t_ms) {
  const face = neutralFace();
  const i = frameIndex(file, t_ms);
  if (i < 0) return {...face, present: false};
  data.controls.forEach((name, k) => { face.controls[name] = file.controls[k]?.[i] ?? 0; });
  for (const angle of ['pitch', 'yaw', 'roll']) face[angle] = file[angle][i] ?? 0;
  face.present = !hasHead(file) || file.pitch[i] !== null;
  return face;
}

const hasHead = file => file.pitch.some(angle => angle !== null);

const drives = (file, name) => file.controls[data.controls.indexOf(name)] !== null;
