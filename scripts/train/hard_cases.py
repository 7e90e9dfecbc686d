#!/usr/bin/env python3
"""What the controls decoder fails at, as poses to make more sequences of (the loop of Navarro et al. 2023: find failures, add
sequences like them, train again, keep the better).

usage: hard_cases.py --features F.pt --decoders D.pt --out hard.npz
       make_synthetic.py --kind sequences --poses hard.npz --seed 2 --out $MIEN_CACHE/hard ...
F.pt are features (sequences.py) of training sequences that these decoders did not learn from; hard.npz has controls [k,52]. The
report says which controls are missed, shown too little, and which are invented, shown where they are not.
"""
import argparse
from pathlib import Path

import numpy as np
import torch

from expressions import CONTROLS
from losses import importance
from networks import ControlsDecoder
from shown import shown
from train_decoders import answers, of_stride
from whole_files import whole

APART = 8               # frames between two hard ones of a track: neighbours are the same pose
SMALLEST_SPREAD = 0.08  # of a control, so that one that hardly moves does not rule the choice


def weighted_errors(told, data, supported):
    """Error of every frame [m,frames] and signed errors of every control [m,frames,52], those that cannot be seen at 0."""
    truth, seen = data["controls"].float(), data["visible"].float()
    signed = (told - truth) * seen
    weight = importance() * supported / truth.flatten(0, 1).std(0).clamp(min=SMALLEST_SPREAD)
    return (signed.abs() * weight).sum(-1) / weight.sum(), signed


def worst_frames(errors, count):
    """(track, frame) [count,2] of the largest errors, APART from each other within a track."""
    chosen, blocked = [], torch.zeros_like(errors, dtype=torch.bool)
    for flat in errors.flatten().argsort(descending=True).tolist():
        track, frame = divmod(flat, errors.shape[1])
        if not blocked[track, frame]:
            chosen.append((track, frame))
            blocked[track, max(0, frame - APART):frame + APART + 1] = True
        if len(chosen) == count:
            break
    return np.array(chosen)


def report(signed, truth, supported):
    """Lines of the supported controls, those that fail most first."""
    active = truth > 0.5
    missed = -(signed * active).sum((0, 1)) / active.sum((0, 1)).clamp(min=1)
    invented = (signed * (truth < 0.05)).clamp(min=0).flatten(0, 1).quantile(0.99, 0)
    order = (missed + invented).argsort(descending=True).tolist()
    return [f"{CONTROLS[i]:20s} missed {missed[i]:.2f}   invented {invented[i]:.2f}" for i in order if supported[i]]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--features", type=Path, required=True)
    parser.add_argument("--decoders", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--share", type=float, default=0.02, help="of the frames")
    args = parser.parse_args()
    checkpoint, data = torch.load(args.decoders), of_stride(torch.load(args.features), 1)
    decoder = ControlsDecoder().eval()
    decoder.load_state_dict(checkpoint["controls_decoder"])
    told = shown(answers(decoder, data["features"]))
    errors, signed = weighted_errors(told, data, checkpoint["supported"])
    tracks, frames = worst_frames(errors, max(1, int(args.share * errors.numel()))).T
    with whole(args.out) as out:
        np.savez(out, controls=data["controls"][tracks, frames].float().numpy())
    print("\n".join(report(signed, data["controls"].float(), checkpoint["supported"] > 0.5)))
    print(f"{len(tracks)} poses of {errors.numel()} frames, their error {errors[tracks, frames].mean() / errors.mean():.1f} times the mean")


def self_test():
    errors = torch.zeros(2, 40)
    errors[0, 10], errors[0, 12], errors[1, 30], errors[0, 25] = 5.0, 4.0, 3.0, 2.0
    assert worst_frames(errors, 3).tolist() == [[0, 10], [1, 30], [0, 25]]
    truth = torch.rand(2, 40, len(CONTROLS), generator=torch.Generator().manual_seed(1))
    data = {"controls": truth, "visible": torch.ones_like(truth)}
    everything = torch.ones(len(CONTROLS))
    error, signed = weighted_errors(truth.clone(), data, everything)
    assert float(error.max()) == 0
    wrong = truth.clone()
    wrong[1, 7, CONTROLS.index("jawOpen")] = 1 - wrong[1, 7, CONTROLS.index("jawOpen")]
    error, signed = weighted_errors(wrong, data, everything)
    assert worst_frames(error, 1).tolist() == [[1, 7]]
    print("hard_cases: ok")


if __name__ == "__main__":
    main()
