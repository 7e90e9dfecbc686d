#!/usr/bin/env python3
"""Faces per second of every part of a training step of phase 1, beside another checkout's in the same run.

usage: step_bench.py [--network hifinet] [--against CHECKOUT [--against-python PYTHON]] [--rounds N] [--batch N]
Each round runs both in turns, each in a process of its own on one thread; the least CPU time of a part counts. `data` draws a batch
(sampling of crops included) from made-up windows, so that no data is needed.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
PARTS = ("data", "augmentation", "forward and backward", "optimizer and average")

# What runs in a checkout's own process; it uses only what every version of train_encoder.py has.
CHILD = r"""
import json, os, sys, time, types
sys.path.insert(0, sys.argv[1])
name, batch, steps = sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
import numpy as np, torch
torch.set_num_threads(1)
import augment, face_data, train_encoder
from expressions import CONTROLS
from networks import FACE_NETWORKS
train_encoder.keep_memory()
torch.manual_seed(1)
framing = FACE_NETWORKS[name]().framing

class MadeUp:
    def __init__(self):
        n, rng = 256, np.random.default_rng(1)
        self.images = rng.integers(0, 255, (n, framing.window, framing.window, 3), np.uint8)
        crop = torch.tensor(framing.middle).expand(n, -1)
        landmarks = face_data.crop_to_image(crop, face_data.template().expand(n, -1, -1))
        self.labels = dict(landmarks=landmarks, crop=crop, controls=torch.rand(n, len(CONTROLS)), visible=torch.ones(n, 175))
        wh = torch.tensor([640.0, 480.0]).expand(n, 2)
        self.camera = dict(rotation=torch.eye(3).expand(n, 3, 3), translation=torch.tensor([0.0, 0, -0.5]).expand(n, 3),
                           f_px=torch.full((n,), 500.0), camera_wh=wh, window=torch.tensor([320.0, 240, 200]).expand(n, 3))
        self.controls, self.shards = self.labels["controls"], [(self.images, dict(controls=self.labels["controls"].numpy()))]
    def __len__(self): return len(self.images)
    def refresh(self): pass
    def rows(self, rng, n):
        i = np.sort(rng.integers(0, len(self.images), n))
        self.last = {k: v[i] for k, v in self.camera.items()}
        return (self.images[i], *(self.labels[k][i] for k in ("landmarks", "crop", "controls", "visible")))

class Rendered(MadeUp, face_data.Rendered):
    pass

class Step(train_encoder.Trainer):
    def load_data(self):
        self.generator = torch.Generator().manual_seed(1)
        portraits, rendered = MadeUp(), Rendered()
        self.rendered = rendered
        self.mixture = face_data.Mixture(framing, portraits, rendered, None, 1, 0.2)
        eyes = train_encoder.template()[list(train_encoder.lp.OUTER_EYE_CORNERS)]
        self.losses = train_encoder.Losses(framing, float((eyes[0] - eyes[1]).norm()), self.device)
        self.losses.learn_spread(rendered), self.losses.learn_teacher(portraits)

options = types.SimpleNamespace(network=name, name="step_bench", rate=1e-4, start_from=None, resume=False, seed=1, batch=batch, samples=10**9,
                                hours=None, real_share=0.2, threads=1, freeze=int(sys.argv[5]), through=None,
                                decoders_learn=False, plain=False)
trainer = Step(options, torch.device("cpu"), 1, 0)
seconds = {}
def timed(owner, method, part):
    inner = getattr(owner, method)
    def run(*args, **named):
        began = time.process_time()
        out = inner(*args, **named)
        seconds[part] = seconds.get(part, 0) + time.process_time() - began
        return out
    setattr(owner, method, run)
timed(trainer.mixture, "batch", "data")
timed(augment, "photometric", "augmentation")
timed(train_encoder, "moved_views", "data")
timed(trainer.optimizer, "step", "optimizer and average"), timed(trainer.average, "update", "optimizer and average")
best = {}
for k in range(steps + 1):
    seconds.clear()
    began = time.process_time()
    trainer.update()
    seconds["whole"] = time.process_time() - began
    seconds["forward and backward"] = seconds["whole"] - sum(v for p, v in seconds.items() if p != "whole")
    if k:
        best = {p: min(v, best.get(p, v)) for p, v in seconds.items()}
print("RESULT", json.dumps({p: v / batch for p, v in best.items()}))
"""


def measure(python, checkout, options, cache):
    command = [python, "-c", CHILD, str(checkout), options.network, str(options.batch), str(options.steps),
               str(options.freeze if checkout == HERE else 0)]
    out = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "MIEN_CACHE": cache})
    if out.returncode:
        sys.exit(out.stderr)
    return json.loads(next(line for line in out.stdout.splitlines() if line.startswith("RESULT"))[7:])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--network", choices=("basenet", "hifinet"), default="hifinet")
    parser.add_argument("--against", type=Path, help="another checkout of this repository")
    parser.add_argument("--against-python", default=sys.executable)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--steps", type=int, default=6)
    parser.add_argument("--batch", type=int, default=96)
    parser.add_argument("--freeze", type=int, default=0, metavar="PARTS", help="of this checkout's encoder, as train_encoder.py has it")
    options = parser.parse_args()
    sides = {"this": (sys.executable, HERE)}
    if options.against:
        sides["other"] = (options.against_python, options.against.resolve() / "scripts/train")
    best = {side: {} for side in sides}
    with tempfile.TemporaryDirectory() as cache:
        for _ in range(options.rounds):
            for side, (python, checkout) in sides.items():
                for part, seconds in measure(python, checkout, options, cache).items():
                    best[side][part] = min(seconds, best[side].get(part, seconds))
    print(f"{options.network}, batches of {options.batch}, faces/s on one core" + (" (ratio to the other)" if options.against else ""))
    for part in (*PARTS, "whole"):
        rates = {side: 1 / max(times.get(part, 0), 1e-9) for side, times in best.items()}
        ratio = f"  {rates['this'] / rates['other']:.2f}x of {rates['other']:.0f}" if "other" in rates else ""
        print(f"  {part:24s}{rates['this']:8.0f}{ratio}")


if __name__ == "__main__":
    main()
