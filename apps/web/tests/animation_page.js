import {Avatar} from '../avatar/avatar.js';

const face = document.getElementById('face'), small = document.createElement('canvas');
const avatar = new Avatar(face);

// Draws the face at twice the size and scales it down, for smooth edges.
window.drawFrame = (frame, width, height) => {
  face.width = width * 2;
  face.height = height * 2;
  avatar.draw(frame);
  small.width = width;
  small.height = height;
  const ctx = small.getContext('2d');
  ctx.fillStyle = '#dfe8ee';
  ctx.fillRect(0, 0, width, height);
  ctx.imageSmoothingQuality = 'high';
  ctx.drawImage(face, 0, 0, width, height);
  return small.toDataURL('image/png');
};
