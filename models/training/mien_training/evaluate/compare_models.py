"""Differences between the controls that two folders of weights give for the same clips, as a Markdown table.

usage: python3 -m mien_training.evaluate.compare_models [--mien PROGRAM] [--levels 1 4] MODELS_A MODELS_B CLIP...
"""
import argparse
import json
from pathlib import Path

import numpy as np

from mien_training.evaluate import curves
from mien_training.evaluate.program import Program
from mien_training.paths import ROOT

GROUPS = {"eyelids": ("eyeBlink", "eyeSquint", "eyeWide"), "gaze": ("eyeLook",), "jaw": ("jaw",), "mouth": ("mouth",),
          "brows": ("brow",), "cheeks, nose": ("cheek", "nose")}


def eyes():
    """Landmarks of the left and of the right eye."""
    points = json.loads((curves.MODELS / "landmarks.json").read_text())["points"]
    return [[p["index"] for p in points if p["name"].startswith(side)] for side in ("left_eye", "right_eye")]


def differences(one, other):
    """{what: [differences]} of the frames with a face in both."""
    faces = (one.table["status"] == "tracking") & (other.table["status"] == "tracking")
    change = {name: np.abs(values - other.table[name])[faces] for name, values in one.table.items() if name != "status"}
    controls = {name: values for name, values in change.items()
                if name.startswith(sum(GROUPS.values(), ())) and np.isfinite(values).any()}
    out = {group: [v for name, v in controls.items() if name.startswith(names)] for group, names in GROUPS.items()}
    out["all controls"] = list(controls.values())
    left, right = (one.landmarks[faces][:, side].mean(1) for side in eyes())
    moved = np.linalg.norm(one.landmarks - other.landmarks, axis=-1)[faces].mean(1)
    out["landmarks (mean of a frame's), % of the distance between the eyes"] = [100 * moved
                                                                                / np.linalg.norm(left - right, axis=-1)]
    out["head, degrees"] = [np.degrees(change[f"{name}_rad"]) for name in ("pitch", "yaw", "roll")]
    out["head, mm"] = [1000 * change[f"t{axis}_m"] for axis in "xyz"]
    return out, int(faces.sum()), int((one.table["status"] != other.table["status"]).sum())


def of_clips(programs, clips, level):
    """{figure: all differences}, number of frames with a face in both results, and of frames with a face in one."""
    seen = [differences(*(program.track(clip, level) for program in programs)) for clip in clips]
    values = {name: np.concatenate([np.ravel(v) for found, *_ in seen for v in found[name]] or [[]])
              for name in seen[0][0]}
    return values, sum(faces for _, faces, _ in seen), sum(unlike for *_, unlike in seen)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--mien", type=Path, default=ROOT / "build/release/apps/mien/mien")
    parser.add_argument("--levels", type=int, nargs="+", default=[1, 4])
    parser.add_argument("models", type=Path, nargs=2)
    parser.add_argument("clips", type=Path, nargs="+")
    options = parser.parse_args()
    programs = [Program(options.mien, models) for models in options.models]
    found = [of_clips(programs, options.clips, level) for level in options.levels]
    for level, (_, faces, unlike) in zip(options.levels, found):
        print(f"Level {level}: a face in both on {faces} frames, in one alone on {unlike}.\n")
    print("| |" + "".join(f" level {level}, mean | largest |" for level in options.levels))
    print("|---|" + 2 * len(options.levels) * "---|")
    for name in found[0][0]:
        cells = [f"{v[name].mean():.2g} | {v[name].max():.2g}" if len(v[name]) else " | " for v, *_ in found]
        print(f"| {name} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
