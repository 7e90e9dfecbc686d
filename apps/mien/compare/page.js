// Puts the parts together.

document.getElementById('introduction').textContent =
  (document.getElementById('video-data').textContent.trim() ?
    'Two trackers have seen this video; each face is what one of them made of it. ' :
    'Each face is what one of two trackers made of the same video. ') +
  'The order is drawn by lot and stays hidden until you export your votes. ' +
  "The faces are not mirrored: the person's left is on your right.";

const results = new Results(t_ms => player.seek(t_ms));
const study = new Study(() => results.open());
const canvases = ['left', 'right'].map(side => ({side, canvas: document.getElementById(`face-${side}`), shown: ''}));

// A face is drawn when it changes, so that a page at rest costs nothing.
function showFaces(t_ms) {
  for (const place of canvases) {
    const face = faceAt(study.fileOn(place.side), t_ms);
    const state = JSON.stringify(face);
    if (state === place.shown) continue;
    place.shown = state;
    place.canvas.classList.toggle('absent', !face.present);
    drawFace(place.canvas.getContext('2d'), face);
  }
}

const player = new Player(t_ms => {
  showFaces(t_ms);
  results.show(t_ms);
});

// The embedded video, where there is one.
async function openVideo() {
  const blob = await blobOf('video-data', 'video/mp4');
  if (!blob) return;
  const video = document.getElementById('video');
  video.src = URL.createObjectURL(blob);
  document.getElementById('video-figure').hidden = false;
  player.follow(video);
}
openVideo();
