"""Trains the yardstick: the controls decoder of true landmarks and head poses, from landmark_stream.py.

usage: python3 -m mien_training.phase2.train_yardstick --steps N [--out CHECKPOINT]
It resumes; evaluate_yardstick.py evaluates the checkpoint.
"""
import argparse
import time
from pathlib import Path

import numpy as np
import torch

from mien_training.data import expressions
from mien_training.data import landmark_points as lp
from mien_training.data.expressions import CONTROLS, MIRROR
from mien_training.networks.architectures import ControlsDecoder
from mien_training.paths import cache
from mien_training.phase1.losses import censored
from mien_training.phase2 import landmark_stream
from mien_training.phase2.amplitude_losses import discordance, discordance_within
from mien_training.phase2.decoder_losses import temporal_loss
from mien_training.phase2.decoder_run import Run

FRAMES, BATCH = 90, 64
POOL, FRESH = 2500, 10    # sequences to draw from, and how many of them each batch replaces
VELOCITY, ACCELERATION = 0.05, 0.01
CONCORDANCE = 0.05   # weight of the loss that keeps the amplitude
POSE_MIRROR = torch.tensor([1.0, -1, -1, -1, 1, 1, -1, 1, 1])


class Pool:
    """A pool of sequences; each batch replaces some, so each is used a few times. `seed`: sequences made before."""

    def __init__(self, rig, seed):
        self.rig, self.rng, self.at, self.made = rig, np.random.default_rng([0, seed]), 0, 0
        self.features = torch.empty(POOL, FRAMES, landmark_stream.KNOWN, dtype=torch.float16)
        self.controls = torch.empty(POOL, FRAMES, len(CONTROLS), dtype=torch.float16)
        for _ in range(0, POOL, 64):
            self.replace(min(64, POOL - self.at))

    def replace(self, count):
        features, controls = landmark_stream.batch(self.rig, self.rng, count, FRAMES, expressions.sample_lesson)
        rows = (self.at + torch.arange(count)) % len(self.features)
        self.features[rows], self.controls[rows] = features.half(), controls.half()
        self.at = (self.at + count) % len(self.features)
        self.made += count

    def batch(self):
        """Features and controls of BATCH sequences, half of them mirrored."""
        rows = torch.randint(POOL, (BATCH,))
        features, controls = self.features[rows].float(), self.controls[rows].float()
        half = BATCH // 2
        features[:half], controls[:half] = mirrored(features[:half]), controls[:half][..., MIRROR]
        self.replace(FRESH)
        return features, controls


def mirrored(features):
    """The input of landmark_stream.known for mirrored faces."""
    points, pose = features[..., :-9].unflatten(-1, (-1, 2)), features[..., -9:]
    template = landmark_stream.template()
    points = (points + template - 0.5)[..., lp.MIRROR, :] * torch.tensor([-1.0, 1.0]) + 0.5 - template
    return torch.cat([points.flatten(-2), pose * POSE_MIRROR], -1)


class Task:
    """Error of values and of differences, each control relative to its spread, and 1 - concordance."""

    def __init__(self, controls):
        weight = 1 / (controls.flatten(0, 1).float().std(0) + 0.05)
        self.weight, self.seen = weight / weight.mean(), torch.ones(1, FRAMES, 1)
        self.seen[:, :2] = 0.5

    def loss(self, output, target):
        ours, weight = censored(output, target), self.seen.expand(*target.shape)
        within, over_all = discordance_within(ours, target, weight), discordance(ours, target, weight)
        values = temporal_loss(ours, target, self.weight * self.seen, VELOCITY, ACCELERATION)
        return values + CONCORDANCE * (within + over_all).mean() / 2


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=cache() / "runs/yardstick.pt")
    parser.add_argument("--steps", type=int, default=8000)
    parser.set_defaults(decoder="controls", rate=4e-3, seed=0)
    args = parser.parse_args()
    torch.set_num_threads(1)
    args.out.parent.mkdir(parents=True, exist_ok=True)
    run = Run(args, lambda: ControlsDecoder(landmark_stream.KNOWN))
    before = run.known["sequences"] if run.known else 0
    pool = Pool(landmark_stream.PointRig(), before)
    run.begin(pool.features.flatten(0, 1)[::3])
    task, total, began = Task(pool.controls), 0.0, time.time()
    while run.step < args.steps:
        features, controls = pool.batch()
        total += run.advance(task.loss(run.answer(features), controls))
        if run.step % 50 == 0:
            print(f"step {run.step} sequences {before + pool.made} loss {total / 50:.5f} {time.time() - began:.0f} s",
                  flush=True)
            total = 0.0
        if run.step % 200 == 0:
            run.save(sequences=before + pool.made)
    run.save(sequences=before + pool.made)


if __name__ == "__main__":
    main()
