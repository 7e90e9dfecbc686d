// How to look things up in what the program put into the page.

// Index of the last frame that has begun by `t_ms`; -1 before the first.
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

// A face to draw. Nothing is interpolated or smoothed: each frame stands until the next one, as in
// the video. What a file does not drive rests at 0.
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
