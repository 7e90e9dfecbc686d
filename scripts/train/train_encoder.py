#!/usr/bin/env python3
"""Phase 1: BaseNet's encoder with landmarks and face probability, on portraits and rendered faces.

usage: train_encoder.py [--samples N] [--resume] [--name basenet]     runs: $MIEN_CACHE/runs/NAME/{last.pt,best.pt,curves.png}
On several machines or GPUs: torchrun --nproc_per_node N train_encoder.py ...
Rendered shards that appear while it runs are taken up. Two heads exist in training only, controls and pose on rendered faces:
they keep expression in the features that phase 2 decodes.
"""
import argparse
import copy
import json
import math
import os

import torch
import torch.nn.functional as F
from tqdm import tqdm

import augment
import face_data
import landmark_points as lp
from expressions import CONTROLS
from faces import template
from networks import BaseNet
from paths import cache

# Pairs whose distance is an expression: lids and inner lips (teacher indices).
OPENINGS = [(159, 145), (158, 153), (160, 144), (386, 374), (385, 380), (387, 373), (13, 14), (82, 87), (312, 317),
            (80, 88), (310, 318), (61, 291), (105, 159), (334, 386), (107, 336)]


def point_weights():
    """Lids, lips, irises and brows carry the expression; the oval is a matter of opinion."""
    weights = {"eye": 2.0, "iris": 1.5, "lips": 2.0, "brow": 1.5, "face": 0.6}
    found = []
    for name, _ in lp.named_points():
        found.append(next((w for key, w in weights.items() if key in name.split("_")[:2]), 1.0))
    w = torch.tensor(found)
    return w / w.mean()


def control_weights(rendered):
    """Inverse spread, so that rare controls are worth learning."""
    if not len(rendered):
        return torch.ones(len(CONTROLS))
    spread = torch.cat([torch.from_numpy(labels["controls"]) for _, labels in rendered.shards]).float().std(0)
    return 1 / spread.clamp(min=0.05)


class Losses:
    def __init__(self, eye_distance):
        self.points = point_weights()
        self.unit = eye_distance
        self.pairs = torch.tensor([[lp.POSITION[a], lp.POSITION[b]] for a, b in OPENINGS])
        self.controls = torch.ones(len(CONTROLS))

    def distance(self, predicted, truth):
        """A rounded absolute value: like RMSE near zero, not ruled by outliers. In eye distances."""
        d = (predicted - truth) / self.unit
        return torch.sqrt(d.square().sum(-1) + 1e-4) - 1e-2

    def landmarks(self, out, batch):
        weights = self.points * (0.3 + 0.7 * batch.visible) * batch.has_landmarks[:, None]
        positional = (self.distance(out, batch.landmarks) * weights).sum() / weights.sum()
        gap = lambda p: p[:, self.pairs[:, 0]] - p[:, self.pairs[:, 1]]
        openings = self.distance(gap(out), gap(batch.landmarks))[batch.has_landmarks]
        return positional + 0.7 * openings.mean()

    def face(self, logit, batch):
        return F.binary_cross_entropy_with_logits(logit, batch.face)

    def expression(self, out, batch):
        """Controls and pose, rendered faces only."""
        rows = batch.has_controls
        if not rows.any():
            return out["controls"].sum() * 0, out["pose"].sum() * 0
        error = F.smooth_l1_loss(out["controls"][rows], batch.controls[rows], beta=0.1, reduction="none")
        pose = F.smooth_l1_loss(out["pose"][rows], batch.pose[rows], beta=0.1)
        return (error * self.controls).mean(), pose


def consistency(network, batch, losses, generator):
    """Landmarks must move with the picture (Honari et al. 2018): the same faces, turned and seen by another camera."""
    rows = torch.nonzero(batch.has_landmarks)[:32, 0]
    n = len(rows)
    angle, scale = torch.randn(n, generator=generator) * 0.25, torch.exp(torch.randn(n, generator=generator) * 0.08)
    crop = torch.stack([torch.full((n,), 32.5)] * 2 + [scale * 65, angle], 1)
    moved = face_data.sample_crops(batch.images[rows], crop)
    first = network(augment.photometric(batch.images[rows], generator) * 2 - 1)["landmarks"]
    second = network(augment.photometric(moved, generator) * 2 - 1)["landmarks"]
    back = face_data.to_crop(crop, first * 65)
    return losses.distance(second, back).mean()


