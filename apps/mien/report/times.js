// The time of each part of the tracker.

function showTimes(frames) {
  const {frame, ...stages} = data.stages, whole_ms = frame?.total_ms ?? 0;
  const totals = Object.entries(trackerParts).map(([name, of]) => [name, of.reduce((sum, stage) => sum + (stages[stage]?.total_ms ?? 0), 0)]);
  const table = document.getElementById('times'), head = table.createTHead().insertRow(), body = table.createTBody();
  for (const text of ['part', 'per frame', 'of all']) head.append(Object.assign(document.createElement('th'), {textContent: text, scope: 'col'}));
  for (const [name, total_ms] of [...totals.sort(([, a], [, b]) => b - a), ['all', whole_ms]]) {
    const row = body.insertRow(), fraction = whole_ms ? total_ms / whole_ms : 0;
    row.append(Object.assign(document.createElement('th'), {textContent: name, scope: 'row'}));
    for (const text of [`${(total_ms / Math.max(1, frames)).toFixed(2)} ms`, `${(fraction * 100).toFixed(0)} %`]) row.insertCell().textContent = text;
    row.className = name === 'all' ? 'all' : 'share';
    row.style.setProperty('--value', fraction.toFixed(3));
  }
  document.getElementById('times-note').textContent = frame ? `Half of the frames take at most ${frame.median_ms.toFixed(2)} ms, 95\u00a0% at most ${frame.p95_ms.toFixed(2)} ms.` : '';
}
