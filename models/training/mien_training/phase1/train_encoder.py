"""Phase 1: an encoder with landmarks and face probability (BaseNet only), on portraits and renders.

usage: python3 -m mien_training.phase1.train_encoder [--network hifinet] [--samples N] [--hours H] [--resume]
       [--name RUN]
Writes $MIEN_CACHE/runs/NAME/last.pt, with the history of validations, and decoders.pt for decoders that learn as well;
use the weights `average` of last.pt. Rendered shards that appear during training are used. For several machines or
GPUs: torchrun --nproc_per_node N -m mien_training.phase1.train_encoder. Two heads exist only in training, controls and
pose on renders: they keep expression in the features.
"""
import argparse
import copy
import ctypes
import json
import math
import os
import time
from pathlib import Path

import torch
from tqdm import tqdm

from mien_convert.atomic_files import whole
from mien_training.data import augment, face_batches
from mien_training.data import landmark_points as lp
from mien_training.data.expressions import CONTROLS
from mien_training.data.framing import BASENET
from mien_training.data.sequences import for_inference, sample_crops, template
from mien_training.networks.architectures import FACE_NETWORKS
from mien_training.paths import cache
from mien_training.phase1.dormant_units import Activity, reset_dormant
from mien_training.phase1.losses import RESPONDING, Losses, of_portraits
from mien_training.phase1.optimizer import Optimizer

WATCHED = ("jawOpen", "eyeBlinkLeft", "mouthPucker", "mouthSmileLeft", "browInnerUp")
MEET_EVERY = 16                             # steps between synchronizations; processes seldom wait for slower ones
REVIVE_EVERY, REVIVE_UNTIL = 512, 0.7       # steps; share of the run
GENTLE_UNTIL, FULL_FROM = 0.55, 0.8         # of the run
ALIKE = 4                                   # stills of one person in a row (make_synthetic.py --alike)
RARE_PLACE, RARE_FACE = (0.995, -1.0), (0.05, 7.6)  # quantiles of the log-odds of a face
GENTLE, FULL = (0.1, 0.5), (0.2, 0.5)        # share of degraded images, roughness of crops


def keep_freed_memory():
    """glibc hands large blocks back and faults them in again on every step; keeping them makes a step 1.5 times as
    fast."""
    mmap_max, trim_threshold = -4, -1
    libc = ctypes.CDLL(None)
    if hasattr(libc, "mallopt"):
        libc.mallopt(mmap_max, 0)
        libc.mallopt(trim_threshold, -1)


def map_type(device):
    """The type of maps in training. A CPU without bfloat16 products takes about twelve times as long for these as for
    fp32; elsewhere the layers are PyTorch's own, whose maps have the type of their weights."""
    cpu = Path("/proc/cpuinfo")
    narrow = device.type == "cpu" and cpu.exists() and "avx512_bf16" in cpu.read_text()
    return torch.bfloat16 if narrow else torch.float32


def correlations(a, b):
    a, b = a - a.mean(0), b - b.mean(0)
    return (a * b).sum(0) / (a.norm(dim=0) * b.norm(dim=0)).clamp(min=1e-6)


@torch.no_grad()
def validate(network, portraits, rendered, seed=11):
    """Landmark error (outer eye corner distances) and correlation of the training-only controls head, with the truth on
    renders and with the teacher on portraits."""
    network.eval()
    device = next(network.parameters()).device
    mixture = face_batches.Mixture(network.framing, portraits, rendered, None, seed)
    report = {}
    for name, source in (("real", portraits), ("rendered", rendered)):
        if not len(source):
            continue
        errors, answers, truths, faces = [], [], [], []
        for _ in range(4):
            part = mixture.part(source, 128, 0.0)
            out = {k: v.cpu() for k, v in network((part.images * 2 - 1).to(device)).items()}
            eyes = (part.landmarks[:, lp.OUTER_EYE_CORNERS[0]] - part.landmarks[:, lp.OUTER_EYE_CORNERS[1]]).norm(dim=1)
            errors.append((out["landmarks"] - part.landmarks).norm(dim=2).mean(1) / eyes.clamp(min=0.15))
            answers.append(out["controls"])
            truths.append(part.controls)
            faces.append(torch.sigmoid(out["face"]) > 0.5)
        report[f"{name}_landmarks"] = float(torch.cat(errors).mean())
        report[f"{name}_faces"] = float(torch.cat(faces).float().mean())
        prefix = "" if name == "rendered" else "real_"
        values = correlations(torch.cat(answers), torch.cat(truths))
        report.update({prefix + control: float(values[CONTROLS.index(control)]) for control in WATCHED})
        responding = torch.cat(truths).std(0) > RESPONDING
        report[prefix + "controls_mean"] = float(values[responding].mean())
    network.train()
    return report


