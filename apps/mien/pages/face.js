// Draws the avatar (apps/web/avatar). One hidden canvas renders it for all faces of a page.

let avatar;

function drawFace(ctx, face) {
  const {width, height} = ctx.canvas;
  try {
    avatar ??= new Avatar(document.createElement('canvas'));
  } catch (problem) {
    return drawSentence(ctx, problem.message);
  }
  const {canvas} = avatar.renderer;
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
  avatar.draw(face);
  ctx.clearRect(0, 0, width, height);
  ctx.drawImage(canvas, 0, 0);
}

// Shows an error message instead of a face.
function drawSentence(ctx, text) {
  const {width, height} = ctx.canvas;
  ctx.clearRect(0, 0, width, height);
  ctx.font = `${width / 24}px system-ui, sans-serif`;
  ctx.textAlign = 'center';
  ctx.fillStyle = getComputedStyle(ctx.canvas).color;
  ctx.fillText(text, width / 2, height / 2, width * 0.95);
}
