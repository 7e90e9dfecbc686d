// The camera's jawOpen in React: src/App.tsx of a project made by `npm create vite@latest face -- --template react-ts`, with the npm package.
import {useEffect, useRef, useState} from 'react';
import {controlsByName, createTrackerWorker, listen, type Result} from 'mien';

// Tracks camera and microphone until the signal.
async function track(video: HTMLVideoElement, signal: AbortSignal, show: (result: Result) => void) {
  const stream = await navigator.mediaDevices.getUserMedia({video: true, audio: true});
  const tracker = await createTrackerWorker();
  const microphone = await listen(tracker, stream);
  const aborted = new Promise(done => signal.addEventListener('abort', done));
  try {
    video.srcObject = stream;
    await video.play();
    while (!signal.aborted) {
      await Promise.race([aborted, new Promise(next => video.requestVideoFrameCallback(next))]);
      const result = await tracker.track(video);
      if (!signal.aborted) show(result);
    }
  } finally {
    microphone.stop();
    tracker.destroy();
    for (const each of stream.getTracks()) each.stop();
  }
}

export default function App() {
  const video = useRef<HTMLVideoElement>(null);
  const [running, setRunning] = useState(false);
  const [result, setResult] = useState<Result>();
  const [problem, setProblem] = useState('');
  useEffect(() => {
    if (!running || !video.current) return;
    const controller = new AbortController();
    setProblem('');
    track(video.current, controller.signal, setResult).catch((error: Error) => {
      if (!controller.signal.aborted) setProblem(error.message);
    });
    return () => controller.abort();
  }, [running]);

  return (
    <main>
      <button onClick={() => setRunning(!running)}>{running ? 'Stop' : 'Start'}</button>
      <video ref={video} muted playsInline width={320} />
      <p>
        jawOpen <meter value={result ? controlsByName(result).jawOpen : 0} /> <output>{problem || result?.status}</output>
      </p>
    </main>
  );
}
