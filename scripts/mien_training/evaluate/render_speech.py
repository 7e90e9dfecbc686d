"""Video of a face animated from audio alone; with --sheet an image of its mouth over time.

usage: python3 -m mien_training.evaluate.render_speech SPEECH OUT.mp4 [--mien PROGRAM] [--models FOLDER]
       [--sheet SHEET.png] [--seconds A B]
SPEECH is any file whose audio `mien track` reads. Needs ffmpeg.
"""
import argparse
import csv
import io
import subprocess
from pathlib import Path

import cv2
import numpy as np

from mien_training.data.expressions import CONTROLS
from mien_training.paths import ROOT
from mien_training.renderer import background, camera, lighting, look
from mien_training.renderer.rig import Rig
from mien_training.renderer.scene import Figure, Scene, Studio

FPS, SIDE, SEED = 30, 320, 33


def animation(arguments):
    """(times [frames] in seconds, controls f32 [frames,52], voice activity [frames])"""
    command = [arguments.mien, "track", arguments.speech, "--mode", "audio", "--quiet"]
    command += ["--models", arguments.models] if arguments.models else []
    rows = list(csv.DictReader(io.StringIO(subprocess.run(command, capture_output=True, check=True, text=True).stdout)))
    value = lambda row, name: float(row[name] or 0)
    return (np.array([value(r, "t_ms") / 1000 for r in rows]),
            np.float32([[value(r, c) for c in CONTROLS] for r in rows]), np.array([value(r, "vad") for r in rows]))


def pictures(curve):
    """Yields uint8 [SIDE,SIDE,3]."""
    rng, studio = np.random.default_rng(SEED), Studio(Rig())
    person = look.sample(rng, "test")
    person.glasses = person.hat = person.beard = None
    head = studio.rig.identity(person.identity[None])[0]
    figure, lens = Figure(studio, person, head), camera.Camera(SIDE, SIDE, SIDE / 2 / np.tan(np.radians(30)))
    light = lighting.sample(rng, "lab")
    scenery = cv2.GaussianBlur(background.piece(rng, "lab", SIDE, SIDE), (0, 0), 5)
    turn, rest = camera.pose_at(lens,
                                studio.rig.landmarks(head), (0, 0, 0), (np.array([SIDE / 2, SIDE / 2]), 0.8 * SIDE))
    for controls in curve:
        vertices = head + studio.rig.expression(controls[None])[0]
        scene = Scene(figure, vertices, turn, rest, studio.rig.landmarks(vertices), light,
                      lens.view(0, 0, SIDE, SIDE, SIDE), scenery)
        yield studio.render(scene)[0]


def encode(frames, speech, path):
    command = ["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{SIDE}x{SIDE}", "-r",
               str(FPS), "-i", "-",
               "-i", speech, "-map", "0:v", "-map", "1:a", "-c:v", "libx264", "-preset", "slow", "-crf", "26",
               "-pix_fmt", "yuv420p", "-c:a", "aac", "-b:a", "48k", "-shortest", "-movflags", "+faststart", str(path)]
    with subprocess.Popen(command, stdin=subprocess.PIPE) as process:
        for frame in frames:
            process.stdin.write(frame.tobytes())
    if process.returncode:
        raise RuntimeError("ffmpeg failed")


def sheet(frames, times, columns=10):
    """Every second mouth, with its time in seconds."""
    tiles = []
    for frame, t in list(zip(frames, times))[::2]:
        tile = np.ascontiguousarray(frame[SIDE // 2:, SIDE // 5:-SIDE // 5])
        cv2.putText(tile, f"{t:.2f}", (4, 14), cv2.FONT_HERSHEY_SIMPLEX, 0.42, (255, 255, 0), 1, cv2.LINE_AA)
        tiles.append(tile)
    tiles += [np.zeros_like(tiles[0])] * (-len(tiles) % columns)
    return np.vstack([np.hstack(tiles[i:i + columns]) for i in range(0, len(tiles), columns)])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("speech")
    parser.add_argument("out", type=Path)
    parser.add_argument("--mien", default=str(ROOT / "build/release/apps/mien/mien"))
    parser.add_argument("--models")
    parser.add_argument("--sheet", type=Path)
    parser.add_argument("--seconds", type=float, nargs=2, default=(0, 1e9), help="of the sheet")
    arguments = parser.parse_args()
    times, curve, _ = animation(arguments)
    frames = list(pictures(curve))
    encode(frames, arguments.speech, arguments.out)
    if arguments.sheet:
        chosen = [i for i, t in enumerate(times) if arguments.seconds[0] <= t < arguments.seconds[1]]
        cv2.imwrite(str(arguments.sheet), sheet([frames[i] for i in chosen], times[chosen])[..., ::-1])


if __name__ == "__main__":
    main()