@torch.no_grad()
def validate(network, portraits, rendered, seed=11):
    """Landmark error (outer eye corner distances) on both, correlation of the training-only controls head on renders."""
    network.eval()
    mixture = face_data.Mixture(portraits, rendered, None, seed)
    report = {}
    for name, source in (("real", portraits), ("rendered", rendered)):
        if not len(source):
            continue
        errors, answers, truths, faces = [], [], [], []
        for _ in range(4):
            part = mixture.part(source.rows(mixture.rng, 128), 0.0)
            out = network(part.images * 2 - 1)
            eyes = (part.landmarks[:, lp.OUTER_EYE_CORNERS[0]] - part.landmarks[:, lp.OUTER_EYE_CORNERS[1]]).norm(dim=1)
            errors.append((out["landmarks"] - part.landmarks).norm(dim=2).mean(1) / eyes.clamp(min=0.15))
            answers.append(out["controls"])
            truths.append(part.controls)
            faces.append(torch.sigmoid(out["face"]) > 0.5)
        report[f"{name}_landmarks"] = float(torch.cat(errors).mean())
        report[f"{name}_faces"] = float(torch.cat(faces).float().mean())
        if name == "rendered":
            a, b = torch.cat(answers), torch.cat(truths)
            a, b = a - a.mean(0), b - b.mean(0)
            r = (a * b).sum(0) / (a.norm(dim=0) * b.norm(dim=0)).clamp(min=1e-6)
            for control in ("jawOpen", "eyeBlinkLeft", "mouthPucker", "mouthSmileLeft", "browInnerUp"):
                report[control] = float(r[CONTROLS.index(control)])
            report["controls_mean"] = float(r.mean())
    network.train()
    return report


class Average:
    """Exponential moving average of the weights."""

    def __init__(self, network, decay=0.998):
        self.network, self.decay = copy.deepcopy(network), decay

    @torch.no_grad()
    def update(self, network, step):
        decay = min(self.decay, (1 + step) / (10 + step))
        for mine, theirs in zip(self.network.state_dict().values(), network.state_dict().values()):
            if mine.dtype.is_floating_point:
                mine.lerp_(theirs, 1 - decay)
            else:
                mine.copy_(theirs)


def save(path, value):
    torch.save(value, f"{path}.part")
    os.replace(f"{path}.part", path)


