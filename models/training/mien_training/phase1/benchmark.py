"""Faces per second of each part of a training step of phase 1, on one thread.

The shortest CPU time of each part counts. `data` draws batches, crops included, from random windows, so no data packs
are needed.
"""
import argparse
import time
import types

import numpy as np
import torch

from mien_training.data import augment, face_batches
from mien_training.data.expressions import CONTROLS
from mien_training.networks.architectures import FACE_NETWORKS
from mien_training.phase1 import train_encoder

PARTS = ("data", "augmentation", "forward and backward", "optimizer and average", "whole")
FACES = 256


class RandomFaces:
    """Random windows and labels in place of portraits."""

    def __init__(self, framing):
        rng = np.random.default_rng(1)
        self.images = rng.integers(0, 255, (FACES, framing.window, framing.window, 3), np.uint8)
        crop = torch.tensor(framing.middle).expand(FACES, -1)
        landmarks = face_batches.crop_to_image(crop, face_batches.template().expand(FACES, -1, -1))
        self.controls, self.learned = torch.rand(FACES, len(CONTROLS)), torch.ones(len(CONTROLS), dtype=torch.bool)
        self.labels = [landmarks, crop, self.controls, torch.ones(FACES, 175)]
        self.camera = {"rotation": torch.eye(3).expand(FACES, 3, 3),
                       "translation": torch.tensor([0.0, 0, -0.5]).expand(FACES, 3),
                       "f_px": torch.full((FACES,), 500.0),
                       "camera_wh": torch.tensor([640.0, 480.0]).expand(FACES, 2),
                       "window": torch.tensor([320.0, 240, 200]).expand(FACES, 3), "identity": torch.arange(FACES) // 4,
                       "trust": torch.ones(FACES, len(CONTROLS))}
        self.shards = [(self.images, {"controls": self.controls.numpy()})]

    def __len__(self):
        return FACES

    def refresh(self):
        pass

    def rows(self, rng, n):
        i = np.sort(rng.integers(0, FACES, n))
        self.last = {name: values[i] for name, values in self.camera.items()}
        return (self.images[i], *(values[i] for values in self.labels))


class RandomRenders(RandomFaces, face_batches.Rendered):
    """The same in place of renders."""


class Trainer(train_encoder.Trainer):
    def load_data(self):
        framing = self.network.framing
        self.generator = torch.Generator().manual_seed(1)
        portraits, self.rendered = RandomFaces(framing), RandomRenders(framing)
        self.mixture = face_batches.Mixture(framing, portraits, self.rendered, None, 1, 0.2)
        eyes = train_encoder.template()[list(train_encoder.lp.OUTER_EYE_CORNERS)]
        self.losses = train_encoder.Losses(framing, float((eyes[0] - eyes[1]).norm()), self.device)
        self.losses.learn_spread(self.rendered)
        self.losses.learn_teacher(portraits)


class Clock:
    """Adds up the CPU time of functions by part."""

    def __init__(self):
        self.seconds = {}

    def measure(self, owner, name, part):
        function = getattr(owner, name)

        def measured(*args, **named):
            began = time.process_time()
            out = function(*args, **named)
            self.seconds[part] = self.seconds.get(part, 0) + time.process_time() - began
            return out

        setattr(owner, name, measured)


def benchmark(network, batch, steps):
    """Seconds per face by part."""
    torch.set_num_threads(1)
    train_encoder.keep_freed_memory()
    torch.manual_seed(1)
    options = types.SimpleNamespace(network=network, name="benchmark", rate=1e-4, start_from=None, resume=False,
                                    batch=batch, samples=10**9, hours=None, real_share=0.2,
                                    through=None, decoders_learn=False, keep=0)
    trainer, clock = Trainer(options, torch.device("cpu"), 1, 0), Clock()
    clock.measure(trainer.mixture, "batch", "data")
    clock.measure(train_encoder, "moved_views", "data")
    clock.measure(augment, "photometric", "augmentation")
    clock.measure(trainer.optimizer, "step", "optimizer and average")
    clock.measure(trainer.average, "update", "optimizer and average")
    best = {}
    trainer.update()
    for _ in range(steps):
        clock.seconds.clear()
        began = time.process_time()
        trainer.update()
        whole = time.process_time() - began
        parts = {**clock.seconds, "whole": whole, "forward and backward": whole - sum(clock.seconds.values())}
        best = {part: min(seconds, best.get(part, seconds)) for part, seconds in parts.items()}
    return {part: seconds / batch for part, seconds in best.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--network", choices=FACE_NETWORKS, default="hifinet")
    parser.add_argument("--steps", type=int, default=16)
    parser.add_argument("--batch", type=int, default=96)
    args = parser.parse_args()
    best = benchmark(args.network, args.batch, args.steps)
    print(f"{args.network}, batches of {args.batch}, faces per second on one core")
    for part in PARTS:
        print(f"  {part:24s}{1 / max(best.get(part, 0), 1e-9):8.0f}")


if __name__ == "__main__":
    main()
