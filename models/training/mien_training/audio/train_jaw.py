"""Trains the jaw decoder on the encoder of an audionet.mien: 1 - correlation of each clip, and the level.

usage: python3 -m mien_training.audio.train_jaw --out JAW.pt [--model audionet.mien]
       python3 -m mien_training.audio.train_jaw --hold-out s30 s31 s33 s34      leaves out one speaker at a time
"""
import argparse
import json
from pathlib import Path

import numpy as np
import torch
import torch.nn.functional as F
from torch import nn

from mien_convert.atomic_files import whole
from mien_training.audio import jaw_data
from mien_training.audio.features import seconds_of_steps
from mien_training.audio.jaw import JawDecoder
from mien_training.audio.jaw_data import NOISE, SEEN, SYNTHETIC
from mien_training.paths import ROOT

KINDS = {SEEN: 0.7, SYNTHETIC: 0.2, NOISE: 0.1}  # shares of a batch
MAIN = {"s1": 2.0}                               # how much more often than other people
FEW = 5                                          # clips: people with fewer are left out
LEVEL = 2.0
STEPS, BATCH, RATE, DECAY = 300, 32, 5e-3, 0.05
SPREAD = 0.3                                     # of noise on the inputs, in deviations
EVERY = 100                                      # steps between validations
FLAT = 1e-2                                      # added to sums of squares: a flat curve has no correlation


def correlation(said, truth, known):
    """[n,t] -> [n], over the known steps."""
    count = known.sum(1, keepdim=True).clamp(min=1)
    said, truth = (known * (v - (v * known).sum(1, keepdim=True) / count) for v in (said, truth))
    return (said * truth).sum(1) / torch.sqrt(((said ** 2).sum(1) + FLAT) * ((truth ** 2).sum(1) + FLAT))


def loss_of(said, truth, known, moving):
    """`moving` [n]: rows whose curve has a shape."""
    level = (F.smooth_l1_loss(said, truth, beta=0.05, reduction="none") * known).sum() / known.sum()
    return (moving * (1 - correlation(said, truth, known))).sum() / moving.sum().clamp(min=1) + LEVEL * level


class Rows:
    def __init__(self, data, held_out=None):
        self.kind, self.speaker = data["kind"], data["speaker"]
        self.inputs, self.jaw = torch.from_numpy(np.float32(data["inputs"])), torch.from_numpy(data["jaw"])
        self.known = torch.from_numpy(np.float32(data["known"]))
        kept = self.speaker != held_out
        self.of_kind = {kind: np.flatnonzero((self.kind == kind) & kept) for kind in KINDS}
        seen = self.of_kind[SEEN]
        people = [who for who in np.unique(self.speaker[seen]) if (self.speaker[seen] == who).sum() >= FEW]
        self.people = {who: seen[self.speaker[seen] == who] for who in people}
        self.shares = np.array([MAIN.get(who, 1.0) for who in people])

    def pick(self, rng, kind):
        rows = self.of_kind[kind]
        if kind == SEEN:
            rows = self.people[rng.choice(list(self.people), p=self.shares / self.shares.sum())]
        return rows[rng.integers(len(rows))]

    def batch(self, rng, count):
        rows = [self.pick(rng, kind) for kind in rng.choice(list(KINDS), count, p=list(KINDS.values()))]
        moving = torch.from_numpy(np.float32(self.kind[rows] != NOISE))
        return self.inputs[rows], self.jaw[rows], self.known[rows], moving

    def normalise(self, decoder):
        x = self.inputs[self.of_kind[SEEN]].flatten(0, 1)
        decoder.mean.copy_(x.mean(0))
        decoder.deviation.copy_(x.std(0).clamp(min=1e-3))


def train(rows, validate=None):
    torch.manual_seed(1)
    rng, decoder = np.random.default_rng(1), JawDecoder()
    rows.normalise(decoder)
    optimizer = torch.optim.AdamW(decoder.parameters(), RATE, weight_decay=DECAY)
    for step in range(1, STEPS + 1):
        inputs, truth, known, moving = rows.batch(rng, BATCH)
        inputs = inputs + SPREAD * decoder.deviation * torch.randn_like(inputs)
        loss = loss_of(decoder(inputs)[0], truth, known, moving)
        optimizer.zero_grad(set_to_none=True)
        loss.backward()
        nn.utils.clip_grad_norm_(decoder.parameters(), 1.0)
        for group in optimizer.param_groups:
            group["lr"] = RATE * min(1, step / 20) * (0.51 + 0.49 * np.cos(np.pi * step / STEPS))
        optimizer.step()
        if validate and step % EVERY == 0:
            print(step, f"loss {loss.item():.3f}", validate(decoder), flush=True)
    return decoder


@torch.no_grad()
def by_clip(decoder, data, speaker):
    """Correlation of each clean clip of a speaker, over the frames of the video."""
    clean = [not name.endswith("_spoiled") for name in data["name"]]
    chosen = np.flatnonzero((data["speaker"] == speaker) & (data["kind"] == SEEN) & clean)
    said = decoder(torch.from_numpy(np.float32(data["inputs"][chosen])))[0].clamp(0, 1).numpy()
    frames = np.arange(0, jaw_data.SECONDS, 1 / 25)
    at = lambda curve: np.interp(frames, seconds_of_steps(jaw_data.STEPS), curve)
    return [float(np.corrcoef(at(a), at(b))[0, 1]) for a, b in zip(said, data["jaw"][chosen])]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path)
    parser.add_argument("--model", type=Path, default=ROOT / "models/audionet.mien")
    parser.add_argument("--hold-out", nargs="*", default=[], help="speakers to leave out, one at a time")
    args = parser.parse_args()
    torch.set_num_threads(1)
    data = dict(jaw_data.cached(args.model))
    for speaker in args.hold_out:
        print(speaker, end=" ", flush=True)
        train(Rows(data, speaker), lambda decoder: round(float(np.nanmean(by_clip(decoder, data, speaker))), 3))
    if args.out:
        decoder = train(Rows(data))
        args.out.parent.mkdir(parents=True, exist_ok=True)
        with whole(args.out) as out:
            torch.save(decoder.state_dict(), out)
        print(json.dumps({"out": args.out.name}))


if __name__ == "__main__":
    main()
