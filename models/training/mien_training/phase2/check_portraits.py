"""Validation portraits in the wild through the program, as evaluate_wild.py measures test portraits: which encoder to
choose.

usage: python3 -m mien_training.phase2.check_portraits [--mien PROGRAM] MODELS...
"""
import argparse
from pathlib import Path

import numpy as np

from mien_training.data import faces
from mien_training.evaluate.evaluate_wild import TURNED, Answers
from mien_training.evaluate.program import Program
from mien_training.paths import ROOT


def figures(program, lod, portraits):
    answers = Answers(program, lod, portraits)
    ahead = portraits.labels.yaw() < np.radians(TURNED)
    every, near = answers.summary(ahead | True), answers.summary(ahead)
    return (f"level {lod}: {every['found']:.1%} of {len(portraits)} correct, {near['found']:.1%} of {ahead.sum()} up "
            f"to {TURNED} degrees; landmark error {every['error']:.4f}, correlation {every['correlation']:.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--mien", type=Path, default=ROOT / "build/release/apps/mien/mien", help="the built program")
    parser.add_argument("models", type=Path, nargs="+", metavar="MODELS")
    args = parser.parse_args()
    portraits = faces.Portraits("val", ("faces_wild",))
    for models in args.models:
        for lod in (1, 4):
            print(f"{models}: {figures(Program(args.mien, models), lod, portraits)}", flush=True)


if __name__ == "__main__":
    main()
