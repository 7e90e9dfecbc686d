"""Trains the controls decoder of a network on streamed features and keeps its amplitude.

usage: python3 -m mien_training.phase2.train_streamed --network basenet|hifinet --steps N --out CHECKPOINT
       [--start-from DECODERS]
Features come from stream_features.py and portrait_stream.py. Losses on renders are values, differences between frames,
and concordance. Portraits teach the teacher's controls: smiles, jaw and eyelids on its scale, others on a scale of
their own. The checkpoint contains everything else of --start-from, for export.py. It resumes, and uses shards that have
appeared since.
"""
import argparse
import time
from pathlib import Path

import torch
import torch.nn.functional as F

from mien_training.data.expressions import INDEX
from mien_training.data.eyelids import closures
from mien_training.networks.architectures import FACE_NETWORKS, FEATURES
from mien_training.paths import cache
from mien_training.phase1.losses import censored, importance, unevenness
from mien_training.phase2 import stream_features
from mien_training.phase2.amplitude_losses import discordance, discordance_within
from mien_training.phase2.decoder_run import Run
from mien_training.phase2.train_decoders import (
    Held,
    TeacherTask,
    arguments,
    mean_and_deviation,
    noisy,
    portrait_stills,
    temporal_loss,
)
from mien_training.phase2.whitening import FLOOR

ABSOLUTE = [INDEX[name] for name in ("jawOpen", "mouthSmileLeft", "mouthSmileRight")]  # on the teacher's own scale
BLINKS = [INDEX["eyeBlinkLeft"], INDEX["eyeBlinkRight"]]


class Tracks:
    """Streams of `joined` tracks each, so that states outlive a track."""

    def __init__(self, data, size, joined):
        self.data, self.size, self.joined = data, size, joined

    def batch(self):
        """Tensors [size,joined*frames,c] and weights [1,joined*frames,1]: none where one face cuts to another."""
        rows = torch.randint(len(self.data["features"]), (self.size, self.joined))
        frames = self.data["features"].shape[1]
        mask = torch.ones(1, self.joined * frames, 1)
        mask[:, ::frames] = 0
        mask[:, 0] = 0.5
        return {k: self.data[k][rows].flatten(1, 2).float() for k in ("features", "controls", "visible")}, mask


class RenderTask:
    """Error of values and of differences, every control relative to its spread, and discordance within tracks and over
    all."""

    def __init__(self, controls, args):
        self.args = args
        spread = controls.flatten(0, 1).float().std(0)
        weight = 1 / (spread + 0.05)
        self.weight = weight / weight.mean()
        sides = 1 / (unevenness(controls.flatten(0, 1).float()).std(0) + 0.05)
        self.of_sides = args.sides * sides / weight.mean()
        self.loss_args = arguments(velocity=args.velocity, acceleration=args.acceleration)
        self.importance = importance()

    def loss(self, output, batch, mask):
        target, seen = batch["controls"], batch["visible"] * mask
        ours = censored(output, target)
        apart = lambda x: x.unflatten(1, (self.args.joined, -1)).flatten(0, 1)
        within = discordance_within(apart(ours), apart(target), apart(seen))
        concordance = (within + discordance(ours, target, seen)).mean() / 2
        values = temporal_loss(ours, target, self.weight * seen, self.loss_args, self.importance)
        sides = temporal_loss(unevenness(ours), unevenness(target), self.of_sides * mask, self.loss_args)
        return values + sides + self.args.concordance * concordance


class PortraitTask:
    """The teacher's labels of constant portraits: absolute values for smiles and jaw, the aperture for eyelids."""

    def __init__(self, data, args):
        self.args, self.teacher = args, TeacherTask(data, arguments(teacher=args.teacher))

    def loss(self, output, batch, mask):
        absolute = self.absolute(censored(output, batch["controls"]), batch, mask)
        return self.teacher.loss(output, batch, mask) + self.args.absolute * absolute

    def absolute(self, ours, batch, mask):
        wanted = torch.cat([batch["controls"][..., ABSOLUTE], batch["closed"]], -1)
        told = ours[..., ABSOLUTE + BLINKS]
        weight = mask.expand(*wanted.shape).contiguous()
        error = (weight * F.smooth_l1_loss(told, wanted, beta=0.15, reduction="none")).mean()
        return error + self.args.concordance * discordance(told, wanted, weight).mean()


