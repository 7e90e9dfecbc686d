"""Frames filled by tracking backward, on the demo clip and clips of real people, as they are and with the face covered.

Covered clips are gray in the first half second and in half a second in the middle. Filled frames are compared with the
same frames of the whole clip, tracked forward, and so are the first frames that forward tracking has after a detection.
"""
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from mien_training.data import landmark_points as lp
from mien_training.data.expressions import CONTROLS
from mien_training.evaluate import metrics, videos
from mien_training.evaluate import report as out

WIDTH, FRAMES = 640, 150  # of the clips that are covered; shorter ones keep their length
COVERED, MIDDLE = 15, 60  # frames, and the first of those in the middle
WARM = 10                 # frames after a detection to which filled ones are compared


def scaled(clip, folder, name, covered):
    path = Path(folder) / f"{name}.y4m"
    gray = f"drawbox=enable='lt(n,{COVERED})+between(n,{MIDDLE},{MIDDLE + COVERED - 1})':color=gray:t=fill"
    filters = ",".join([f"scale={WIDTH}:-2", *([gray] if covered else [])])
    subprocess.run(["ffmpeg", "-v", "error", "-y", "-i", clip, "-an", "-vf", filters, "-frames:v", str(FRAMES), path],
                   check=True)
    return path


def is_tracked(result):
    return result.table["status"] == "tracking"


def differences(result, truth, rows):
    """Mean difference of controls, and of landmarks in distances between the pupils, on `rows`."""
    ours, theirs = (np.stack([r.table[c][rows] for c in CONTROLS]) for r in (result, truth))
    points = truth.landmarks[rows]
    pupils = np.linalg.norm(points[:, lp.POSITION[lp.IRIS[0][0]]] - points[:, lp.POSITION[lp.IRIS[1][0]]], axis=-1)
    return {"controls": float(np.nanmean(np.abs(ours - theirs))),
            "landmarks": float(np.mean(metrics.point_error(result.landmarks[rows], points, pupils)))}


def covered_clip(program, clip, lod):
    with tempfile.TemporaryDirectory() as folder:
        truth = program.track(scaled(clip, folder, "whole", False), lod)
        covered = scaled(clip, folder, "covered", True)
        forward, both = (program.track(covered, lod, *options) for options in (["--no-backward"], []))
    known = is_tracked(truth)
    filled = np.flatnonzero(is_tracked(both) & ~is_tracked(forward) & known)
    began = np.flatnonzero(np.diff(is_tracked(forward).astype(int)) > 0) + 1
    first = np.unique([f for b in began for f in range(b, min(b + WARM, len(known)))]).astype(int)
    first = first[known[first] & is_tracked(forward)[first]]
    visible = known.copy()
    visible[:COVERED] = visible[MIDDLE:MIDDLE + COVERED] = False
    report = {"visible": int(visible.sum()), "forward": int((is_tracked(forward) & visible).sum()),
              "both": int((is_tracked(both) & visible).sum()),
              "wrong": int((is_tracked(both) & ~is_tracked(forward) & ~visible).sum())}
    if len(filled) and len(first):
        report |= {"filled": differences(both, truth, filled), "first_forward": differences(forward, truth, first)}
    return report


def measure(setting):
    report = {}
    for name, lod in setting.levels("backward").items():
        report[name] = {clip.stem: covered_clip(setting.program, clip, lod) for clip in [videos.DEMO, *videos.clips()]}
    return report


def markdown(report):
    lines = ["# Tracking backward", ""]
    lines += ["For users of `mien track` whose faces appear late or disappear for a while.", ""]
    covered = {name: list(clips.values()) for name, clips in report.items()}
    share = lambda rows, key: 100 * sum(r[key] for r in rows) / sum(r["visible"] for r in rows)
    mean = lambda rows, kind, key: np.mean([r[kind][key] for r in rows if kind in r])
    lines += out.prose(
        f"""The demo clip and the [clips](clips.md), {len(next(iter(covered.values())))} in total, scaled to a width of
        640 pixels, with the face covered for half a second at the start and in the middle:""")
    percent = lambda key: lambda r: f"{share(r, key):.1f} %"
    change = lambda kind: lambda r: (f"{mean(r, kind, 'controls'):.3f}, {100 * mean(r, kind, 'landmarks'):.2f} %")
    figures = (("frames with a visible face that are tracked, forward only", percent("forward")),
               ("the same with tracking backward", percent("both")),
               ("covered frames that were filled", lambda r: str(sum(c["wrong"] for c in r))),
               ("filled frames", change("filled")),
               (f"first {WARM} frames of forward tracking after a detection", change("first_forward")))
    lines += out.table(["", *map(out.level, covered)],
                       [[title, *map(figure, covered.values())] for title, figure in figures])
    return "\n".join(lines + out.prose("""The last two rows are mean differences from the whole clip, tracked forward:
        controls, and landmarks relative to the distance between the pupils."""))
