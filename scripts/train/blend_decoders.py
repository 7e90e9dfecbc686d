#!/usr/bin/env python3
"""Decoders on the line between two, which are often better than either at what both have learned (Wortsman et al. 2022, Robust fine-tuning
of zero-shot models). They must have a common beginning.

usage: blend_decoders.py DECODERS.pt OTHERS.pt SHARE OUT.pt      SHARE of the others; what is supported is the former's
"""
import argparse
from pathlib import Path

import torch

from whole_files import whole


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("decoders", type=Path)
    parser.add_argument("others", type=Path)
    parser.add_argument("share", type=float)
    parser.add_argument("out", type=Path)
    args = parser.parse_args()
    ours, others = torch.load(args.decoders), torch.load(args.others)
    for name in ("controls_decoder", "pose_decoder"):
        for weight, value in ours.get(name, {}).items():
            value.lerp_(others[name][weight].to(value), args.share)
    with whole(args.out) as out:
        torch.save(ours, out)


if __name__ == "__main__":
    main()
