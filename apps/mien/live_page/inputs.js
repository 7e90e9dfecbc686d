// Lists of cameras and microphones.

class DevicePicker {
  constructor(select, name) {
    Object.assign(this, {select, current: '', devices: []});
    select.addEventListener('change', () => {
      this.current = select.value;
      command(name, {name: select.value}).catch(error => complain(error.message));
    });
  }

  list(devices) {
    this.devices = devices;
    this.fill();
  }

  // The device in use, which may be a file or an address.
  use(name) {
    if (name === this.current) return;
    this.current = name;
    this.fill();
  }

  fill() {
    const known = this.devices.map(({name, description}) => new Option(description ? `${description} (${name})` : name, name));
    const others = [this.current].filter(name => name && name !== 'none' && !this.devices.some(device => device.name === name));
    this.select.replaceChildren(...others.map(name => new Option(name, name)), ...known, new Option('none', 'none'));
    this.select.value = this.current;
  }
}

class Inputs {
  constructor(note) {
    this.note = note;
    this.camera = new DevicePicker(document.getElementById('camera'), 'camera');
    this.microphone = new DevicePicker(document.getElementById('microphone'), 'microphone');
    navigator.mediaDevices?.addEventListener('devicechange', () => this.list());
    this.list();
  }

  async list() {
    try {
      const {cameras, microphones, problem} = await (await fetch('devices')).json();
      this.camera.list(cameras);
      this.microphone.list(microphones);
      this.found = {cameras, microphones, problem};
    } catch {}  // the status says that the program is not there
  }

  show({camera, microphone}) {
    this.camera.use(camera.name);
    this.microphone.use(microphone.name);
    const {cameras, problem} = this.found ?? {};
    const missing = cameras?.length === 0 && camera.name === 'none' ? 'No camera is connected.' : '';
    const text = [problem, camera.error, microphone.error].filter(Boolean).join(' · ') || missing;
    if (this.note.textContent !== text) this.note.textContent = text;
  }
}
