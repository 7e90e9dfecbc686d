#!/usr/bin/env python3
"""Phase 1: AudioNet's encoder learns phonemes, by CTC (Graves et al. 2006) and, where their times are known, step by step.

usage: python3 -m voice.train_encoder [--name audionet] [--minutes 60] [...]      (in scripts/train)
CTC alone is free to answer late; the second loss makes the phoneme come when it is spoken. Resumable.
"""
import argparse
import json
import math
import time
from pathlib import Path

import torch
import torch.nn.functional as F
from torch import nn

from paths import cache
from voice import recognise, scenes
from voice.audio_net import Encoder, PhonemeHeads


class Learner:
    def __init__(self, args):
        self.args, self.device = args, "cuda" if torch.cuda.is_available() else "cpu"
        self.network, self.heads = Encoder(), PhonemeHeads()
        self.path = cache() / "runs" / args.name / "last.pt"
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.step, self.spent = 0, 0.0
        start = self.path if self.path.exists() else args.start_from
        state = torch.load(start, map_location="cpu") if start else None
        if state:
            self.network.load_state_dict(state["encoder"]), self.heads.load_state_dict(state["heads"])
        else:
            self.network.mean[:], self.network.deviation[:] = scenes.normalisation()
        self.network.to(self.device), self.heads.to(self.device)
        self.parameters = [*self.network.parameters(), *self.heads.parameters()]
        self.optimizer = torch.optim.AdamW(self.parameters, args.rate, weight_decay=0.01)
        if start == self.path:
            self.optimizer.load_state_dict(state["optimizer"])
            self.step, self.spent = state["step"], state["spent"]

    def rate(self):
        """Warm-up, then down along a cosine to the end of the time given."""
        done = min(self.spent / (60 * self.args.minutes), 1)
        return self.args.rate * min(1, (self.step + 1) / 100) * (0.01 + 0.99 * 0.5 * (1 + math.cos(math.pi * done)))

    def learn(self, batch):
        features, frames, targets, lengths = (v.to(self.device) for v in batch)
        sequence, frame = self.heads(self.network(features)[0])
        steps = torch.full((len(features),), features.shape[1], dtype=torch.long)
        ctc = F.ctc_loss(sequence.transpose(0, 1), targets, steps, lengths, reduction="sum", zero_infinity=True) / lengths.sum()
        timed = F.cross_entropy(frame.flatten(0, 1), frames.flatten(), label_smoothing=0.05)
        self.optimizer.zero_grad(set_to_none=True)
        (ctc + self.args.timed * timed).backward()
        nn.utils.clip_grad_norm_(self.parameters, 2.0)
        for group in self.optimizer.param_groups:
            group["lr"] = self.rate()
        self.optimizer.step()
        return ctc.item(), timed.item(), (frame.argmax(-1) == frames).float().mean().item()

    def save(self):
        state = {"encoder": self.network.state_dict(), "heads": self.heads.state_dict(), "optimizer": self.optimizer.state_dict(),
                 "step": self.step, "spent": self.spent, "seconds_heard": self.step * self.args.batch * self.args.seconds}
        torch.save(state, self.path.with_suffix(".partial"))
        self.path.with_suffix(".partial").replace(self.path)

    def validate(self):
        self.network.eval(), self.heads.eval()
        network, heads = self.network.cpu(), self.heads.cpu()
        report = {group: round(recognise.error_rate(network, heads, group, "val", 40), 4) for group in ("synthetic", "librispeech_text")}
        self.network.train().to(self.device), self.heads.train().to(self.device)
        return report

    def run(self):
        data = scenes.PhonemeBatches("train", self.args.batch, self.args.seconds, self.args.seed + self.step, self.args.hard)
        if self.args.synthetic_only:
            data.speech = scenes.Speech("train", {"synthetic": 1})
        loader = iter(torch.utils.data.DataLoader(data, batch_size=None, num_workers=self.args.workers))
        saved = shown = time.time()
        sums, count = [0.0] * 3, 0
        while self.spent < 60 * self.args.minutes:
            began = time.time()
            sums, count = [a + b for a, b in zip(sums, self.learn(next(loader)))], count + 1
            self.step += 1
            self.spent += time.time() - began
            if time.time() - shown > 30:
                print(self.step, f"{self.spent / 60:.1f} min", *(f"{s / count:.4f}" for s in sums), flush=True)
                sums, count, shown = [0.0] * 3, 0, time.time()
            if time.time() - saved > 60 * self.args.validate:
                self.save()
                print(self.step, json.dumps(self.validate()), flush=True)
                saved = time.time()
        self.save()
        print("end", self.step, json.dumps(self.validate()), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--name", default="audionet", help="of the run, in $MIEN_CACHE/runs")
    parser.add_argument("--start-from", type=Path, help="checkpoint")
    parser.add_argument("--minutes", type=float, default=60)
    parser.add_argument("--batch", type=int, default=24)
    parser.add_argument("--seconds", type=float, default=4.0)
    parser.add_argument("--rate", type=float, default=3e-3)
    parser.add_argument("--timed", type=float, default=1.0, help="weight of the step-by-step loss")
    parser.add_argument("--hard", type=float, default=1.0, help="how often sound is spoiled")
    parser.add_argument("--synthetic-only", action="store_true", help="before there are labels for real speech (align.py)")
    parser.add_argument("--validate", type=float, default=4, help="minutes between validations")
    parser.add_argument("--workers", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    torch.set_num_threads(1)
    Learner(args).run()


if __name__ == "__main__":
    main()
