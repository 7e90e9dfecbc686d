// Collects audio on the audio thread and sends it to the tracker's worker in blocks of 10 ms.

class Microphone extends AudioWorkletProcessor {
  constructor() {
    super();
    this.block = new Float32Array(Math.round(sampleRate / 100));
    this.filled = 0;
    this.port.onmessage = ({data: {port}}) => { this.outlet = port; };
  }

  process([channels]) {
    const samples = channels.length, length = channels[0]?.length ?? 0;
    for (let i = 0; i < length; ++i) {
      let sum = 0;
      for (const channel of channels) sum += channel[i];
      this.block[this.filled++] = sum / samples;
      if (this.filled === this.block.length) this.send(currentFrame + i + 1 - this.filled);
    }
    return true;
  }

  send(firstFrame) {
    this.outlet?.postMessage({samples: this.block, sampleRate, timeMs: firstFrame / sampleRate * 1000});
    this.filled = 0;
  }
}

registerProcessor('mien-microphone', Microphone);
