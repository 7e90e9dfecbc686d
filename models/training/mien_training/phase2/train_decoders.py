"""Phase 2: trains a temporal decoder of a network on streamed features and keeps its amplitude.

usage: python3 -m mien_training.phase2.train_decoders --network basenet|hifinet --steps N --out CHECKPOINT
       [--decoder controls|pose] [--start-from DECODERS]
Features come from stream_features.py and portrait_stream.py. Losses on renders are values, differences between frames,
and concordance. Portraits teach the teacher's controls: smiles, jaw and eyelids on its scale, others on a scale of
their own. The checkpoint contains the decoders of --start-from that it does not train, for export.py, and the supported
controls, chosen on the validation people of the stream if it has any. It resumes, and uses shards that have appeared
since.
"""
import argparse
import time
from pathlib import Path

import torch

from mien_training.data.eyelids import closures
from mien_training.data.face_batches import rarity
from mien_training.networks.architectures import FACE_NETWORKS, ControlsDecoder, PoseDecoder
from mien_training.paths import cache
from mien_training.phase2 import stream_features
from mien_training.phase2.decoder_losses import JOINED, PortraitPoseTask, PortraitTask, PoseTask, RenderTask
from mien_training.phase2.decoder_run import Run
from mien_training.phase2.decoder_scores import supported_now

LEARNED = ("features", "controls", "visible", "pose")
DECODERS = {"controls": (ControlsDecoder, RenderTask, PortraitTask), "pose": (PoseDecoder, PoseTask, PortraitPoseTask)}


class Tracks:
    """Streams of JOINED tracks each, so that states outlive a track."""

    def __init__(self, data, size):
        self.data, self.size = data, size

    def batch(self):
        """Tensors [size,JOINED*frames,c] and weights [1,JOINED*frames,1]: none where one face cuts to another."""
        rows = torch.randint(len(self.data["features"]), (self.size, JOINED))
        frames = self.data["features"].shape[1]
        mask = torch.ones(1, JOINED * frames, 1)
        mask[:, ::frames] = 0
        mask[:, 0] = 0.5
        return {k: self.data[k][rows].flatten(1, 2).float() for k in LEARNED}, mask


class Portraits:
    """Streams of portraits that hold still, with how far their eyelids are closed. Rare expressions are drawn more
    often, as in phase 1."""

    FRAMES, ADAPTING = 10, 2

    def __init__(self, data, size):
        self.data, self.size = {k: data[k] for k in LEARNED} | {"closed": closures(data["points"].float()).half()}, size
        self.odds = torch.as_tensor(rarity(data["controls"][:, 0].float().cpu().numpy()), dtype=torch.float32)
        self.mask = torch.ones(1, self.FRAMES, 1)
        self.mask[:, :self.ADAPTING] = 0.25

    def batch(self):
        rows = torch.multinomial(self.odds, self.size, replacement=True)[:, None]
        at = torch.randint(self.data["features"].shape[1], (self.size, self.FRAMES))
        return {k: v[rows, at].float() for k, v in self.data.items()}, self.mask


def deviations(features):
    """[256] of features [m,frames,256], with a lower limit."""
    spread = features[::7].flatten(0, 1).float().std(0)
    return spread + 0.1 * spread.mean()


def noisy(x, spread):
    """Features with noise of their own for every stream and for every frame."""
    return x + spread * (0.5 * torch.randn_like(x) + torch.randn(len(x), 1, x.shape[2]))


def options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--network", choices=FACE_NETWORKS, required=True)
    parser.add_argument("--decoder", choices=DECODERS, default="controls")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--start-from", type=Path, help="decoders to continue from")
    parser.add_argument("--stream", type=Path, default=cache() / "stream")
    parser.add_argument("--steps", type=int, default=3000)
    parser.add_argument("--batch", type=int, default=24, help="streams of tracks")
    parser.add_argument("--portraits", type=int, default=48, help="streams of portraits")
    parser.add_argument("--rate", type=float, default=2e-3)
    parser.add_argument("--noise", type=float, default=0.3, help="of features, in deviations, against memorized people")
    parser.add_argument("--keep-every", type=int, help="interval of steps between copies of the decoders, OUT_STEP.pt")
    parser.add_argument("--minutes", type=float, help="stop after this time")
    parser.set_defaults(seed=0)
    parser.add_argument("--device", default="cpu", help="cuda, for an accelerator")
    return parser


def on(device, tensors):
    return {name: value.to(device) for name, value in tensors.items()}


def lessons_of(args):
    """[(source, task)]"""
    _, of_renders, of_portraits = DECODERS[args.decoder]
    moving = on(args.device, stream_features.load(args.stream / "train", args.network))
    lessons = [(Tracks(moving, args.batch), of_renders(moving))]
    if args.portraits:
        still = on(args.device, stream_features.load(args.stream / "portraits_train", args.network))
        lessons.append((Portraits(still, args.portraits), of_portraits(still)))
    return lessons


def read_decoders(path):
    """The decoders of a checkpoint and their supported controls, without the state of a training run."""
    return {k: v for k, v in torch.load(path, map_location="cpu").items() if k.endswith("_decoder") or k == "supported"}


def main():
    args = options().parse_args()
    torch.set_num_threads(1)
    start = read_decoders(args.start_from) if args.start_from else {}
    before = start.get("supported", torch.zeros(52))
    if args.device != "cpu":
        torch.set_default_device(args.device)
    args.out.parent.mkdir(parents=True, exist_ok=True)
    own = start.pop(f"{args.decoder}_decoder", None)
    run, lessons = Run(args, DECODERS[args.decoder][0], own and on(args.device, own)), lessons_of(args)
    run.begin(torch.cat([source.data["features"][:, ::5].flatten(0, 1) for source, _ in lessons]))
    noise = args.noise * deviations(lessons[0][0].data["features"])

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
            torch.save({**start, run.name: run.state()}, args.out.with_stem(f"{args.out.stem}_{run.step}"))
        if run.step % 200 == 0:
            run.save(**start)
    if args.device != "cpu":
        torch.set_default_device("cpu")
    run.save(**start | (supported_now(args, run.state(), before) if args.decoder == "controls" else {}))


if __name__ == "__main__":
    main()
