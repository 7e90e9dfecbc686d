// The clip with landmarks, box and head axes drawn over it.

const pointColor = '#50ff78', boxColor = '#ffc83c', axisColors = ['#ff5050', '#50ff50', '#5a8cff'];

// Directions of the head's axes in the image, x to the right and y up: right-handed, R = Ry(yaw)
// Rx(pitch) Rz(roll).
function headAxes(pitch, yaw, roll) {
  const [cp, sp, cy, sy, cr, sr] = [pitch, yaw, roll].flatMap(angle => [Math.cos(angle), Math.sin(angle)]);
  return [[cy * cr + sy * sp * sr, cp * sr], [sy * sp * cr - cy * sr, cp * cr], [sy * cp, -sp]];
}

class Clip {
  constructor(take) {
    this.take = take;
    this.video = document.getElementById('video');
    this.canvas = document.getElementById('overlay');
    this.choice = document.getElementById('with-overlay');
    this.hasPicture = data.width > 0;
    document.getElementById('clip-figure').hidden = !this.hasPicture;
    document.getElementById('overlay-choice').hidden = !this.hasPicture;
    const stage = document.getElementById('stage');
    stage.style.setProperty('--aspect', this.hasPicture ? data.width / data.height : 0);
    stage.classList.toggle('upright', data.height > data.width);
    this.choice.addEventListener('change', () => this.draw());
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }

  // Resolves when the video can play, or if the page has none.
  async open(player) {
    await this.openLandmarks();
    if (data.clip === 'none') return this.say('no video: the input could be read only once');
    const blob = await blobOf('clip', 'video/mp4');
    const missing = data.clip === 'beside' ?
      `The clip is missing. It is too large for this page; expected as ${data.clip_file} beside it.` : 'This browser cannot play the clip.';
    this.video.src = blob ? URL.createObjectURL(blob) : encodeURIComponent(data.clip_file);
    const playable = await new Promise(done => {
      this.video.addEventListener('loadedmetadata', () => done(true), {once: true});
      this.video.addEventListener('error', () => done(false), {once: true});
    });
    if (playable) player.follow(this.video); else this.say(missing);
  }

  async openLandmarks() {
    const buffer = await inflated('landmarks');
    if (!buffer) return;
    const count = this.take.frames;
    this.points = Array.from({length: data.landmarks * 2}, (_, i) => summed(new Int16Array(buffer, i * count * 2, count)));
    this.draw();
  }

  say(text) {
    const note = document.getElementById('clip-note');
    note.textContent = text;
    note.classList.add('alert');
  }

  show(i) {
    this.i = i;
    this.draw();
  }

  draw() {
    const fit = fitted(this.canvas);
    if (!fit || !this.choice.checked || !this.points || !(this.i >= 0)) return;
    const {ctx, width, ratio} = fit, scale = width / data.width;
    const box = ['box_x', 'box_y', 'box_width', 'box_height'].map(name => this.take.column(name).at(this.i));
    if (box.includes(null)) return;
    this.drawBox(ctx, box.map(value => value * scale), ratio);
    ctx.fillStyle = pointColor;
    const radius = Math.min(2.2 * ratio, Math.max(0.8 * ratio, box[2] * scale / 200));
    for (let k = 0; k < this.points.length; k += 2) {
      const [x, y] = [this.points[k][this.i], this.points[k + 1][this.i]];
      if (x === none || y === none) continue;
      ctx.beginPath();
      ctx.arc(x * data.landmark_unit * scale, y * data.landmark_unit * scale, radius, 0, 2 * Math.PI);
      ctx.fill();
    }
  }

  drawBox(ctx, [x, y, width, height], ratio) {
    ctx.lineWidth = 1.5 * ratio;
    ctx.strokeStyle = boxColor;
    ctx.strokeRect(x, y, width, height);
    const [pitch, yaw, roll] = ['pitch', 'yaw', 'roll'].map(name => this.take.column(name).at(this.i));
    headAxes(pitch, yaw, roll).forEach(([right, up], axis) => {
      ctx.strokeStyle = axisColors[axis];
      ctx.beginPath();
      ctx.moveTo(x + width / 2, y + height / 2);
      ctx.lineTo(x + width * (0.5 + 0.4 * right), y + height / 2 - width * 0.4 * up);
      ctx.stroke();
    });
  }
}