@torch.no_grad()
def calibrate(network, backgrounds, portraits, seed=12):
    """Maps the log-odds of a face linearly to values that the tracker's thresholds fit."""
    exact = face_batches.Mixture(network.framing, portraits, None, None, seed, roughness=0)
    places = backgrounds.log_odds(network)
    network.eval()
    faces = network((exact.part(portraits, 1000, 0).images * 2 - 1).to(network.face.bias.device))["face"].cpu()
    low, high = places.quantile(RARE_PLACE[0]), faces.quantile(RARE_FACE[0])
    scale = (RARE_FACE[1] - RARE_PLACE[1]) / (high - low).clamp(min=1)
    network.face.weight *= scale
    network.face.bias.sub_(low).mul_(scale).add_(RARE_PLACE[1])
    network.train()


class Average:
    """Exponential moving average of the weights, brought up to date every few steps."""

    def __init__(self, network, decay=0.98, every=4):
        self.network, self.decay, self.every = copy.deepcopy(network), decay, every

    @torch.no_grad()
    def update(self, network, step):
        if step % self.every:
            return
        decay = min(self.decay, (1 + step) / (10 + step))
        pairs = list(zip(self.network.state_dict().values(), network.state_dict().values()))
        moving = [(mine, theirs) for mine, theirs in pairs if mine.dtype.is_floating_point]
        ours, others = map(list, zip(*moving))
        torch._foreach_mul_(ours, decay)
        torch._foreach_add_(ours, others, alpha=1 - decay)
        for mine, theirs in pairs:
            if not mine.dtype.is_floating_point:
                mine.copy_(theirs)


def save(path, value):
    with whole(path) as out:
        torch.save(value, out)


def moved_views(framing, images, batch, generator, share=0.06):
    """Rotated and scaled copies of some faces of the batch: (rows, images, crops in pixels of the original image)."""
    rows = torch.nonzero(batch.has_landmarks)[:, 0]
    rows = rows[torch.randperm(len(rows), generator=generator)[:int(share * len(images))]]
    n = len(rows)
    angle, scale = torch.randn(n, generator=generator) * 0.25, torch.exp(torch.randn(n, generator=generator) * 0.08)
    middle = torch.tensor([framing.width / 2, framing.height / 2]).expand(n, 2)
    crop = torch.cat([middle, scale[:, None] * framing.pixels_per_crop, angle[:, None]], 1)
    return rows, sample_crops(images[rows], crop, framing, taps=1), crop


