import {Avatar, controlNames} from '../avatar/avatar.js';
import {expressions} from './expressions.js';

const background = '#dfe8ee', ink = '#23303a';
const groups = [/^eyeLook/, /^eye(?!Look)/, /^brow/, /^(cheek|nose)/, /^jaw/, /^(mouth|tongue)/];
const grouped = groups.flatMap(group => controlNames.filter(name => group.test(name)));

// Faces to draw: neutral, each control, expressions.
const faces = () => [{name: 'neutral', controls: {}}, ...grouped.map(name => ({name, controls: {[name]: 1}})), ...expressions];

window.drawSheet = (cell, only, type) => {
  const wanted = faces().filter(({name}) => !only.length || only.includes(name));
  const columns = only.length ? Math.ceil(Math.sqrt(wanted.length)) : 8, height = Math.round(cell * 1.16), line = Math.round(cell * 0.11);
  const face = document.getElementById('face');
  face.width = cell * 2;
  face.height = height * 2;
  const avatar = new Avatar(face);
  const sheet = document.createElement('canvas');
  sheet.width = columns * cell;
  sheet.height = Math.ceil(wanted.length / columns) * (height + line);
  const ctx = sheet.getContext('2d');
  ctx.fillStyle = background;
  ctx.fillRect(0, 0, sheet.width, sheet.height);
  ctx.fillStyle = ink;
  ctx.font = `600 ${Math.round(line * 0.66)}px sans-serif`;
  ctx.textAlign = 'center';
  ctx.imageSmoothingQuality = 'high';
  wanted.forEach((one, i) => {
    const x = i % columns * cell, y = Math.floor(i / columns) * (height + line);
    avatar.draw(one);
    ctx.drawImage(face, x, y, cell, height);
    ctx.fillText(one.name, x + cell / 2, y + height + line * 0.72);
  });
  return sheet.toDataURL(type, 0.88);
};
