// Sends the audio of a stream or of a media element to the tracker.
import {audioCollector} from '../../../../bindings/js/listen.js';

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
    const {node, port} = await audioCollector(context);
    this.tracking.connectAudio(port);
    Object.assign(this, {context, node});
  }

  async listen(source, audible) {
    await this.prepare();
    this.stop();
    this.source = source instanceof MediaStream ? this.context.createMediaStreamSource(source) : this.elementSource(source);
    this.source.connect(this.node);
    if (audible) this.source.connect(this.context.destination);
    await this.context.resume();
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
