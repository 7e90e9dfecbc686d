"""Phase 1: AudioNet's encoder learns phonemes with CTC (Graves et al. 2006), and per step where times are known.

usage: python3 -m mien_training.audio.train_encoder [--name audionet] [--minutes 60] [...]
With CTC alone the network may answer late; the second loss teaches the time. With --together decoders train as well, so
the features keep what they need, and phase 2 continues with them. Resumable.
"""
import argparse
import json
import math
import time
from pathlib import Path

import numpy as np
import torch
from torch import nn

from mien_convert.atomic_files import whole
from mien_training.audio import examples, losses, recognition
from mien_training.audio.audio_net import Encoder, PhonemeHeads, activity_decoder, controls_decoder
from mien_training.paths import cache

BATCH, SECONDS, SEED = 24, 4.0, 1
KEPT = 24                      # batches; each step uses a random one
CONTROLS, ACTIVITY = 20.0, 1.5  # weights relative to CTC's
DECODED = 3                    # one of this many sequences is decoded: two more LSTMs double the time


class Learner:
    def __init__(self, args):
        self.args, self.device = args, "cuda" if torch.cuda.is_available() else "cpu"
        self.network, self.heads = Encoder(), PhonemeHeads()
        self.decoders = nn.ModuleDict({"controls": controls_decoder(), "activity": activity_decoder()})
        self.importance = None
        self.path = cache() / "runs" / args.name / "last.pt"
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.step, self.spent, self.heard = 0, 0.0, 0.0  # steps, seconds of training, seconds of sound
        start = self.path if self.path.exists() else args.start_from
        state = torch.load(start, map_location="cpu") if start else None
        if state:
            self.network.load_state_dict(state["encoder"])
            self.heads.load_state_dict(state["heads"])
            self.decoders.load_state_dict(state.get("decoders", self.decoders.state_dict()))
            self.heard = state["seconds_heard"]
        else:
            self.network.mean[:], self.network.deviation[:] = examples.normalisation()
        self.modules = nn.ModuleList([self.network, self.heads, self.decoders]).to(self.device)
        self.parameters = list(self.modules.parameters())
        self.optimizer = torch.optim.AdamW(self.parameters, args.rate, weight_decay=0.01)
        if start == self.path:
            self.optimizer.load_state_dict(state["optimizer"])
            self.step, self.spent = state["step"], state["spent"]

    def rate(self):
        """Warm-up, then cosine decay until the time limit."""
        done = min(self.spent / (60 * self.args.minutes), 1)
        return self.args.rate * min(1, (self.step + 1) / 100) * (0.01 + 0.99 * 0.5 * (1 + math.cos(math.pi * done)))

    def losses(self, batch):
        """(CTC, step by step, controls, activity), and the share of steps whose phoneme is right."""
        features, frames, said, lengths, controls, weights, speech = (v.to(self.device) for v in batch)
        embedding = self.network(features)[0]
        sequence, frame = self.heads(embedding)
        ctc, timed = losses.phoneme_losses(sequence, frame, frames, said, lengths)
        right = (frame.argmax(-1) == frames).float().mean()
        if not self.args.together:
            return [ctc, timed], right
        if self.importance is None:
            self.importance = losses.importance_of(controls)
        embedding, controls, weights, speech = (v[::DECODED] for v in (embedding, controls, weights, speech))
        said, active = (self.decoders[name](embedding)[0] for name in ("controls", "activity"))
        return [ctc, timed, CONTROLS * losses.controls_loss(said, controls, weights, self.importance),
                ACTIVITY * losses.activity_loss(active, speech)], right

    def learn(self, batch):
        parts, right = self.losses(batch)
        self.optimizer.zero_grad(set_to_none=True)
        sum(parts).backward()
        nn.utils.clip_grad_norm_(self.parameters, 2.0)
        for group in self.optimizer.param_groups:
            group["lr"] = self.rate()
        self.optimizer.step()
        return np.array([v.item() for v in [*parts, right]])

    def save(self):
        state = {"encoder": self.network.state_dict(), "heads": self.heads.state_dict(),
                 "decoders": self.decoders.state_dict(), "optimizer": self.optimizer.state_dict(),
                 "step": self.step, "spent": self.spent, "seconds_heard": self.heard}
        with whole(self.path) as out:
            torch.save(state, out)

    def validate(self):
        self.network.eval()
        self.heads.eval()
        network, heads = self.network.cpu(), self.heads.cpu()
        report = {group: round(recognition.error_rate(network, heads, group, "val", 40), 4)
                  for group in ("synthetic", "librispeech_text")}
        self.network.train().to(self.device)
        self.heads.train().to(self.device)
        return report

    def run(self):
        data = examples.PhonemeBatches("train", BATCH, SECONDS, SEED + self.step,
                                       self.args.hard)
        if self.args.synthetic_only:
            data.speech = examples.Speech("train", {"synthetic": 1})
        loader = iter(torch.utils.data.DataLoader(data, batch_size=None, num_workers=self.args.workers))
        saved = shown = time.time()
        sums, count, kept, rng = 0, 0, [], np.random.default_rng(SEED)
        while self.spent < 60 * self.args.minutes:
            began = time.time()
            if self.step % self.args.reuse == 0 or len(kept) < KEPT:
                kept = [*kept, next(loader)][-KEPT:]
            sums, count = sums + self.learn(kept[rng.integers(len(kept))]), count + 1
            self.step, self.heard = self.step + 1, self.heard + BATCH * SECONDS
            self.spent += time.time() - began
            if time.time() - shown > 30:
                print(self.step, f"{self.spent / 60:.1f} min", *np.round(sums / count, 4), flush=True)
                sums, count, shown = 0, 0, time.time()
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
    parser.add_argument("--rate", type=float, default=3e-3)
    parser.add_argument("--together", action="store_true", help="with the decoders")
    parser.add_argument("--reuse", type=int, default=1,
                        help="how often a batch is seen: making one takes as long as learning from it")
    parser.add_argument("--hard", type=float, default=1.0, help="how often sound is spoiled")
    parser.add_argument("--synthetic-only", action="store_true",
                        help="before there are labels for real speech (align.py)")
    parser.add_argument("--validate", type=float, default=4, help="minutes between validations")
    parser.add_argument("--workers", type=int, default=0)
    args = parser.parse_args()
    torch.set_num_threads(1)
    Learner(args).run()


if __name__ == "__main__":
    main()
