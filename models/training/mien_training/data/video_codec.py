"""Effects of an H.264 camera or call on a sequence: blocks, smeared texture, skipped motion."""
import subprocess

import numpy as np

FINEST, COARSEST = 22, 36   # constant rate factor: of a good recording, of a bad call (at 40 lips are gone)
SHORTEST = 8                # frames


def ffmpeg(arguments, data):
    done = subprocess.run(["ffmpeg", "-loglevel", "error", *arguments, "pipe:1"], input=data, capture_output=True)
    if done.returncode:
        raise RuntimeError(f"ffmpeg {' '.join(arguments)}: {done.stderr.decode().strip()}")
    return done.stdout


def through_h264(frames, quality):
    """uint8 [n,h,w,3] -> the same, coded at the constant rate factor `quality` with motion prediction; h and w are
    even."""
    n, h, w, _ = frames.shape
    assert h % 2 == 0 and w % 2 == 0, (h, w)
    raw = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{w}x{h}", "-r", "30"]
    coded = ffmpeg([*raw, "-i", "pipe:0", "-c:v", "libx264", "-preset", "veryfast", "-threads", "1", "-pix_fmt",
                    "yuv420p", "-crf", str(quality), "-f", "matroska"], np.ascontiguousarray(frames).tobytes())
    shown = ffmpeg(["-threads", "1", "-i", "pipe:0", "-fps_mode", "passthrough", "-f", "rawvideo", "-pix_fmt", "rgb24"],
                   coded)
    return np.frombuffer(shown, np.uint8).reshape(n, h, w, 3)


def some_coded(sequences, share, rng):
    """Sequences, a list of uint8 [n,h,w,3], a share of them coded, except short ones."""
    film = lambda frames: len(frames) >= SHORTEST and rng.random() < share
    return [through_h264(frames, int(rng.integers(FINEST, COARSEST + 1))) if film(frames) else frames
            for frames in sequences]
