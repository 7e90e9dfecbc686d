// Sends audio of a page to a tracker, through the audio thread.

// A node that collects audio, and the port where it arrives in blocks of 10 ms, timed by performance.now() of the page.
export async function audioCollector(context, worklet = new URL('./mien-worklet.js', import.meta.url)) {
  await context.audioWorklet.addModule(worklet);
  const node = new AudioWorkletNode(context, 'mien-microphone', {numberOfInputs: 1, numberOfOutputs: 0});
  const {port1, port2} = new MessageChannel();
  node.port.postMessage({outlet: port1}, [port1]);
  // The clocks of audio devices drift.
  const align = () => {
    if (context.state === 'running') node.port.postMessage({offsetMs: performance.now() - context.currentTime * 1000});
  };
  context.addEventListener('statechange', align);
  const timer = setInterval(align, 1000);
  align();
  return {
    node, port: port2,
    close() {
      clearInterval(timer);
      context.removeEventListener('statechange', align);
      node.port.postMessage({stop: true});
    }};
}

export async function listen(tracker, source, {context = source.context ?? new AudioContext({latencyHint: 'interactive'})} = {}) {
  const collector = await audioCollector(context);
  await tracker.connectAudio(collector.port);
  const input = source.context ? source : context.createMediaStreamSource(source);
  input.connect(collector.node);
  context.resume();  // the browser allows it after the first click or key of the user
  return {
    context,
    stop() {
      input.disconnect(collector.node);
      collector.close();
      if (context !== source.context) context.close();
    }};
}
