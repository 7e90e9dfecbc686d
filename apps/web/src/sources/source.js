// The source of video and audio: camera and microphone, or a file. One at a time: opening or closing a source invalidates
// pending openings (`generation`), which then release their devices.

const cameraWish = {width: {ideal: 640}, height: {ideal: 480}, frameRate: {ideal: 30}, facingMode: 'user'};
const microphoneWish = {echoCancellation: false, noiseSuppression: false, autoGainControl: true};
const tick_ms = 1000 / 30;
const lost = {
  video: 'the camera was disconnected; connect it again, then press Camera',
  audio: 'the microphone was disconnected; connect it again, or press Camera to go on without it'};

export class Source {
  constructor(video, sound, tracking) {
    Object.assign(this, {video, sound, tracking, generation: 0});
    video.addEventListener('ended', () => this.onEnd?.());
  }

  // Either camera or microphone may be missing.
  async openCamera() {
    const mine = this.close();
    const {stream, ...missing} = await openDevices();
    if (mine !== this.generation) return stopTracks(stream);
    this.stream = stream;
    this.video.muted = true;
    this.video.srcObject = stream.getVideoTracks().length ? stream : null;
    for (const track of stream.getTracks()) track.addEventListener('ended', () => this.onEnd?.(lost[track.kind]));
    if (stream.getAudioTracks().length) await this.sound.listen(stream, false);
    await this.start(mine);
    return missing;
  }

  async openFile(file) {
    const mine = this.close();
    this.url = URL.createObjectURL(file);
    this.video.muted = false;
    this.video.src = this.url;
    this.video.loop = true;
    await new Promise((done, failed) => {
      this.video.onloadeddata = done;
      this.video.onerror = () => failed(new Error(`${file.name}: this browser cannot play it; convert it to MP4 with H.264`));
    });
    if (mine !== this.generation) return;
    await this.sound.listen(this.video, true);
    await this.start(mine);
  }

  async start(mine) {
    if (mine !== this.generation) return;
    if (this.url || this.video.srcObject) await this.video.play();
    if (this.hasVideo) this.pumpFrames(mine); else this.pumpTicks(mine);
  }

  // Returns the generation of the next source.
  close() {
    ++this.generation;
    this.sound.stop();
    if (this.stream) stopTracks(this.stream);
    this.video.pause();
    this.video.srcObject = this.stream = null;
    this.video.removeAttribute('src');
    this.video.load();  // clears the last image
    if (this.url) URL.revokeObjectURL(this.url);
    this.url = null;
    return this.generation;
  }

  get hasVideo() { return Boolean(this.video.srcObject || this.video.videoWidth); }

  // Pushes each image when it is displayed, with its capture time.
  pumpFrames(mine) {
    const {video} = this;
    const next = video.requestVideoFrameCallback ?
      callback => video.requestVideoFrameCallback(callback) : callback => requestAnimationFrame(now => callback(now, {}));
    const each = async (now, {captureTime, mediaTime}) => {
      if (mine !== this.generation) return;
      next(each);
      if (video.readyState < 2 || (mediaTime === undefined && video.currentTime === this.shownAt)) return;
      this.shownAt = video.currentTime;
      const timeMs = captureTime ?? now;
      if (!this.tracking.idle) return ++this.tracking.dropped;
      const image = await imageOf(video, timeMs);
      if (mine === this.generation) this.tracking.push(image, timeMs); else image.close();
    };
    next(each);
  }

  // Audio without video still moves the mouth.
  pumpTicks(mine) {
    const timer = setInterval(() => {
      if (mine !== this.generation) return clearInterval(timer);
      if (this.stream || !this.video.paused) this.tracking.advance(performance.now() - 50);
    }, tick_ms);
  }
}

const imageOf = (video, timeMs) =>
  (window.VideoFrame ? new VideoFrame(video, {timestamp: Math.round(timeMs * 1000)}) : createImageBitmap(video));

function stopTracks(stream) {
  for (const track of stream.getTracks()) track.stop();
}

// Returns {stream, missing, problem}: `missing` is a device without which the stream works, and `problem` a camera's.
async function openDevices() {
  const devices = navigator.mediaDevices;
  if (!devices) throw new Error('this page must not use a camera here; open it with https, or on localhost');
  try {
    return {stream: await devices.getUserMedia({video: cameraWish, audio: microphoneWish})};
  } catch {
    return devices.getUserMedia({video: cameraWish}).then(stream => ({stream, missing: 'microphone'}), async error => {
      const problem = advised(error);
      const stream = await devices.getUserMedia({audio: microphoneWish}).catch(() => { throw new Error(problem); });
      return {stream, missing: 'camera', problem};
    });
  }
}

const advised = ({name, message}) => ({
  NotAllowedError: "the browser may not use the camera; allow it in the address bar, or in the system's privacy settings, then press Camera again",
  NotFoundError: 'no camera was found; connect a camera, then press Camera again, or load a video',
  NotReadableError: 'the camera does not start; close other programs that use it, then press Camera again'}[name] ?? message);
