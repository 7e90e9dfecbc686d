// Intervals without a face, in the states searching or lost.

const statusNames = ['searching', 'tracking', 'lost'];

function findLosses(take) {
  if (!data.width) return [];  // no video
  const {steps} = take.column('status'), losses = [];
  for (let i = 0; i < steps.length; ++i) {
    if (statusNames[steps[i]] === 'tracking') continue;
    const end_ms = take.t_ms[i + 1] ?? data.end_ms, last = losses.at(-1);
    if (last && last.to === i && last.status === steps[i]) Object.assign(last, {to: i + 1, end_ms});
    else losses.push({from: i, to: i + 1, status: steps[i], start_ms: take.t_ms[i], end_ms});
  }
  return losses;
}

function showLosses(losses, take, go) {
  const frames = losses.reduce((sum, {from, to}) => sum + to - from, 0), percent = 100 * frames / Math.max(1, take.frames);
  document.getElementById('losses-note').textContent = !data.width ? 'No video.' :
    losses.length ? `In ${frames} of ${take.frames} frames (${percent.toFixed(1)} %), ${losses.length} times.` : 'Every frame has a face.';
  document.getElementById('losses').append(...losses.map(loss => {
    const item = document.createElement('li'), button = Object.assign(document.createElement('button'), {type: 'button'});
    const count = loss.to - loss.from;
    button.textContent = `${timeText(loss.start_ms, 2)} – ${timeText(loss.end_ms, 2)}  ${statusNames[loss.status]}, ${count} frame${count === 1 ? '' : 's'}`;
    button.addEventListener('click', () => go(loss));
    item.append(button);
    return item;
  }));
}
