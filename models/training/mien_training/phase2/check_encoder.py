"""Validation of encoders through the program: portraits in the wild, measured as evaluate_wild.py does on test people,
and videos of a person who speaks.

usage: python3 -m mien_training.phase2.check_encoder [--mien PROGRAM] [--every 3] MODELS...
Only the videos show motion: one encoder rose on portraits and on rendered people, each with a face of its own, and its
pucker fell here from 0.78 to 0.62. Encoders learn from no image of the speaker, of the pack av, but some renders move
as the curves say.
"""
import argparse
from pathlib import Path

import numpy as np

from mien_training.data import faces
from mien_training.data.expressions import CONTROLS
from mien_training.evaluate import curves, teacher
from mien_training.evaluate.evaluate_wild import TURNED, Answers
from mien_training.evaluate.program import Program
from mien_training.paths import ROOT, data


def portrait_figures(program, lod, portraits):
    answers = Answers(program, lod, portraits)
    ahead = portraits.labels.yaw() < np.radians(TURNED)
    every, near = answers.summary(ahead | True), answers.summary(ahead)
    return (f"{every['found']:.1%} of {len(portraits)} correct, {near['found']:.1%} of {ahead.sum()} up to {TURNED} "
            f"degrees; landmark error {every['error']:.4f}, correlation {every['correlation']:.3f}")


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


def speech_figures(rows):
    """A line for each control that moves, with a correlation for each element of `rows`."""
    for control, row in rows[0].items():
        values = [each[control]["correlation"] for each in rows]
        if (row["spread"] or 0) >= teacher.MOVES and None not in values:
            yield control.ljust(20) + "".join(f"{value:7.2f}" for value in values)


def main():
    parser = argparse.ArgumentParser(description="Validates encoders through the program.")
    parser.add_argument("--mien", type=Path, default=ROOT / "build/release/apps/mien/mien", help="the built program")
    parser.add_argument("--every", type=int, default=3, help="take every Nth video")
    parser.add_argument("models", type=Path, nargs="+", metavar="MODELS")
    args = parser.parse_args()
    programs = [Program(args.mien, models) for models in args.models]
    portraits = faces.Portraits("val", ("faces_wild",))
    for lod in (1, 4):
        print(f"level {lod}")
        for program in programs:
            print(f"{program.models}: {portrait_figures(program, lod, portraits)}", flush=True)
        print(*speech_figures([followed(program, lod, args.every) for program in programs]), sep="\n", flush=True)


if __name__ == "__main__":
    main()
