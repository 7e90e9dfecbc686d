#!/usr/bin/env python3
"""Decoders of controls that say what they mean: who learns to err least says too little of what moves, and a little where nothing does.

usage: amplify_decoders.py FEATURES DECODERS.pt AMPLIFIED.pt      FEATURES: a folder with those of validation people, as for compare_legs.py

Where a picture leaves a doubt the answer that errs least is the mean of what may be, and that is nearer to rest than what is (regression
towards the mean, Galton 1886). A face made of such answers mumbles. So every supported control gets the greatest gain, and below it an
offset, with which it errs no more than before on rendered validation people and its correlation with their truth and with the teacher's word
of real ones falls by next to nothing. Both sides of a pair get the same. They become part of the last layer, so nothing costs time.
"""
import argparse
from pathlib import Path

import numpy as np
import torch

from compare_legs import figures, real_people, rendered_people
from expressions import CONTROLS, MIRROR
from networks import ControlsDecoder
from shown import shown
from train_decoders import answers
from whole_files import whole

GAINS = np.arange(1, 1.31, 0.05)  # more of it makes noise of expression
OFFSETS = (0.0, 0.0025, 0.005, 0.0075, 0.01, 0.015, 0.02, 0.03)
COST = 0.005                      # of correlation, at most


def judged(parts, gain, offset):
    """(mean absolute error on rendered people [52], correlation [52]) of answers, shifted and scaled; parts as `answered` has them."""
    curves = [shown((told - offset) * gain).numpy() for told, _ in parts]
    truth = parts[0][1]["controls"].float().numpy()
    return np.abs(curves[0] - truth).mean((0, 1)), figures([(c, data) for c, (_, data) in zip(curves, parts)])


def of_pairs(values, worst):
    """What holds for both sides of each pair, as the worse of them has it."""
    return worst(values, values[MIRROR])


def choose(parts):
    """Gains and offsets [52]: the greatest gain that costs nothing, and of its offsets the one that errs least."""
    error_before, correlation_before = judged(parts, 1.0, 0.0)
    gains, offsets, least = np.ones(len(CONTROLS)), np.zeros(len(CONTROLS)), error_before + error_before[MIRROR]
    for gain in GAINS:
        for offset in OFFSETS:
            error, correlation = judged(parts, float(gain), offset)
            error, fall = error + error[MIRROR], of_pairs(correlation_before - correlation, np.fmax)
            free = (error <= error_before + error_before[MIRROR]) & (np.nan_to_num(fall) <= COST)
            better = free & ((gain > gains) | (error < least))
            gains, offsets, least = (np.where(better, new, old) for new, old in ((gain, gains), (offset, offsets), (error, least)))
    return gains, offsets


def answered(decoder, folder):
    """[(answers [n,frames,52], truth)] of rendered people, and of real ones that have held still."""
    rendered, real = rendered_people(folder), real_people(folder)
    last = {name: real[name][:, -1:] for name in ("controls", "visible")}
    return [(answers(decoder, rendered["features"]), rendered), (answers(decoder, real["features"])[:, -1:], last)]


def amplify(decoder, gains, offsets):
    """The last layer of a decoder, in place: what it answered, less the offset, times the gain."""
    gains, offsets = (torch.as_tensor(values, dtype=torch.float32) for values in (gains, offsets))
    with torch.no_grad():
        decoder.output.weight *= gains[:, None]
        decoder.output.bias.copy_((decoder.output.bias - offsets) * gains)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ("features", "decoders", "out"):
        parser.add_argument(name, type=Path)
    args = parser.parse_args()
    torch.set_num_threads(1)
    known, decoder = torch.load(args.decoders), ControlsDecoder()
    decoder.load_state_dict(known["controls_decoder"])
    supported = known["supported"].numpy() > 0
    gains, offsets = choose(answered(decoder.eval(), args.features))
    gains, offsets = np.where(supported, gains, 1), np.where(supported, offsets, 0)
    amplify(decoder, gains, offsets)
    with whole(args.out) as out:
        torch.save(known | {"controls_decoder": decoder.state_dict()}, out)
    for i in np.flatnonzero(supported):
        print(f"{CONTROLS[i].rjust(22)} gain {gains[i]:.2f} offset {offsets[i]:.4f}")


if __name__ == "__main__":
    main()
