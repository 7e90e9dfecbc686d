#!/usr/bin/env python3
"""Whether decoders are an improvement on validation people, amplitude included: streamed features of renders and of portraits.

usage: compare_streamed.py --network basenet|hifinet BEFORE.pt DECODERS.pt...
The first line of each is the verdict of compare_legs.py; then come error over the best constant's, mean correlation, the median over the
controls of deviation over the true one, the share of controls for which that lies within 0.8 and 1.25, answers to rendered faces at rest
(largest mean of a control), and on portraits eyeBlink where the lids are closed and mouthSmile where the teacher says at least 0.6.
"""
import argparse
from pathlib import Path

import numpy as np
import torch

import stream_features
from compare_legs import People, compare, verdict
from expressions import CONTROLS, INDEX
from eyelids import closures
from losses import followed
from networks import FACE_NETWORKS
from paths import cache
from train_decoders import correlation_of, metrics, of_stride

AT_REST = 0.05   # a rendered face is at rest where no control is above it


def known_to_teacher(portraits):
    known = followed(portraits["controls"].flatten(0, 1).float())[1] > 0
    return {**portraits, "visible": portraits["visible"].float() * known}


def amplitude(people, portraits):
    """A line of how far faces move."""
    (curves, truth), (real, _) = people.parts
    target, seen = truth["controls"].float().numpy(), truth["visible"].float().numpy()
    error = metrics.facs_error(curves, target) / metrics.constant_errors(target)["median"]
    correlation = np.nan_to_num(correlation_of(curves, truth))
    ratio = curves.reshape(-1, len(CONTROLS)).std(0) / target.reshape(-1, len(CONTROLS)).std(0)
    rest = curves[target.max(-1) < AT_REST]
    closed = closures(portraits["points"][:, -1].float()).numpy() > 0.9
    blinks = real[:, -1][:, [INDEX["eyeBlinkLeft"], INDEX["eyeBlinkRight"]]][closed]
    smiling = portraits["controls"][:, -1, INDEX["mouthSmileLeft"]].numpy() >= 0.6
    smiles = real[:, -1, INDEX["mouthSmileLeft"]][smiling]
    return (f"error {error:.3f}, correlation {correlation.mean():.3f}, {(correlation >= 0.5).sum()} of them 0.5; deviation {np.median(ratio):.2f}, "
            f"{((ratio > 0.8) & (ratio < 1.25)).sum()} right; at rest {rest.mean(0).max() if len(rest) else np.nan:.3f} ({len(rest)}); "
            f"closed eyes {blinks.mean():.2f} ({len(blinks)}); smiles {np.median(smiles):.2f} ({len(smiles)})")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--network", choices=FACE_NETWORKS, required=True)
    parser.add_argument("--stream", type=Path, default=cache() / "stream")
    parser.add_argument("--each", action="store_true", help="every control, too")
    parser.add_argument("before", type=Path)
    parser.add_argument("decoders", type=Path, nargs="+")
    args = parser.parse_args()
    torch.set_num_threads(1)
    rendered = of_stride(stream_features.load(args.stream / "val", args.network), 1)
    portraits = known_to_teacher(stream_features.load(args.stream / "portraits_val", args.network))
    before = People(args.before, rendered, portraits)
    print(f"{'before'.rjust(20)}  {amplitude(before, portraits)}")
    for path in args.decoders:
        after = People(path, rendered, portraits, before.supported)
        differences, errors, error_of_mean = compare(before, after)
        print(f"{path.stem.rjust(20)}  {verdict(differences, errors, error_of_mean, before.supported)}\n{' ' * 22}{amplitude(after, portraits)}")
        for i in np.argsort(differences) if args.each else ():
            print(f"{CONTROLS[i].rjust(40)} {differences[i]:+.3f} ({errors[i]:.3f}){'' if before.supported[i] else ' not supported before'}")


if __name__ == "__main__":
    main()
