// Collects audio on the audio thread, and sends it in blocks of 10 ms: {samples, sampleRate, timeMs}. Imports nothing, so that bundlers can copy it.
// Messages to it: {outlet}, the port where blocks go; {offsetMs}, from the clock of the audio to that of their timestamps, without which it sends none;
// {stop}, which ends it.

class Microphone extends AudioWorkletProcessor {
  constructor() {
    super();
    this.block = new Float32Array(Math.round(sampleRate / 100));
    this.filled = 0;
    this.port.onmessage = ({data}) => Object.assign(this, data);
  }

  process([channels]) {
    const samples = channels.length, length = channels[0]?.length ?? 0;
    for (let i = 0; i < length; ++i) {
      let sum = 0;
      for (const channel of channels) sum += channel[i];
      this.block[this.filled++] = sum / samples;
      if (this.filled === this.block.length) this.send(currentFrame + i + 1 - this.filled);
    }
    return !this.stop;
  }

  send(firstFrame) {
    this.filled = 0;
    if (this.outlet && this.offsetMs !== undefined) {
      this.outlet.postMessage({samples: this.block, sampleRate, timeMs: firstFrame / sampleRate * 1000 + this.offsetMs});
    }
  }
}

registerProcessor('mien-microphone', Microphone);
