#!/usr/bin/env python3
"""CPU time of one rendered frame of a sequence, beside another checkout's in the same run, and how far their pictures differ.

usage: render_bench.py [--against CHECKOUT] [--rounds N] [--sequences N] [--frames N] [--sheet FILE.png]
Each round runs both in turns, each in a process of its own on one thread; the least time of a sequence counts. --sheet writes a picture of
some frames: the other checkout's above, this one's below.
"""
import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import cv2
import numpy as np

from paths import data

HERE = Path(__file__).resolve().parent

# What runs in a checkout's own process; it uses only what every version of make_synthetic.py has.
CHILD = r"""
import sys, time
sys.path.insert(0, sys.argv[1])
import numpy as np
import make_synthetic, expressions
from framing import FRAMINGS
from renderer.scene import Studio
from rig import Rig
framing, count, frames, seed = FRAMINGS[sys.argv[2]], int(sys.argv[3]), int(sys.argv[4]), int(sys.argv[5])
studio = Studio(Rig())
def render(k):
    rng = np.random.default_rng([seed, k])
    return [image for image, _ in make_synthetic.sequence(studio, framing, rng, "val", k, expressions.sample_sequence, frames)]
images, seconds = [], []
for k in range(count):
    render(k)  # textures are read once for many sequences
    began = time.process_time()
    images.append(render(k))
    seconds.append((time.process_time() - began) / frames)
np.savez(sys.argv[6], images=np.array(images), seconds=seconds)
"""


def measure(checkout, options, cache):
    out = Path(cache) / "out.npz"
    command = [sys.executable, "-c", CHILD, str(checkout), options.framing, str(options.sequences), str(options.frames), str(options.seed),
               str(out)]
    environment = {**os.environ, "MIEN_CACHE": cache, "MIEN_DATA": str(data().resolve()), "OMP_NUM_THREADS": "1"}
    subprocess.run(command, check=True, env=environment)
    found = np.load(out)
    return found["images"], found["seconds"]


def difference(ours, theirs):
    apart = np.abs(ours.astype(int) - theirs.astype(int))
    return f"pictures differ by {apart.mean():.3f} of 255 in the mean; {(apart > 8).mean() * 100:.2f} % of the values by more than 8"


def sheet(ours, theirs, path):
    """Three frames of every sequence, those of the other checkout above ours."""
    at = np.linspace(0, ours.shape[1] - 1, 3).astype(int)
    rows = [np.concatenate([np.concatenate(list(images[k, at]), 1) for images in (theirs, ours)], 0) for k in range(len(ours))]
    rows += [np.zeros_like(rows[0])] * (len(rows) % 2)
    pairs = [np.concatenate(rows[k:k + 2], 1) for k in range(0, len(rows), 2)]
    cv2.imwrite(str(path), np.concatenate(pairs, 0)[..., ::-1])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--against", type=Path, help="another checkout of this repository")
    parser.add_argument("--framing", default="hifinet")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--sequences", type=int, default=12)
    parser.add_argument("--frames", type=int, default=32)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--sheet", type=Path)
    options = parser.parse_args()
    sides = {"this": HERE}
    if options.against:
        sides["other"] = options.against.resolve() / "scripts/train"
    best, images = {}, {}
    with tempfile.TemporaryDirectory() as cache:
        for _ in range(options.rounds):
            for side, checkout in sides.items():
                images[side], seconds = measure(checkout, options, cache)
                best[side] = np.minimum(seconds, best.get(side, np.inf))
    for side, seconds in best.items():
        print(f"{side}: {seconds.mean() * 1e3:.2f} ms a frame")
    if "other" in sides:
        print(f"{best['other'].mean() / best['this'].mean():.2f} times as fast; {difference(images['this'], images['other'])}")
        if options.sheet:
            sheet(images["this"], images["other"], options.sheet)


if __name__ == "__main__":
    main()
