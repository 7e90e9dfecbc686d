"""Training of a decoder on whitened features, resumable from its checkpoint."""
import math

import torch

from mien_convert.atomic_files import whole
from mien_training.phase2.whitening import Whitening

WARM_UP = 200   # steps over which the learning rate rises, a fifth of all at most
AT_END = 0.01   # share of the learning rate that is left


class Run:
    """A decoder with its optimiser, and where they are kept.

    args: out, decoder (its name), steps, rate, seed. make: creates the decoder. start: the state of a decoder of plain
    features to begin with, or None.
    """

    def __init__(self, args, make, start=None):
        torch.manual_seed(args.seed)
        self.args, self.name, self.step, self.start = args, f"{args.decoder}_decoder", 0, start
        self.decoder = make()
        self.optimiser = torch.optim.AdamW(self.decoder.parameters(), lr=args.rate, weight_decay=1e-3,
                                           betas=(0.9, 0.98))
        self.known = torch.load(args.out,
                                map_location=next(self.decoder.parameters()).device) if args.out.exists() else None

    def begin(self, samples):
        """Features [n,features] for computing the whitening, unless a checkpoint contains it."""
        if self.known is None:
            self.whitening = Whitening.of(samples.float())
            if self.start:
                self.decoder.load_state_dict(self.whitening.unfold(self.start))
            return
        self.decoder.load_state_dict(self.known["white"])
        self.optimiser.load_state_dict(self.known["optimiser"])
        self.whitening, self.step = Whitening(self.known["mean"], self.known["matrix"]), self.known["step"]

    def rate(self):
        """Rises, then falls along a cosine."""
        done = min(self.step / self.args.steps, 1.0)
        rise = min(1.0, self.step / min(WARM_UP, max(self.args.steps // 5, 1)))
        return self.args.rate * rise * (AT_END + (1 - AT_END) * (0.5 + 0.5 * math.cos(math.pi * done)))

    def answer(self, features):
        return self.decoder(self.whitening(features), self.whitening.start(self.decoder, len(features)))[0]

    def advance(self, loss):
        """One step of the optimiser; the loss as a number."""
        for group in self.optimiser.param_groups:
            group["lr"] = self.rate()
        self.optimiser.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(self.decoder.parameters(), 1.0)
        self.optimiser.step()
        self.step += 1
        return loss.item()

    def state(self):
        """The state of a decoder that reads plain features, on the CPU."""
        return {name: value.cpu() for name, value in self.whitening.fold(self.decoder.state_dict()).items()}

    def save(self, **more):
        with whole(self.args.out) as out:
            torch.save({**more, self.name: self.state(), "white": self.decoder.state_dict(),
                        "optimiser": self.optimiser.state_dict(),
                        "mean": self.whitening.mean, "matrix": self.whitening.matrix, "step": self.step}, out)
