"""Reduces the delay of controls decoders.

usage: python3 -m mien_training.phase2.reduce_delay --decoders D.pt --train F/train.pt... --held F/held.pt...
       --portraits F/portraits.pt --val F/val.pt --portraits-val F/portraits_val.pt --out OUT.pt
Portraits are constant streams (train_decoders.py), in which earlier frames are as useful as the current one, so
decoders respond a frame or two late. Here decoders learn from themselves (distillation, Hinton et al. 2015). On a
constant stream the target is their own output after some frames, and the stream changes the face at any time. On moving
rendered faces the target is the true motion, shifted to their own level. Noise differs from frame to frame. The final
weights are averaged with those at the start.
"""
import argparse
from pathlib import Path

import torch
import torch.nn.functional as F

from mien_training.networks.architectures import FACE_NETWORKS, ControlsDecoder
from mien_training.phase1.losses import soft_clamp
from mien_training.phase2.train_decoders import (
    ControlsTask,
    Held,
    Moving,
    arguments,
    average_with,
    decode,
    evaluate,
    load_joined,
    mean_and_deviation,
    minimise,
    portrait_stills,
    save,
    temporal_loss,
)

SETTLED = 10       # frames until the output for a constant stream settles
SLOW = 4.0         # frames, deviation of the window in which we tell how far off a decoder is from how late it is
NEAR = 0.05        # larger errors count linearly
WEIGHT_DECAY = 1e-4


def settled_output(decoder, features):
    """Output of a decoder after SETTLED repetitions of each frame of features [m,frames,c], [m,frames,52]."""
    still = features.flatten(0, 1).unsqueeze(1)
    told = torch.cat([decode(decoder, part.expand(-1, SETTLED, -1))[:, -1] for part in still.split(4096)])
    return soft_clamp(told).unflatten(0, features.shape[:2])


def low_pass(curves):
    """Curves [m,frames,c] smoothed by a symmetric window."""
    reach = int(3 * SLOW)
    window = torch.exp(-torch.arange(-reach, reach + 1) ** 2 / (2 * SLOW ** 2))
    lanes = F.pad(curves.transpose(1, 2), (reach, reach), mode="replicate")
    smooth = F.conv1d(lanes.flatten(0, 1).unsqueeze(1), (window / window.sum()).view(1, 1, -1))
    return smooth.view(lanes.shape[0], lanes.shape[1], -1).transpose(1, 2)


def without_lag(told, truth):
    """The true motion with the slow error of the prediction."""
    return truth + low_pass(told - truth)


class Noisy:
    """A source whose frames have noise of their own."""

    def __init__(self, source, deviation):
        self.source, self.deviation = source, deviation

    def batch(self):
        batch, mask = self.source.batch()
        return batch | {"features": batch["features"] + self.deviation * torch.randn_like(batch["features"])}, mask


def sources_with_targets(decoder, args):
    """(sources, weight of each control [52]) whose controls are the targets."""
    moving, held, portraits = map(load_joined, (args.train, args.held, args.portraits))
    weight = ControlsTask(moving, args).weight
    truth = moving["controls"].float()
    real = portrait_stills(portraits, args, args.cuts)
    for data in (moving, held, portraits):
        data["controls"] = settled_output(decoder, data["features"])
    moving["controls"] = without_lag(moving["controls"], truth)
    real.data["controls"] = portraits["controls"]
    deviation = args.noise * mean_and_deviation(moving["features"])[1]
    return [Noisy(source, deviation)
            for source in (Moving(moving, args), Held(held, args, cuts=args.cuts), real)], weight


def learn(decoder, sources, weight, args):
    def lesson(source):
        batch, mask = source.batch()
        return temporal_loss(soft_clamp(decoder(batch["features"])[0]), batch["controls"], weight * mask, args)

    minimise(lambda: sum(map(lesson, sources)), decoder, args, "reduced delay", WEIGHT_DECAY)


def reduce_delay(decoder, args):
    torch.manual_seed(args.seed)
    start = {name: value.clone() for name, value in decoder.state_dict().items()}
    learn(decoder, *sources_with_targets(decoder, args), args)
    average_with(decoder, start, args.average_with_start)


def options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--network", choices=FACE_NETWORKS, default="basenet", help="whose features")
    parser.add_argument("--decoders", type=Path, required=True)
    parser.add_argument("--train", type=Path, nargs="+", required=True,
                        help="features of rendered faces that move (sequences.py)")
    parser.add_argument("--held", type=Path, nargs="+", required=True, help="features of stills (sequences.py --hold)")
    parser.add_argument("--portraits", type=Path, nargs="+", required=True,
                        help="features of real faces (portrait_features.py)")
    parser.add_argument("--val", type=Path, nargs="+", required=True,
                        help="features that choose the supported controls")
    parser.add_argument("--portraits-val", type=Path, required=True,
                        help="features of real faces that help to choose them")
    parser.add_argument("--out", type=Path, required=True, help="checkpoint; scores go beside it as .json")
    parser.add_argument("--steps", type=int, default=600)
    parser.add_argument("--rate", type=float, default=3e-4)
    parser.add_argument("--cuts", type=float, default=0.1,
                        help="how often a face gives way to another from one frame to the next")
    parser.add_argument("--noise", type=float, default=0.85, help="of every frame, in deviations of the features")
    parser.add_argument("--average-with-start", type=float, default=0.5, metavar="SHARE",
                        help="of the way back in the end")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--seed", type=int, default=0)
    return parser


def main():
    given = vars(options().parse_args())
    args = arguments(**given, beta=NEAR)
    torch.set_num_threads(args.threads)
    known = torch.load(args.decoders)
    decoder = ControlsDecoder()
    decoder.load_state_dict(known["controls_decoder"])
    reduce_delay(decoder.eval(), args)
    before = known["supported"].numpy()
    report, supported = evaluate({"controls": decoder}, load_joined(args.val), gaze=args.network == "hifinet",
                                 portraits=torch.load(args.portraits_val), before=before)
    # The supported controls stay the same.
    save(args.out, known | {"controls_decoder": decoder.state_dict()}, supported | (before > 0), report)


if __name__ == "__main__":
    main()
