"""Whether controls follow a person who speaks: the correlation with MediaPipe within the videos of one person, the
speaker of the pack av. Encoders learn from no image of this person; some renders move as the curves say.

usage: python3 -m mien_training.phase2.check_speech [--mien PROGRAM] [--lod 1] [--every 3] MODELS...
Portraits and rendered people, each with a face of its own, do not show it: one encoder rose on both of them and its
pucker fell here from 0.78 to 0.62.
"""
import argparse
from pathlib import Path

import numpy as np

from mien_training.data.expressions import CONTROLS
from mien_training.evaluate import curves, teacher
from mien_training.evaluate.program import Program
from mien_training.paths import ROOT, data


def clips(every):
    """(path, MediaPipe's controls [frames,52], whether it found a face [frames]) of each `every`th video."""
    known = np.load(data() / "av/curves.npz")
    controls, found = curves.blendshapes(known, CONTROLS), known["found"].astype(bool)
    spans = {str(clip): slice(*known["offset"][i:i + 2]) for i, clip in enumerate(known["clip"])}
    for path in sorted((data() / "av/video").glob("*.mp4"))[::every]:
        yield path, controls[spans[path.stem]], found[spans[path.stem]]


def followed(program, lod, every):
    """{control: its row of compare_controls}, without the mean of each clip."""
    ours, theirs = [], []
    for path, truth, found in clips(every):
        table = program.track(path, lod).table
        frames = min(len(truth), len(table["t_ms"]))
        both = found[:frames] & (table["status"][:frames] == "tracking")
        centred = lambda values: values[:frames][both] - values[:frames][both].mean(0)
        ours.append(centred(np.stack([table[c] for c in CONTROLS], 1)))
        theirs.append(centred(truth))
    return teacher.compare_controls(np.concatenate(ours), np.concatenate(theirs))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--mien", type=Path, default=ROOT / "build/release/apps/mien/mien", help="the built program")
    parser.add_argument("--lod", type=int, default=1)
    parser.add_argument("--every", type=int, default=3, help="take every Nth video")
    parser.add_argument("models", type=Path, nargs="+", metavar="MODELS")
    args = parser.parse_args()
    found = [followed(Program(args.mien, models), args.lod, args.every) for models in args.models]
    for control, row in found[0].items():
        values = [each[control]["correlation"] for each in found]
        if (row["spread"] or 0) >= teacher.MOVES and None not in values:
            print(control.ljust(20), *(f"{value:6.2f}" for value in values))


if __name__ == "__main__":
    main()