class Portraits(Held):
    """Portraits that hold still, with how far their eyelids are closed."""

    @classmethod
    def of(cls, data, args):
        made = portrait_stills(data, arguments(batch=args.portraits // 2))
        made.data["closed"] = closures(data["points"].float()).half()
        return made


def options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--network", choices=FACE_NETWORKS, required=True)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--start-from", type=Path, help="decoders to go on from")
    parser.add_argument("--stream", type=Path, default=cache() / "stream")
    parser.add_argument("--shards", type=int, help="maximum number of shards to learn from")
    parser.add_argument("--steps", type=int, default=3000)
    parser.add_argument("--batch", type=int, default=24, help="streams of tracks")
    parser.add_argument("--joined", type=int, default=2, help="tracks of a stream")
    parser.add_argument("--portraits", type=int, default=48, help="streams of portraits")
    parser.add_argument("--rate", type=float, default=2e-3)
    parser.add_argument("--noise", type=float, default=0.3,
                        help="of features, in deviations: with it few people are learned from, not by heart")
    parser.add_argument("--floor", type=float, default=FLOOR,
                        help="of whitening, as a share of the mean variance (whitening.py)")
    parser.add_argument("--velocity", type=float, default=0.1)
    parser.add_argument("--acceleration", type=float, default=0.02)
    parser.add_argument("--concordance", type=float, default=0.05, help="weight of what keeps the amplitude")
    parser.add_argument("--sides", type=float, default=1.0, help="weight of the loss for the side of a pair that moves")
    parser.add_argument("--teacher", type=float, default=0.5, help="weight of what the teacher says of portraits")
    parser.add_argument("--absolute", type=float, default=0.5, help="weight of smiles, jaw and eyelids of portraits")
    parser.add_argument("--keep-every", type=int, help="interval of steps between copies of the decoders, OUT_STEP.pt")
    parser.add_argument("--minutes", type=float, help="stop after this time")
    parser.add_argument("--device", default="cpu", help="cuda, for an accelerator")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--seed", type=int, default=0)
    return parser


def on(device, tensors):
    return {name: value.to(device) for name, value in tensors.items()}


def lessons_of(args):
    """[(source, task)]"""
    moving = on(args.device, stream_features.load(args.stream / "train", args.network, args.shards))
    lessons = [(Tracks(moving, args.batch, args.joined), RenderTask(moving["controls"], args))]
    if args.portraits:
        still = on(args.device, stream_features.load(args.stream / "portraits_train", args.network))
        lessons.append((Portraits.of(still, args), PortraitTask(still, args)))
    return lessons


def main():
    args = options().parse_args()
    torch.set_num_threads(args.threads)
    if args.device != "cpu":
        torch.set_default_device(args.device)
    args.out.parent.mkdir(parents=True, exist_ok=True)
    known = torch.load(args.start_from, map_location="cpu") if args.start_from else {}
    start = known.pop("controls_decoder", None)
    run, lessons = Run(args, FEATURES, start and on(args.device, start)), lessons_of(args)
    print(f"{len(lessons[0][0].data['features'])} tracks of renders", flush=True)
    run.begin(torch.cat([source.data["features"][:, ::5].flatten(0, 1) for source, _ in lessons]), args.floor)
    noise = args.noise * mean_and_deviation(lessons[0][0].data["features"])[1]

    def lesson(source, task):
        batch, mask = source.batch()
        return task.loss(run.answer(noisy(batch["features"], noise)), batch, mask)

    total, began = 0.0, time.time()
    while run.step < args.steps and not (args.minutes and time.time() - began > 60 * args.minutes):
        total += run.advance(sum(lesson(*pair) for pair in lessons))
        if run.step % 100 == 0:
            print(f"step {run.step} loss {total / 100:.5f} {time.time() - began:.0f} s", flush=True)
            total = 0.0
        if args.keep_every and run.step % args.keep_every == 0:
            torch.save({**known, "controls_decoder": run.state()}, args.out.with_stem(f"{args.out.stem}_{run.step}"))
        if run.step % 200 == 0:
            run.save(**known)
    run.save(**known)


if __name__ == "__main__":
    main()
