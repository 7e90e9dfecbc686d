// Sends the audio of a stream or of a media element to the tracker.

export class Sound {
  constructor(tracking) {
    this.tracking = tracking;
    this.elements = new WeakMap();  // an element can have only one source node
  }

  // Creates the node once, even for concurrent calls; tries again after a failure.
  prepare() {
    this.prepared ??= this.makeNode().catch(error => {
      this.prepared = null;
      throw error;
    });
    return this.prepared;
  }

  async makeNode() {
    const context = new AudioContext({latencyHint: 'interactive'});
    await context.audioWorklet.addModule(new URL('microphone_worklet.js', document.baseURI));
    const node = new AudioWorkletNode(context, 'mien-microphone', {numberOfInputs: 1, numberOfOutputs: 0});
    const {port1, port2} = new MessageChannel();
    node.port.postMessage({port: port1}, [port1]);
    this.tracking.connectAudio(port2);
    Object.assign(this, {context, node});
    setInterval(() => this.alignClocks(), 1000);
  }

  // Timestamps of audio count samples, those of video are of the page's clock.
  alignClocks() {
    if (this.context.state !== 'running') return;
    this.tracking.setSoundOffset(performance.now() - this.context.currentTime * 1000);
  }

  async listen(source, audible) {
    await this.prepare();
    this.stop();
    this.source = source instanceof MediaStream ? this.context.createMediaStreamSource(source) : this.elementSource(source);
    this.source.connect(this.node);
    if (audible) this.source.connect(this.context.destination);
    await this.context.resume();
    this.alignClocks();
  }

  elementSource(element) {
    if (!this.elements.has(element)) this.elements.set(element, this.context.createMediaElementSource(element));
    return this.elements.get(element);
  }

  stop() {
    this.source?.disconnect();
    this.source = null;
  }
}