class Trainer:
    def __init__(self, options, device, world, rank):
        self.options, self.device, self.world, self.rank = options, device, world, rank
        self.network = FACE_NETWORKS[options.network]()
        self.framing = self.network.framing
        self.network.encoder.map_type = map_type(device)
        with torch.no_grad():
            self.network.landmarks.bias.copy_(template().flatten())
            self.network.landmarks.weight.mul_(0.1)
        self.average = Average(self.network)
        self.samples, self.step, self.seconds, self.history, self.revived = 0, 0, 0.0, [], 0
        self.run = cache() / "runs" / options.name
        self.run.mkdir(parents=True, exist_ok=True)
        resumed = self.restore()
        if options.through:
            self.use_decoders(torch.load(options.through, map_location="cpu"), resumed)
        if options.keep:
            before = for_inference(options.network, options.start_from, options.through)
            self.before = before.to(device, memory_format=torch.channels_last)
        self.network.to(device, memory_format=torch.channels_last)
        self.optimizer = Optimizer(self.network, options.rate)
        if resumed:
            self.optimizer.load_state_dict(resumed["optimizer"])
        self.average.network.to(device)
        self.activity = Activity(self.network.encoder)
        self.load_data()

    def restore(self):
        """The checkpoint to go on from, if there is one."""
        if self.options.start_from:
            self.load(torch.load(self.options.start_from, map_location="cpu"))
        if self.options.resume and (self.run / "last.pt").exists():
            state = torch.load(self.run / "last.pt", map_location="cpu")
            self.load(state)
            for name in ("samples", "step", "seconds", "history"):
                setattr(self, name, state[name])
            return state
        return None

    def use_decoders(self, decoders, resumed):
        for network, name in ((self.network, "decoders"), (self.average.network, "average_decoders")):
            network.use_decoders(resumed[name] if resumed else decoders, self.options.decoders_learn)
        self.supported = decoders["supported"]

    def load(self, state):
        self.network.load_state_dict(state["network"])
        self.average.network.load_state_dict(state["average"])

    def load_data(self):
        seed = 1000 + self.rank + 7919 * self.step
        self.generator = torch.Generator().manual_seed(seed)
        rendered = lambda *kinds, **more: face_batches.Rendered(*kinds, framing=self.framing, **more)
        # Sequences are for phase 2, which needs features of unseen faces.
        self.rendered = rendered("train_stills", alike=ALIKE)
        backgrounds = face_batches.Backgrounds(seed=seed) if self.framing is BASENET else None
        portraits = face_batches.Portraits("train", self.framing)
        if self.options.distil:
            portraits.distil(self.options.distil)
        self.mixture = face_batches.Mixture(self.framing, portraits, self.rendered, backgrounds, seed,
                                            self.options.real_share)
        self.val_real = face_batches.Portraits("val", self.framing)
        self.val_rendered = rendered("val_stills", "val_sequences")
        eyes = template()[list(lp.OUTER_EYE_CORNERS)]
        self.losses = Losses(self.framing, float((eyes[0] - eyes[1]).norm()), self.device)
        self.losses.learn_spread(self.rendered)
        self.losses.learn_teacher(self.mixture.portraits)

    def progress(self):
        """Share of the run that is done, by faces or by the clock."""
        by_clock = self.seconds / (3600 * self.options.hours) if self.options.hours else 0
        return max(self.samples / self.options.samples, by_clock)

    def learning_rate(self):
        """Warm-up, then cosine."""
        warm = min(1.0, self.samples / 10000 + 0.02)
        return self.options.rate * warm * (0.5 + 0.5 * math.cos(math.pi * min(1.0, self.progress()))) + 1e-5

    def difficulty(self):
        """Share of degraded images and roughness of crops: gentle until lids and brows are learned, then as cameras
        are."""
        t = min(1.0, max(0.0, (self.progress() - GENTLE_UNTIL) / (FULL_FROM - GENTLE_UNTIL)))
        return tuple(a + (b - a) * t for a, b in zip(GENTLE, FULL))

    def update(self):
        """One step; its loss."""
        self.optimizer.set_rate(self.learning_rate())
        degraded, self.mixture.roughness = self.difficulty()
        batch = self.mixture.batch(self.options.batch)
        rows, moved, crop = moved_views(self.framing, batch.images, batch, self.generator)
        images = augment.photometric(torch.cat([batch.images, moved]), self.generator, degraded).mul_(2).sub_(1)
        batch = face_batches.Batch(*(value.to(self.device) for value in batch))
        n = len(batch.images)
        whole = self.network(images.to(self.device))
        out = {name: value[:n] for name, value in whole.items()}
        consistency = self.losses.consistency(out["landmarks"][rows], whole["landmarks"][n:], crop.to(self.device))
        loss = self.losses.total(out, batch) + 0.5 * consistency + self.forgetting(out["controls"], batch)
        self.optimizer.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(self.network.parameters(), 5.0)
        self.optimizer.step()
        self.average.update(self.network, self.step)
        self.step += 1
        self.samples += n * self.world
        return loss.item()

    def forgetting(self, controls, batch):
        """The loss that keeps what the initial weights predict for portraits before degradation."""
        rows = of_portraits(batch)
        if not self.options.keep or rows.sum() < 2:  # a single one has no spread
            return 0.0
        with torch.no_grad():
            before = self.before(batch.images[rows] * 2 - 1)["controls"]
        return self.options.keep * self.losses.kept(controls[rows], before)

    def report(self, losses):
        for source in (self.rendered, self.val_rendered):
            source.refresh()
        self.losses.learn_spread(self.rendered)
        average = self.average.network
        if self.progress() >= 1 and self.mixture.backgrounds:
            calibrate(average, self.mixture.backgrounds, self.val_real)
        report = {"samples": self.samples, "rendered": len(self.rendered), "loss": sum(losses) / len(losses),
                  "revived": self.revived, **validate(average, self.val_real, self.val_rendered)}
        self.history.append(report)
        tqdm.write(json.dumps({k: round(v, 4) for k, v in report.items()}))
        save(self.run / "last.pt", {"network": self.network.state_without_decoders(),
                                    "average": average.state_without_decoders(),
                                    "decoders": self.network.decoders(), "average_decoders": average.decoders(),
                                    "optimizer": self.optimizer.state_dict(), "samples": self.samples,
                                    "step": self.step, "seconds": self.seconds, "history": self.history})
        if self.options.decoders_learn:
            save(self.run / "decoders.pt", {**average.decoders(), "supported": self.supported})

    @torch.no_grad()
    def meet(self, began):
        """Averages the networks of all processes (local SGD, Stich 2019) and takes over the clock of the first."""
        seconds = torch.tensor(time.time() - began, dtype=torch.float64, device=self.device)
        if self.world > 1:
            torch.distributed.broadcast(seconds, 0)
            values = [v for v in self.network.state_dict().values() if v.dtype.is_floating_point]
            values.append(self.activity.on)
            mean = torch.cat([v.flatten() for v in values]) / self.world
            torch.distributed.all_reduce(mean)
            for value, common in zip(values, mean.split([v.numel() for v in values])):
                value.copy_(common.view(value.shape))
        self.seconds = float(seconds)
        if self.step % REVIVE_EVERY == 0 and self.progress() < REVIVE_UNTIL:
            generator = torch.Generator().manual_seed(self.step)
            self.revived += reset_dormant(self.network.encoder, self.activity.on, generator, self.optimizer,
                                   self.average.network.encoder)

    def train(self):
        bar = tqdm(total=self.options.samples, initial=self.samples, unit="face", disable=self.rank > 0, mininterval=10)
        losses, began = [], time.time() - self.seconds
        reported = self.samples
        while self.progress() < 1:
            losses.append(self.update())
            if self.step % MEET_EVERY == 0:
                self.meet(began)
            bar.update(self.options.batch * self.world)
            due = self.samples - reported >= self.options.report_every or self.progress() >= 1
            if due and self.mixture.backgrounds:
                self.mixture.backgrounds.mine(self.average.network)
            if due and self.rank == 0:
                self.report(losses)
            if due:
                losses, reported = [], self.samples


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--network", choices=FACE_NETWORKS, default=BASENET.name)
    parser.add_argument("--name", help="of the run; default: the network's")
    parser.add_argument("--samples", type=int, default=4_000_000)
    parser.add_argument("--hours", type=float, help="ends sooner, with the schedule fitted to the clock")
    parser.add_argument("--batch", type=int, default=96, help="of each process")
    parser.add_argument("--rate", type=float, default=1.3e-3)
    parser.add_argument("--report-every", type=int, default=50_000)
    parser.add_argument("--real-share", type=float, default=0.2)
    parser.add_argument("--distil", metavar="FILE", help="of distil_controls.py, whose controls replace the teacher's")
    parser.add_argument("--keep", type=float, default=0, metavar="WEIGHT",
                        help="of agreement with the controls that the initial weights predict")
    parser.add_argument("--through", metavar="DECODERS",
                        help="trained decoders that predict controls and pose, fixed by default")
    parser.add_argument("--decoders-learn", action="store_true",
                        help="also trains these decoders and writes them to decoders.pt, for phase 2")
    parser.add_argument("--resume", action="store_true")
    parser.add_argument("--start-from", help="a checkpoint with the initial weights")
    options = parser.parse_args()
    if options.decoders_learn and not options.through:
        parser.error("--decoders-learn needs --through")
    if options.keep and not (options.through and options.start_from):
        parser.error("--keep needs --through and --start-from")
    options.name = options.name or options.network
    return options


def main():
    options = parse()
    keep_freed_memory()
    torch.set_flush_denormal(True)  # moments of dormant units decay to denormals, with which a step takes twice as long
    torch.set_num_threads(1)
    world, rank = int(os.environ.get("WORLD_SIZE", 1)), int(os.environ.get("RANK", 0))
    local = int(os.environ.get("LOCAL_RANK", 0))
    device = torch.device("cuda", local) if torch.cuda.is_available() else torch.device("cpu")
    if world > 1:
        torch.distributed.init_process_group("nccl" if device.type == "cuda" else "gloo")
    torch.manual_seed(1000 + rank)
    Trainer(options, device, world, rank).train()


if __name__ == "__main__":
    main()
