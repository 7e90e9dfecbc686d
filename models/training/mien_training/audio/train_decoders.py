"""Phase 2: decoders of controls and voice activity with a frozen encoder, starting with those of phase 1.

usage: python3 -m mien_training.audio.train_decoders ENCODER.pt --out decoders.pt [--minutes 15]
Controls learn the video teacher's curves where it responds (teacher.py), otherwise visemes with coarticulation
(visemes.py): smooth L1 of position and velocity (Navarro et al. 2023). Voice activity learns with cross entropy.
Examples are used several times from a pool, because creating them costs more than learning from them.
"""
import argparse
import json
import time
from pathlib import Path

import numpy as np
import torch
from torch import nn

from mien_convert.atomic_files import whole
from mien_training.audio import examples, losses, targets
from mien_training.audio.audio_net import activity_decoder, controls_decoder
from mien_training.audio.features import features
from mien_training.audio.recognition import load

SHARES = {"av": 0.26, "people": 0.2, "animated": 0.14, "synthetic": 0.2, "librispeech": 0.08, "librispeech_text": 0.07,
          "commands": 0.05}
NOISE_ALONE = 0.25
SECONDS, BATCH, RATE, SEED = 6.0, 24, 3e-3, 1
POOL = 1500            # scenes
FRESH, REUSE = 8, 2    # new scenes at a time, and steps between them once the pool is full


class Scenes(examples.Endless):
    """(features [t,130], controls, weights, speech)."""

    def __init__(self, seconds, seed, split="train"):
        super().__init__(seed)
        self.speech, self.seconds, self.split = examples.Speech(split, SHARES), seconds, split

    def make(self, rng):
        if rng.random() < NOISE_ALONE:
            scene = examples.noise_scene(rng, self.split, self.seconds)
        else:
            scene = examples.speech_scene(rng, self.speech, self.split, self.seconds, (0.75, 1.35))
        x = np.float32(features(scene.sound, examples.some_warp(rng)))
        return x, *targets.of_scene(scene, len(x))


class Pool:
    """The latest examples, as embeddings and targets."""

    def __init__(self, network, source, size):
        self.network, self.source, self.size, self.rows = network, iter(source), size, []

    @torch.no_grad()
    def add(self, count):
        made = [next(self.source) for _ in range(count)]
        x = self.network(torch.stack([torch.as_tensor(m[0]) for m in made]))[0]
        for embedding, (_, controls, weights, speech) in zip(x, made):
            row = tuple(torch.as_tensor(v) for v in (embedding, controls, weights, np.int64(speech)))
            self.rows.append(row)
        self.rows = self.rows[-self.size:]

    def batch(self, rng, count):
        return [torch.stack(v) for v in zip(*(self.rows[k] for k in rng.integers(len(self.rows), size=count)))]


def train(network, decoders, minutes):
    rng = np.random.default_rng(SEED)
    pool = Pool(network, torch.utils.data.DataLoader(Scenes(SECONDS, SEED), batch_size=None), POOL)
    pool.add(BATCH * 4)
    importance = losses.importance_of(torch.stack([r[1] for r in pool.rows]))
    parameters = list(decoders.parameters())
    optimizer = torch.optim.AdamW(parameters, RATE, weight_decay=0.01)
    began = shown = time.time()
    step, sums, count = 0, np.zeros(2), 0
    while (done := (time.time() - began) / 60 / minutes) < 1:
        if len(pool.rows) < POOL or step % REUSE == 0:
            pool.add(FRESH)
        embedding, controls, weights, speech = pool.batch(rng, BATCH)
        answers = {name: decoder(embedding)[0] for name, decoder in decoders.items()}
        parts = [losses.controls_loss(answers["controls"], controls, weights, importance),
                 losses.activity_loss(answers["activity"], speech)]
        optimizer.zero_grad(set_to_none=True)
        sum(parts).backward()
        nn.utils.clip_grad_norm_(parameters, 1.0)
        for group in optimizer.param_groups:
            group["lr"] = RATE * min(1, (step + 1) / 50) * max(0.5 + 0.5 * np.cos(np.pi * done), 0.01)
        optimizer.step()
        step, sums, count = step + 1, sums + [v.item() for v in parts], count + 1
        if time.time() - shown > 30:
            print(step, f"{done * minutes:.1f} min, {len(pool.rows)} scenes", *np.round(sums / count, 5), flush=True)
            shown, sums, count = time.time(), np.zeros(2), 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("encoder", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--minutes", type=float, default=15)
    args = parser.parse_args()
    torch.set_num_threads(1)
    network, _ = load(args.encoder)
    decoders = nn.ModuleDict({"controls": controls_decoder(), "activity": activity_decoder()})
    decoders.load_state_dict(torch.load(args.encoder, map_location="cpu")["decoders"])
    train(network, decoders, args.minutes)
    args.out.parent.mkdir(parents=True, exist_ok=True)
    with whole(args.out) as out:
        torch.save({f"{name}_decoder": d.state_dict() for name, d in decoders.items()}, out)
    print(json.dumps({"out": args.out.name}))


if __name__ == "__main__":
    main()
