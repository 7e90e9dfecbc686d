// Where pictures and sound come from: camera and microphone, or a file. One at a time: what is opened or closed makes all earlier
// openings stale (`generation`), and what these still wait for is given back or left alone.

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
    const mine = this.close();
    const {stream, missing} = await openDevices();
    if (mine !== this.generation) return stopTracks(stream);
    this.stream = stream;
    this.video.muted = true;
    this.video.srcObject = stream.getVideoTracks().length ? stream : null;
    for (const track of stream.getTracks()) track.addEventListener('ended', () => this.onEnd?.(`the ${track.kind === 'video' ? 'camera' : 'microphone'} is gone`));
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
      this.video.onerror = () => failed(new Error(`${file.name}: this browser cannot play it`));
    });
    if (mine !== this.generation) return;
    await this.sound.listen(this.video, true);
    await this.start(mine);
  }

  async start(mine) {
    if (mine !== this.generation) return;
    if (this.url || this.video.srcObject) await this.video.play();
    if (this.hasPictures) this.pumpFrames(mine); else this.pumpTicks(mine);
  }

  // Returns the generation of what is opened next.
  close() {
    ++this.generation;
    this.sound.stop();
    if (this.stream) stopTracks(this.stream);
    this.video.pause();
    this.video.srcObject = this.stream = null;
    this.video.removeAttribute('src');
    this.video.load();  // forgets what was shown
    if (this.url) URL.revokeObjectURL(this.url);
    this.url = null;
    return this.generation;
  }

  get hasPictures() { return Boolean(this.video.srcObject || this.video.videoWidth); }

  // Each picture as it is shown, at the time it was taken.
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
      const picture = await pictureOf(video, timeMs);
      if (mine === this.generation) this.tracking.push(picture, timeMs); else picture.close();
    };
    next(each);
  }

  // Sound without pictures still moves the mouth.
  pumpTicks(mine) {
    const timer = setInterval(() => {
      if (mine !== this.generation) return clearInterval(timer);
      if (this.stream || !this.video.paused) this.tracking.advance(performance.now() - 50);
    }, tick_ms);
  }
}

const pictureOf = (video, timeMs) =>
  (window.VideoFrame ? new VideoFrame(video, {timestamp: Math.round(timeMs * 1000)}) : createImageBitmap(video));

function stopTracks(stream) {
  for (const track of stream.getTracks()) track.stop();
}

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
