"""Renders tests/data/demo.mp4, eight seconds of a speaking face from held-out assets, and its true controls.

demo_truth.csv has one row per frame: its number and the 52 controls. Needs ffmpeg and espeak-ng.
"""
import argparse
import csv
import io
import subprocess
import wave

import cv2
import numpy as np

from mien_training.data import expressions
from mien_training.data.expressions import CONTROLS, INDEX, both, min_jerk
from mien_training.paths import ROOT
from mien_training.renderer import background, camera, lighting, look, motion
from mien_training.renderer.rig import Rig
from mien_training.renderer.scene import Figure, Scene, Studio

FRAMES, FPS, WIDTH, HEIGHT = 240, 30, 640, 480
SEED = 33
SENTENCE = "Hello! This face never lived. It was drawn to be followed: it speaks, it blinks, and it smiles at you."
NECK = np.array([0, -8, -3])  # the head turns about it, head frame, cm

# Moves of units: (unit, frame it starts, frames to rise, to hold, to fall, height).
MOVES = [("browInnerUp", 6, 6, 10, 10, 0.7), ("browOuterUp", 6, 6, 10, 10, 0.6), ("browDown", 62, 8, 18, 10, 0.7),
         ("noseSneer", 66, 8, 8, 10, 0.4), ("browOuterUp", 120, 5, 8, 8, 0.8), ("eyeWide", 120, 5, 8, 8, 0.6),
         ("cheekSquint", 204, 10, 26, 10, 0.7), ("mouthSmile", 196, 12, 32, 12, 0.9), ("eyeSquint", 206, 8, 22, 10,
                                                                                       0.4)]
# (frame, yaw, pitch, roll) in degrees, and gaze (frame, left, up) in -1..1.
HEAD = [(0, 0, 0, 0), (30, 8, 3, 2), (75, -22, -2, -4), (120, 5, -6, 0), (160, 24, 4, 5), (200, 0, 2, -3), (239, -4, -2,
                                                                                                            0)]
GAZE = [(0, 0, 0), (28, 0.3, 0), (72, -0.5, 0.1), (96, 0.2, 0), (132, 0, 0.5), (150, 0.6, -0.1), (178, 0.1, 0), (239, 0,
                                                                                                                 0)]


def speak(rate=16000):
    """The sentence as f32 samples, FRAMES long."""
    spoken = subprocess.run(["espeak-ng", "-v", "en-us+f3", "-s", "155", "--stdout", SENTENCE], capture_output=True,
                            check=True).stdout
    with wave.open(io.BytesIO(spoken)) as file:
        samples = np.frombuffer(file.readframes(10 ** 8), np.int16).astype(np.float32) / 32768
        source_rate = file.getframerate()
    length = int(rate * FRAMES / FPS)
    t = np.arange(length) / rate * source_rate - 0.25 * source_rate
    return np.interp(t, np.arange(len(samples)), samples, left=0, right=0).astype(np.float32)


