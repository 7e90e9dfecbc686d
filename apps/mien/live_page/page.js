// Connects the parts of the page.

const $ = id => document.getElementById(id);

// Stays until the user dismisses it.
function complain(text) {
  $('error').firstElementChild.textContent = text;
  $('error').hidden = !text;
}

function say(text) {
  if ($('status').textContent !== text) $('status').textContent = text;
}

function showNumbers(state) {
  const rows = [
    ['Frames', `${state.fps} per second`], ['Level', `${state.level}${state.automatic ? ' (automatic)' : ''}`],
    ['Latency', `${state.latency_ms} ms from image to packet`], ['Dropped frames', state.dropped_images],
    ['Dropped packets', state.dropped_packets]];
  $('numbers').replaceChildren(...rows.flatMap(([term, value]) => [
    Object.assign(document.createElement('dt'), {textContent: term}), Object.assign(document.createElement('dd'), {textContent: value})]));
}

async function download(name) {
  const url = URL.createObjectURL(await (await fetch('profile')).blob());
  Object.assign(document.createElement('a'), {href: url, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}

class LivePage {
  constructor() {
    this.avatar = new AvatarView($('face'));
    this.preview = new Preview($('preview'), $('image'), $('show-preview'));
    this.inputs = new Inputs($('devices-note'));
    this.senders = new Senders($('senders'), $('no-senders'));
    this.adjustments = new Adjustments($('adjustments'), $('adjustments-box'));
    this.wizard = new Wizard({step: $('step'), progress: $('progress'), button: $('calibrate'), adjustments: this.adjustments});
    this.connect();
    listen({
      onState: state => this.showState(state), onFrame: frame => this.showFrame(frame),
      onLost: () => say('No connection: mien live has ended')});
  }

  connect() {
    const send = (...words) => command(...words).catch(error => complain(error.message));
    $('error').lastElementChild.addEventListener('click', () => complain(''));
    $('mirror').addEventListener('change', ({target}) => send('mirror', {on: target.checked}));
    $('level').addEventListener('change', ({target}) => send('level', {level: Number(target.value)}));
    $('save').addEventListener('click', () => send('save'));
    $('reset').addEventListener('click', () => this.adjustments.reset());
    $('obs').value = new URL('obs', location.href).href;
    $('copy').addEventListener('click', async () => {
      $('obs').select();
      await navigator.clipboard.writeText($('obs').value);
      $('copy').textContent = 'Copied';
    });
  }

  showState(state) {
    this.inputs.show(state);
    this.senders.show(state.senders);
    this.adjustments.show(state.adjustments);
    this.wizard.showState(state);
    $('mirror').checked = state.mirrored;
    $('preview').classList.toggle('mirrored', state.mirrored);
    if (document.activeElement !== $('level')) $('level').value = String(state.automatic ? 0 : state.level);
    showNumbers(state);
    this.showSaved(state);
    if (state.message && state.message !== this.state?.message) complain(state.message);
    this.state = state;
  }

  showSaved({saved, profile_file: file}) {
    if (saved > (this.state?.saved ?? saved)) {
      if (!file) download('mien-profile.json');
      $('saved').textContent = file ? `Saved to ${file}` : 'Load it with: mien live --profile mien-profile.json';
    }
  }

  showFrame(frame) {
    this.avatar.show(frame);
    this.wizard.showFrame(frame);
    this.adjustments.showValues(frame.controls);
    say({searching: 'No face', tracking: 'Tracking', lost: 'Face lost'}[frame.status]);
  }
}

try {
  window.page = new LivePage();
} catch (error) {
  complain(error.message);
}
