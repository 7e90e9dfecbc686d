// The connection to the program.

// Calls `onState` and `onFrame` with each event, and `onLost` when the program cannot be reached.
function listen({onState, onFrame, onLost}) {
  const events = new EventSource('events');
  if (onState) events.addEventListener('state', ({data}) => onState(JSON.parse(data)));
  events.addEventListener('frame', ({data}) => onFrame(JSON.parse(data)));
  if (onLost) events.addEventListener('error', onLost);
}

// Sends a command; throws with the reason if the program rejects it.
async function command(name, values = {}) {
  const response = await fetch('command', {
    method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify({do: name, ...values})});
  if (!response.ok) throw new Error(await response.text() || response.statusText);
}

// Calls the function at most every `interval_ms`, the last time with the latest arguments.
function throttled(action, interval_ms) {
  let waiting;
  return (...latest) => {
    if (!waiting) setTimeout(() => {
      const values = waiting;
      waiting = undefined;
      action(...values);
    }, interval_ms);
    waiting = latest;
  };
}
