"""What an H.264 camera or call does to a sequence: blocks, smeared texture, and motion that skips."""
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
    """uint8 [n,h,w,3] -> the same, coded at the constant rate factor `quality` with motion prediction; h and w are even."""
    n, h, w, _ = frames.shape
    assert h % 2 == 0 and w % 2 == 0, (h, w)
    raw = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{w}x{h}", "-r", "30"]
    coded = ffmpeg([*raw, "-i", "pipe:0", "-c:v", "libx264", "-preset", "veryfast", "-threads", "1", "-pix_fmt", "yuv420p",
                    "-crf", str(quality), "-f", "matroska"], np.ascontiguousarray(frames).tobytes())
    shown = ffmpeg(["-threads", "1", "-i", "pipe:0", "-fps_mode", "passthrough", "-f", "rawvideo", "-pix_fmt", "rgb24"], coded)
    return np.frombuffer(shown, np.uint8).reshape(n, h, w, 3)


def some_coded(sequences, share, rng):
    """Sequences, a list of uint8 [n,h,w,3], a share of them coded. Faces that hold still for a moment are no films."""
    film = lambda frames: len(frames) >= SHORTEST and rng.random() < share
    return [through_h264(frames, int(rng.integers(FINEST, COARSEST + 1))) if film(frames) else frames for frames in sequences]


def self_test():
    """Coarser is worse, fine is close, and a moving disc stays where it is in every frame."""
    y, x = np.mgrid[0:64, 0:96]
    frames = np.stack([np.where((x - 20 - 3 * t) ** 2 + (y - 32) ** 2 < 144, 220, 60 + x // 2) for t in range(12)])
    frames = np.repeat(frames[..., None], 3, 3).astype(np.uint8)
    error = lambda quality: np.abs(through_h264(frames, quality).astype(float) - frames).mean()
    assert error(18) < 3 < error(44), (error(18), error(44))
    shown = through_h264(frames, 30)[..., 0] > 150
    middles = [np.nonzero(f)[1].mean() for f in shown]
    assert np.abs(np.array(middles) - (20 + 3 * np.arange(12))).max() < 1.5, middles
    rng = np.random.default_rng(1)
    kept = some_coded([frames, frames[:2]], 1.0, rng)
    assert not np.array_equal(kept[0], frames) and kept[1].base is frames
    print("video_codec: ok")


if __name__ == "__main__":
    self_test()
