// Connects the parts of the page.

document.getElementById('introduction').textContent =
  (document.getElementById('video-data').textContent.trim() ?
    'Two trackers processed this video; each face shows the output of one of them. ' :
    'Each face shows the output of one of two trackers on the same video. ') +
  'The order is random and stays hidden until you export your votes. ' +
  "The faces are not mirrored: the person's left is on your right.";

const results = new Results(t_ms => player.seek(t_ms));
const study = new Study(() => results.open());
const canvases = ['left', 'right'].map(side => ({side, canvas: document.getElementById(`face-${side}`), shown: ''}));

// Draws a face only when it changes, so that an idle page uses no CPU.
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

// The embedded video, if there is one.
async function openVideo() {
  const blob = await blobOf('video-data', 'video/mp4');
  if (!blob) return;
  const video = document.getElementById('video');
  video.src = URL.createObjectURL(blob);
  document.getElementById('video-figure').hidden = false;
  player.follow(video);
}
openVideo();
