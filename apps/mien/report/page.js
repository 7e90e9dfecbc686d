// Connects the parts of the page: first the visible ones, then the large ones.

document.title = `${data.name} – mien report`;
document.getElementById('name').textContent = data.name;

const report = {};  // parts of the page, once created

function showFacts(take) {
  const {steps} = take.column('status'), faces = steps.filter(step => statusNames[step] === 'tracking').length;
  const levels = [...new Set(take.column('lod').steps)].filter(lod => lod > 0).sort();
  document.getElementById('facts').textContent = [
    timeText(data.end_ms - data.start_ms), `${take.frames} frames`,
    data.width ? `a face in ${Math.round(100 * faces / Math.max(1, take.frames))} %` : 'audio only',
    data.width ? `${data.width}\u00a0×\u00a0${data.height}` : '', levels.length ? `level of detail ${levels.join(', ')}` : '', data.program,
  ].filter(Boolean).join(' · ');
}

// Zooms to an interval, with some time around it.
function goTo({start_ms, end_ms}) {
  const {view, player} = report;
  if (!view.whole) view.set(start_ms - (end_ms - start_ms), 3 * (end_ms - start_ms));
  player.seek(start_ms);
}

function goToLoss(direction) {
  const {losses, player} = report, {time_ms} = player.clock;
  const found = direction > 0 ? losses.find(loss => loss.start_ms > time_ms + 1) : losses.findLast(loss => loss.start_ms < time_ms - 1);
  if (found) goTo(found);
}

function connectKeys() {
  const {view, player} = report, now = () => player.clock.time_ms;
  const actions = {
    '+': () => view.zoom(2, now()), '=': () => view.zoom(2, now()), '-': () => view.zoom(0.5, now()), '0': () => view.all(),
    Home: () => player.seek(data.start_ms), End: () => player.seek(data.end_ms),
    PageUp: () => view.pan(-view.length_ms), PageDown: () => view.pan(view.length_ms),
    n: () => goToLoss(1), p: () => goToLoss(-1), l: () => document.getElementById('with-overlay').click(),
  };
  document.addEventListener('keydown', event => {
    const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action || event.ctrlKey || event.altKey || event.metaKey || event.target.closest?.('input, select')) return;
    if (event.key.startsWith('Page') && view.whole) return;  // lets the page scroll
    action();
    event.preventDefault();
  });
  for (const [id, key] of [['zoom-in', '+'], ['zoom-out', '-'], ['zoom-all', '0']]) document.getElementById(id).addEventListener('click', actions[key]);
}

class ReportPlayer extends Player {
  step(frames) {
    const {take} = report, i = Math.min(take.frames - 1, Math.max(0, take.frameAt(this.clock.time_ms) + frames));
    this.seek(take.t_ms[i]);
  }
}

function showWindow(view) {
  document.getElementById('window').textContent = view.whole ? '' : `${timeText(view.start_ms)} – ${timeText(view.end_ms)}`;
}

// Draws the curves without a pause: otherwise the browser would first parse the large blocks after
// the script.
async function open() {
  const take = report.take = new Take(data.columns, bytesOf(blockText('columns')).buffer);
  const losses = report.losses = findLosses(take), view = report.view = new View(data.start_ms, data.end_ms);
  showFacts(take);
  showLosses(losses, take, goTo);
  showTimes(take.frames);
  showDownloads();
  const seek = t_ms => report.player.seek(t_ms);
  const lanes = report.lanes = new Lanes(take, view, losses, seek), overview = report.overview = new Overview(take, view, losses, seek);
  const toggles = report.toggles = new Toggles(lanes), clip = report.clip = new Clip(take);
  view.onChange(() => showWindow(view));
  if (matchMedia('(max-width: 62rem)').matches) document.getElementById('toggles-box').open = false;
  let face = null, shownTime = null, shownFrame = null;
  const player = report.player = new ReportPlayer(t_ms => {
    if (t_ms !== shownTime) {
      view.keep(t_ms);
      lanes.show(t_ms);
      overview.show(t_ms);
      shownTime = t_ms;
    }
    const i = take.frameAt(t_ms);
    if (i === shownFrame || !face) return;
    for (const part of [face, clip, toggles]) part.show(i);
    shownFrame = i;
  });
  connectKeys();
  lanes.draw();
  overview.draw();
  report.curves_ms = performance.now();
  await new Promise(done => requestAnimationFrame(() => setTimeout(done)));  // shows the curves before the avatar is created
  report.face = face = new FaceView(take);
  player.show();
  report.opened_ms = performance.now();
  if (document.readyState === 'loading') await new Promise(done => document.addEventListener('DOMContentLoaded', done));
  await Promise.all([clip.open(player), face.openContained()]);
  report.whole_ms = performance.now();
}
open();
