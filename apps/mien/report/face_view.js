// The animated face: mien's avatar, the user's that the report contains, or a file that the user opens.

// Runs the script that shows users' avatars (apps/web/src/model/model_avatar.js), which the page contains packed.
async function unpackViewer() {
  if (!document.getElementById('viewer').textContent) {
    throw new Error("The Python package's reports cannot show your avatar. Reports of the other packages of mien can.");
  }
  const script = document.createElement('script');
  script.textContent = new TextDecoder().decode(await inflated('viewer'));
  document.head.append(script);
  return avatarViewer;
}

// The 15 visemes of all frames.
async function readVisemes() {
  const [, ...rows] = new TextDecoder().decode(await inflated('export-visemes')).trim().split('\n');
  return rows.map(row => row.split(',').slice(-15).map(Number));
}

// Draws on its own canvas instead of drawFace, so that nothing waits for it.
class FaceView {
  constructor(take) {
    const element = id => document.getElementById(id);
    Object.assign(this, {take, canvas: element('face'), note: element('face-note'), error: element('error'), trouble: '', i: -1});
    if (!data.avatar) this.useDefault();
    element('avatar-file').addEventListener('change', ({target}) => this.openFile(target.files[0]).then(() => { target.value = ''; }));
    element('default-avatar').addEventListener('click', () => this.useDefault());
    element('reset-view').addEventListener('click', () => this.avatar.resetView());
    this.error.lastElementChild.addEventListener('click', () => this.complain(''));
  }

  // Stays until the user dismisses it.
  complain(text) {
    this.error.firstElementChild.textContent = text;
    this.error.hidden = !text;
  }

  useDefault() {
    const canvas = this.canvas.cloneNode();
    try {
      this.place(new Avatar(canvas), canvas);
    } catch (problem) {
      this.trouble = problem.message;
    }
  }

  async openContained() {
    if (data.avatar) await this.openFile(new File([await inflated('export-glb')], data.avatar));
  }

  async openFile(file) {
    if (!file) return;
    const canvas = this.canvas.cloneNode();
    this.note.textContent = `opening ${file.name} …`;
    try {
      this.viewer ??= await unpackViewer();
      const avatar = await this.viewer.openModel(file, canvas);
      if (avatar.vocabularies.includes('Oculus')) this.visemes ??= await readVisemes();
      this.place(avatar, canvas);
    } catch (problem) {
      this.complain(problem.message);
      if (this.avatar) this.show(this.i); else this.useDefault();
    }
  }

  // A canvas keeps its first type of context, so each avatar has its own.
  place(avatar, canvas) {
    this.avatar?.dispose?.();
    this.canvas.replaceWith(canvas);
    Object.assign(this, {avatar, canvas});
    let waiting = false;
    avatar.onChange = () => {  // the user turned the view
      if (!waiting) requestAnimationFrame(() => { waiting = false; this.show(this.i); });
      waiting = true;
    };
    const isUsers = 'resetView' in avatar;
    for (const id of ['reset-view', 'default-avatar']) document.getElementById(id).hidden = !isUsers;
    document.querySelector('[for=avatar-file]').hidden = isUsers;
    this.show(this.i);
  }

  // The face of frame i; neutral before the first.
  faceOf(i) {
    const value = name => this.take.column(name).at(i) ?? 0;
    return {
      controls: Object.fromEntries(controlNames.map(name => [name, value(name)])), visemes: this.visemes?.[i],
      pitch: value('pitch'), yaw: value('yaw'), roll: value('roll')};
  }

  show(i) {
    const status = statusNames[this.take.column('status').at(i)] ?? 'searching';
    this.i = i;
    this.canvas.classList.toggle('absent', data.width > 0 && status !== 'tracking');
    this.note.textContent = this.trouble || (data.width && status !== 'tracking' ? status : 'Tracked face');
    this.avatar?.draw(this.faceOf(i));
  }
}