def loudness(samples, rate=16000):
    """Loudness and brightness of the voice in each frame, 0..1, [FRAMES,2]."""
    hop = rate // FPS
    rows = []
    for t in range(FRAMES):
        piece = samples[max(0, t * rate // FPS - hop // 2):][:2 * hop]
        spectrum = np.abs(np.fft.rfft(piece * np.hanning(len(piece)))) ** 2
        hertz = np.fft.rfftfreq(len(piece), 1 / rate)
        level = 10 * np.log10(np.mean(piece ** 2) + 1e-7)
        centre = (spectrum * hertz).sum() / (spectrum.sum() + 1e-6)
        rows.append([np.clip((level + 45) / 30, 0, 1), np.clip((centre - 500) / 2500, 0, 1)])
    return np.array(rows)


def smooth(curve, width):
    window = np.hanning(width + 2)[1:-1]
    return np.convolve(np.pad(curve, width // 2, "edge"), window / window.sum(), "valid")


def raise_unit(curve, unit, value):
    for name in both(unit) if unit in expressions.PAIRED else (unit,):
        curve[:, INDEX[name]] = np.maximum(curve[:, INDEX[name]], value)


def mouth(curve, samples):
    """Opens with the loudness; rounds with dark and widens with bright sounds."""
    level, bright = loudness(samples).T
    level, bright = smooth(level, 3), smooth(bright, 3)
    raise_unit(curve, "jawOpen", 0.55 * level ** 1.5 * (1 - 0.5 * bright))
    raise_unit(curve, "mouthLowerDown", 0.35 * level * bright)
    raise_unit(curve, "mouthStretch", 0.4 * level * bright)
    raise_unit(curve, "mouthFunnel", 0.55 * level * np.clip(1 - 3 * bright, 0, 1))
    raise_unit(curve, "mouthUpperUp", 0.2 * level)
    raise_unit(curve, "mouthPress", 0.3 * np.clip(1 - 4 * level, 0, 1))


def through(keys):
    """Curves [FRAMES,k] through keys (frame, values...) with minimum-jerk moves."""
    out = np.zeros((FRAMES, len(keys[0]) - 1))
    out[0] = keys[0][1:]
    for (start, *a), (end, *b) in zip(keys, keys[1:]):
        out[start + 1:end + 1] = np.array(a) + min_jerk(end - start)[:, None] * (np.array(b) - a)
    return out


def controls(rng, samples):
    """The performance, f32 [FRAMES,52]."""
    curve = np.zeros((FRAMES, len(CONTROLS)), np.float32)
    mouth(curve, samples)
    for unit, start, rise, hold, fall, height in MOVES:
        value = np.zeros(FRAMES)
        shape = height * np.concatenate([min_jerk(rise), np.ones(hold), 1 - min_jerk(fall)])
        value[start:start + len(shape)] = shape[:FRAMES - start]
        raise_unit(curve, unit, value)
    gaze = np.stack([expressions.gaze(*row) for row in through(GAZE)])
    return expressions.legalise(np.maximum(curve, expressions.blinks(rng, FRAMES, FPS)) + gaze)


def pictures(rng, curve):
    """Yields uint8 [HEIGHT,WIDTH,3]."""
    studio = Studio(Rig())
    person = look.sample(rng, "test")
    person.glasses = person.hat = None
    head = studio.rig.identity(person.identity[None])[0]
    figure, lens = Figure(studio, person, head), camera.Camera(WIDTH, HEIGHT, WIDTH / 2 / np.tan(np.radians(30)))
    environment = "lab"
    light = lighting.sample(rng, environment)
    scenery = cv2.GaussianBlur(background.piece(rng, environment, WIDTH, HEIGHT), (0, 0), 3)
    ahead, rest = camera.pose_at(lens, studio.rig.landmarks(head), (0, 0, 0), (np.array([325.0, 250.0]), 250.0))
    angles = np.radians(through(HEAD)) + motion.tremor(rng, FRAMES, np.radians([0.2, 0.2, 0.1]))
    for t in range(FRAMES):
        vertices = head + studio.rig.expression(curve[t:t + 1])[0]
        turn = ahead @ camera.rotation(*angles[t])
        scene = Scene(figure, vertices, turn, rest + (ahead - turn) @ NECK, studio.rig.landmarks(vertices), light,
                      lens.view(0, 0, WIDTH, WIDTH, HEIGHT), scenery)
        yield studio.render(scene)[0]


def encode(frames, samples, path):
    sound = path.with_suffix(".wav")
    with wave.open(str(sound), "wb") as file:
        file.setparams((1, 2, 16000, 0, "NONE", ""))
        file.writeframes((np.clip(samples, -1, 1) * 32767).astype(np.int16).tobytes())
    command = ["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{WIDTH}x{HEIGHT}", "-r",
               str(FPS),
               "-i", "-", "-i", str(sound), "-c:v", "libx264", "-preset", "slow", "-crf", "24", "-pix_fmt", "yuv420p",
               "-c:a", "aac", "-b:a", "48k", "-shortest", "-movflags", "+faststart", str(path)]
    with subprocess.Popen(command, stdin=subprocess.PIPE) as process:
        for frame in frames:
            process.stdin.write(frame.tobytes())
    sound.unlink()
    if process.returncode:
        raise RuntimeError("ffmpeg failed")


def main():
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    folder = ROOT / "tests/data"
    folder.mkdir(parents=True, exist_ok=True)
    rng, samples = np.random.default_rng(SEED), speak()
    curve = controls(rng, samples)
    encode(pictures(rng, curve), samples, folder / "demo.mp4")
    with open(folder / "demo_truth.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["frame", *CONTROLS])
        writer.writerows([t, *(f"{x:.4f}" for x in row)] for t, row in enumerate(curve))


if __name__ == "__main__":
    main()
