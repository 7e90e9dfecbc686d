#!/usr/bin/env python3
"""Features without pictures: what an encoder would answer to faces that only landmarks and controls describe.

A small network learns, from streamed features, what of them follows from landmarks, pose and controls. To its answer for a new performance of
a new person (landmark_stream.py) comes what it could not explain of a rendered track: skin, hair, light, noise, and errors of tracking. So a
decoder meets every performance with ever other people, and cannot learn by heart whose features go with which controls.
Run as a program it says how much of the features of other people it explains.
"""
import argparse
from pathlib import Path

import numpy as np
import torch
from torch import nn

import expressions
import landmark_stream
import stream_features
from paths import cache
from whitening import Whitening

HIDDEN = 384
LAG = (0.008, 0.006, 0.025, 0.02)  # deviations of a tracked crop from that of the landmarks before: middle in crop sides, log side, roll


def described(points, pose, controls):
    """What the network is told: landmarks in the crop less the template, pose and controls, [...,411]."""
    return torch.cat([(points - landmark_stream.template()).flatten(-2), pose, controls], -1)


class Simulator(nn.Module):
    def __init__(self, told, features):
        super().__init__()
        self.net = nn.Sequential(nn.Linear(told, HIDDEN), nn.GELU(), nn.Linear(HIDDEN, HIDDEN), nn.GELU(), nn.Linear(HIDDEN, features))

    def forward(self, x):
        return self.net(x)


def fit(data, whitening, steps, seed=0):
    """(simulator of whitened features, normalisation of what it is told) learnt from tracks."""
    torch.manual_seed(seed)
    told = lambda rows, at: described(*(data[k][rows, at].float() for k in ("points", "pose", "controls")))
    tracks, frames = data["features"].shape[:2]
    normal = Whitening.of(told(torch.randint(tracks, (20000,)), torch.randint(frames, (20000,))))
    simulator = Simulator(len(normal.mean), data["features"].shape[2])
    optimiser = torch.optim.AdamW(simulator.parameters(), lr=2e-3, weight_decay=1e-3)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, 2e-3, total_steps=steps, pct_start=0.1)
    for _ in range(steps):
        rows, at = torch.randint(tracks, (768,)), torch.randint(frames, (768,))
        error = simulator(normal(told(rows, at))) - whitening(data["features"][rows, at].float())
        loss = error.square().mean()
        optimiser.zero_grad(), loss.backward(), optimiser.step(), schedule.step()
    return simulator.eval().requires_grad_(False), normal


class Simulated:
    """Whitened features of new performances: batches as of train_streamed.Tracks."""

    def __init__(self, data, whitening, steps, pool, seed):
        self.data, self.whitening = data, whitening
        self.simulator, self.normal = fit(data, whitening, steps, seed)
        self.rig, self.rng = landmark_stream.PointRig(), np.random.default_rng(seed)
        self.frames = data["features"].shape[1]
        self.told, self.controls = (torch.cat(x) for x in zip(*(self.fresh() for _ in range(pool // 32))))
        self.at = 0

    def fresh(self, count=32):
        """What the simulator is told of new performances, f16, and their controls."""
        points, pose, controls = landmark_stream.tracked(self.rig, self.rng, count, self.frames, expressions.sample_lesson, LAG)
        return described(points, pose, controls).half(), controls.half()

    def replace(self, count):
        told, controls = self.fresh(count)
        rows = (self.at + torch.arange(count)) % len(self.told)
        self.told[rows], self.controls[rows] = told, controls
        self.at = (self.at + count) % len(self.told)

    @torch.no_grad()
    def tracks(self, count):
        """Whitened features [count,frames,n] and controls."""
        rows, others = torch.randint(len(self.told), (count,)), torch.randint(len(self.data["features"]), (count,))
        told = described(*(self.data[k][others].float() for k in ("points", "pose", "controls")))
        unexplained = self.whitening(self.data["features"][others].float()) - self.simulator(self.normal(told))
        features = self.simulator(self.normal(self.told[rows].float())) + unexplained
        return features, self.controls[rows].float()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--network", default="hifinet")
    parser.add_argument("--stream", type=Path, default=cache() / "stream")
    parser.add_argument("--steps", type=int, default=2000)
    args = parser.parse_args()
    torch.set_num_threads(1)
    every = stream_features.load(args.stream / "train", args.network)
    kept = len(every["features"]) * 4 // 5
    data, others = ({k: v[rows] for k, v in every.items()} for rows in (slice(0, kept), slice(kept, None)))
    whitening = Whitening.of(data["features"].flatten(0, 1)[::5].float())
    simulator, normal = fit(data, whitening, args.steps)
    for name, seen in (("people learnt from", data), ("other people", others)):
        wanted = whitening(seen["features"].float())
        found = simulator(normal(described(*(seen[k].float() for k in ("points", "pose", "controls")))))
        within = lambda x: (x - x.mean(1, keepdim=True)).square().mean()
        share = 1 - (wanted - found).square().mean() / (wanted - wanted.mean((0, 1))).square().mean()
        print(f"{name}: explains {share:.3f} of the variance, {1 - within(wanted - found) / within(wanted):.3f} of that within tracks")


if __name__ == "__main__":
    main()
