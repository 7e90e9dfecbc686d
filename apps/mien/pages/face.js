// The face of the project (apps/web/avatar), drawn on a canvas of its own and copied to where it is wanted, so that all faces
// of a page are one and the same.

let artist;

function drawFace(ctx, face) {
  const {width, height} = ctx.canvas;
  try {
    artist ??= new Avatar(document.createElement('canvas'));
  } catch (problem) {
    return drawSentence(ctx, problem.message);
  }
  const {canvas} = artist.renderer;
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
  artist.draw(face);
  ctx.clearRect(0, 0, width, height);
  ctx.drawImage(canvas, 0, 0);
}

// Instead of a face, where there can be none.
function drawSentence(ctx, text) {
  const {width, height} = ctx.canvas;
  ctx.clearRect(0, 0, width, height);
  ctx.font = `${width / 24}px system-ui, sans-serif`;
  ctx.textAlign = 'center';
  ctx.fillStyle = getComputedStyle(ctx.canvas).color;
  ctx.fillText(text, width / 2, height / 2, width * 0.95);
}
