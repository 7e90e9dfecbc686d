// The time of each stage of the tracker.

function showStages() {
  const table = document.getElementById('stages'), {frame, ...stages} = data.stages;
  const head = table.createTHead().insertRow(), body = table.createTBody();
  for (const text of ['stage', 'median', '95 %', 'of all']) head.append(Object.assign(document.createElement('th'), {textContent: text, scope: 'col'}));
  const rows = Object.entries(stages).sort(([, a], [, b]) => b.total_ms - a.total_ms);
  if (frame) rows.push(['frame', frame]);
  for (const [name, {median_ms, p95_ms, total_ms}] of rows) {
    const row = body.insertRow(), fraction = frame?.total_ms ? total_ms / frame.total_ms : 0;
    row.append(Object.assign(document.createElement('th'), {textContent: name, scope: 'row'}));
    for (const text of [`${median_ms.toFixed(2)} ms`, `${p95_ms.toFixed(2)} ms`, `${(fraction * 100).toFixed(0)} %`]) row.insertCell().textContent = text;
    row.className = name === 'frame' ? 'all' : 'share';
    row.style.setProperty('--value', fraction.toFixed(3));
  }
}