def plot(history, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, (left, right) = plt.subplots(1, 2, figsize=(12, 4))
    samples = [h["samples"] for h in history]
    for key, axis in [("loss", left), ("real_landmarks", left), ("rendered_landmarks", left), ("controls_mean", right),
                      ("jawOpen", right), ("eyeBlinkLeft", right), ("mouthPucker", right), ("browInnerUp", right)]:
        axis.plot(samples, [h.get(key, math.nan) for h in history], label=key)
    left.set_yscale("log"), left.legend(), right.legend(), figure.tight_layout()
    figure.savefig(path)
    plt.close(figure)


def learning_rate(options, samples):
    """Warm-up, then cosine."""
    share = min(1.0, samples / options.samples)
    return options.rate * min(1.0, samples / 10000 + 0.02) * (0.5 + 0.5 * math.cos(math.pi * share)) + 1e-5


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--name", default="basenet")
    parser.add_argument("--samples", type=int, default=1_200_000)
    parser.add_argument("--batch", type=int, default=192)
    parser.add_argument("--rate", type=float, default=2.5e-3)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--report-every", type=int, default=20_000)
    parser.add_argument("--real-share", type=float, default=0.42)
    parser.add_argument("--resume", action="store_true")
    parser.add_argument("--start-from", help="a checkpoint whose weights to begin with")
    return parser.parse_args()


def main():
    options = parse()
    torch.set_num_threads(options.threads)
    world, rank = int(os.environ.get("WORLD_SIZE", 1)), int(os.environ.get("RANK", 0))
    device = torch.device("cuda", int(os.environ.get("LOCAL_RANK", 0))) if torch.cuda.is_available() else torch.device("cpu")
    if world > 1:
        torch.distributed.init_process_group("nccl" if device.type == "cuda" else "gloo")
    seed = options.seed * 1000 + rank
    torch.manual_seed(seed)
    generator = torch.Generator().manual_seed(seed)
    run = cache() / "runs" / options.name
    run.mkdir(parents=True, exist_ok=True)

    network = BaseNet()
    with torch.no_grad():
        network.landmarks.bias.copy_(template().flatten())
        network.landmarks.weight.mul_(0.1)
    average = Average(network)
    optimizer = torch.optim.AdamW(network.parameters(), options.rate, weight_decay=0.02)
    samples, step, history = 0, 0, []
    if options.start_from:
        state = torch.load(options.start_from, map_location="cpu")
        network.load_state_dict(state["network"])
        average.network.load_state_dict(state["average"])
    if options.resume and (run / "last.pt").exists():
        state = torch.load(run / "last.pt", map_location="cpu")
        network.load_state_dict(state["network"])
        average.network.load_state_dict(state["average"])
        optimizer.load_state_dict(state["optimizer"])
        samples, step, history = state["samples"], state["step"], state["history"]
    network.to(device, memory_format=torch.channels_last)
    average.network.to(device)
    model = torch.nn.parallel.DistributedDataParallel(network) if world > 1 else network

    eyes = template()[list(lp.OUTER_EYE_CORNERS)]
    losses = Losses(float((eyes[0] - eyes[1]).norm()))
    rendered = face_data.Rendered("train_stills", "train_sequences")
    mixture = face_data.Mixture(face_data.Portraits("train"), rendered, face_data.Backgrounds(), seed + step, options.real_share)
    val_real, val_rendered = face_data.Portraits("val"), face_data.Rendered("val_stills")
    losses.controls = control_weights(rendered)
    bar = tqdm(total=options.samples, initial=samples, unit="face", disable=rank > 0, mininterval=10)
    running, reported = [], samples
    while samples < options.samples:
        for group in optimizer.param_groups:
            group["lr"] = learning_rate(options, samples)
        batch = mixture.batch(options.batch)
        images = augment.photometric(batch.images, generator) * 2 - 1
        batch = face_data.Batch(*(value.to(device) for value in batch))
        out = model(images.to(device, memory_format=torch.channels_last))
        controls, pose = losses.expression(out, batch)
        loss = 3 * losses.landmarks(out["landmarks"], batch) + 0.5 * losses.face(out["face"], batch) + 1.0 * controls + 1.0 * pose
        if step % 4 == 0:
            loss = loss + 1.0 * consistency(network, batch, losses, generator)
        optimizer.zero_grad(set_to_none=True)
        loss.backward()
        torch.nn.utils.clip_grad_norm_(network.parameters(), 5.0)
        optimizer.step()
        average.update(network, step)
        running.append(float(loss))
        step += 1
        samples += options.batch * world
        bar.update(options.batch * world)
        if samples - reported >= options.report_every and rank == 0:
            reported = samples
            rendered.refresh()
            val_rendered.refresh()
            losses.controls = control_weights(rendered)
            report = {"samples": samples, "rendered": len(rendered), "loss": sum(running) / len(running),
                      **validate(average.network, val_real, val_rendered)}
            history.append(report)
            running = []
            bar.write(json.dumps({k: round(v, 4) for k, v in report.items()}))
            save(run / "last.pt", {"network": network.state_dict(), "average": average.network.state_dict(),
                                   "optimizer": optimizer.state_dict(), "samples": samples, "step": step, "history": history})
            plot(history, run / "curves.png")


if __name__ == "__main__":
    main()
