// Where pictures and sound come from: camera and microphone, or a file. One at a time.

const cameraWish = {width: {ideal: 640}, height: {ideal: 480}, frameRate: {ideal: 30}, facingMode: 'user'};
const microphoneWish = {echoCancellation: false, noiseSuppression: false, autoGainControl: true};
const tick_ms = 1000 / 30;

export class Source {
  constructor(video, sound, tracking) {
    Object.assign(this, {video, sound, tracking, generation: 0});
    video.addEventListener('ended', () => this.onEnd?.());
  }

  // Either camera or microphone may be missing; with both missing the camera's error is thrown.
  async openCamera() {
    this.close();
    const {stream, missing} = await openDevices();
    this.stream = stream;
    this.video.muted = true;
    this.video.srcObject = stream.getVideoTracks().length ? stream : null;
    for (const track of stream.getTracks()) track.addEventListener('ended', () => this.onEnd?.(`the ${track.kind === 'video' ? 'camera' : 'microphone'} is gone`));
    if (stream.getAudioTracks().length) await this.sound.listen(stream, false);
    if (this.video.srcObject) {
      await this.video.play();
      this.pumpFrames();
    } else {
      this.pumpTicks(() => true);
    }
    return missing;
  }

  async openFile(file) {
    this.close();
    this.url = URL.createObjectURL(file);
    this.video.muted = false;
    this.video.src = this.url;
    this.video.loop = true;
    await new Promise((done, failed) => {
      this.video.onloadeddata = done;
      this.video.onerror = () => failed(new Error(`${file.name}: this browser cannot play it`));
    });
    await this.sound.listen(this.video, true);
    await this.video.play();
    if (this.hasPictures) this.pumpFrames(); else this.pumpTicks(() => !this.video.paused);
  }

  close() {
    ++this.generation;
    this.sound.stop();
    for (const track of this.stream?.getTracks() ?? []) track.stop();
    this.video.pause();
    this.video.srcObject = this.stream = null;
    this.video.removeAttribute('src');
    this.video.load();  // forgets what was shown
    if (this.url) URL.revokeObjectURL(this.url);
    this.url = null;
  }

  get hasPictures() { return Boolean(this.video.srcObject || this.video.videoWidth); }

  // Each picture as it is shown, at the time it was taken.
  pumpFrames() {
    const {generation, video} = this;
    const next = video.requestVideoFrameCallback ?
      callback => video.requestVideoFrameCallback(callback) : callback => requestAnimationFrame(now => callback(now, {}));
    const each = async (now, {captureTime, mediaTime}) => {
      if (generation !== this.generation) return;
      next(each);
      if (video.readyState < 2 || (mediaTime === undefined && video.currentTime === this.shownAt)) return;
      this.shownAt = video.currentTime;
      const timeMs = captureTime ?? now;
      if (!this.tracking.idle) ++this.tracking.dropped;
      else this.tracking.push(await pictureOf(video, timeMs), timeMs);
    };
    next(each);
  }

  // Sound without pictures still moves the mouth.
  pumpTicks(isOn) {
    const {generation} = this;
    const timer = setInterval(() => {
      if (generation !== this.generation) return clearInterval(timer);
      if (isOn()) this.tracking.advance(performance.now() - 50);
    }, tick_ms);
  }
}

const pictureOf = (video, timeMs) =>
  (window.VideoFrame ? new VideoFrame(video, {timestamp: Math.round(timeMs * 1000)}) : createImageBitmap(video));

async function openDevices() {
  const devices = navigator.mediaDevices;
  if (!devices) throw new Error('this page needs https, or localhost, to use a camera');
  try {
    return {stream: await devices.getUserMedia({video: cameraWish, audio: microphoneWish}), missing: null};
  } catch (problem) {
    const alone = async (wish, missing) => ({stream: await devices.getUserMedia(wish), missing});
    return alone({video: cameraWish}, 'microphone')
      .catch(() => alone({audio: microphoneWish}, 'camera'))
      .catch(() => { throw new Error(spoken(problem)); });
  }
}

const spoken = ({name, message}) => ({
  NotAllowedError: 'the browser was not allowed to use camera and microphone',
  NotFoundError: 'there is no camera and no microphone',
  NotReadableError: 'another program is using the camera'}[name] ?? message);
