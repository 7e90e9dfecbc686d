"""Weighted mean of two decoders with a common ancestor (Wortsman et al. 2022, Robust fine-tuning of zero-shot models).

usage: python3 -m mien_training.phase2.blend_decoders DECODERS.pt OTHERS.pt SHARE OUT.pt
SHARE is the weight of OTHERS; the supported controls are those of DECODERS. The mean is often better than both.
"""
import argparse
from pathlib import Path

import torch

from mien_convert.atomic_files import whole


def between(ours, others, share):
    """A state on the line between two."""
    return {name: value.lerp(others[name].to(value), share) if value.is_floating_point() else value
            for name, value in ours.items()}


def add_line(parser):
    """The arguments of a line between two checkpoints."""
    parser.add_argument("ours", type=Path)
    parser.add_argument("others", type=Path)
    parser.add_argument("share", type=float, help="of the others")
    parser.add_argument("out", type=Path)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_line(parser)
    args = parser.parse_args()
    ours, others = torch.load(args.ours), torch.load(args.others)
    for name in ("controls_decoder", "pose_decoder"):
        if name in ours:
            ours[name] = between(ours[name], others[name], args.share)
    with whole(args.out) as out:
        torch.save(ours, out)


if __name__ == "__main__":
    main()
