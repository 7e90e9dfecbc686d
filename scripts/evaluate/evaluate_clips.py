#!/usr/bin/env python3
"""Runs `mien track` on the evaluation clips and compares it with MediaPipe Face Landmarker, frame by frame.

The teacher is not the truth: its controls rest at their own levels and some never move. Correlations are
taken within a clip (every clip's mean removed), because levels differ from person to person.
"""
import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "train"))
import curves  # noqa: E402
import metrics  # noqa: E402
from expressions import CONTROLS  # noqa: E402
from paths import ROOT, data  # noqa: E402


def track(program, clip, folder, options):
    """(curves table, landmarks [n,175,2]) of one clip."""
    table, points = folder / f"{clip.stem}.csv", folder / f"{clip.stem}.landmarks.csv"
    command = [program, "track", clip, "-o", table, "--landmarks", points, "--quiet", *options]
    subprocess.run([str(c) for c in command], check=True)
    return curves.read_table(table), curves.read_landmarks(points)


def video_size(clip):
    command = ["ffprobe", "-v", "error", "-select_streams", "v:0", "-show_entries", "stream=width,height",
               "-of", "csv=p=0", str(clip)]
    return [int(v) for v in subprocess.check_output(command, text=True).strip().strip(",").split(",")[:2]]


def nearest(t_ms, wanted):
    """Index into t_ms of the time nearest to each wanted one."""
    return np.abs(np.asarray(t_ms)[None] - np.asarray(wanted)[:, None]).argmin(1)


def pose_difference(ours, theirs):
    """Angles [n] in degrees between two rotation tracks after the best constant rotation is removed."""
    between = theirs.transpose(0, 2, 1) @ ours
    u, _, vt = np.linalg.svd(between.mean(0))
    mean = u @ np.diag([1, 1, np.linalg.det(u @ vt)]) @ vt
    trace = np.einsum("nij,ij->n", between, mean)
    return np.degrees(np.arccos(np.clip((trace - 1) / 2, -1, 1)))


def compare(table, landmarks, teacher, size_wh):
    """Numbers of one clip, and its mean-free controls on common frames for pooling."""
    rows = nearest(table["t_ms"], teacher.t_ms)
    values = np.stack([table[c] for c in CONTROLS], 1)
    points, eyes, pupils = teacher.points(size_wh)
    face = table["status"][rows] == "tracking"
    both = face & teacher.found
    result = {"frames": len(rows), "face_share": float(face[teacher.found].mean())}
    if not both.any():
        return result, None
    error = metrics.point_error(landmarks[rows][both], points[both], 1)
    result["landmark_error_outer_eyes"] = float((error / eyes[both]).mean())
    result["landmark_error_pupils"] = float((error / pupils[both]).mean())
    turn = pose_difference(curves.rotations(table)[rows][both], teacher.rotation[both])
    result["pose_difference_deg"] = float(turn.mean())
    supported = np.isfinite(values[table["status"] == "tracking"]).all(0)
    ours, theirs = values[rows][both], teacher.controls[both]
    result["jitter"] = metrics.jitter(ours[:, supported])
    result["teacher_jitter"] = metrics.jitter(theirs[:, supported & np.isfinite(theirs).all(0)])
    return result, (ours - ours.mean(0), theirs - theirs.mean(0))


def pooled_correlations(pairs):
    """{control: (correlation, teacher's within-clip spread)} for the controls both drive."""
    ours, theirs = (np.concatenate(p) for p in zip(*pairs))
    values = metrics.correlations(np.nan_to_num(ours), np.nan_to_num(theirs))
    known = np.isfinite(ours).all(0) & np.isfinite(theirs).all(0)
    return {c: (float(values[i]), float(theirs[:, i].std())) for i, c in enumerate(CONTROLS)
            if known[i] and np.isfinite(values[i])}


def markdown(results, correlation):
    """The report; percentages of the outer eye corner and of the pupil distance."""
    lines = ["# Clips of real people against MediaPipe Face Landmarker", "",
             "Made by `scripts/evaluate/evaluate_clips.py`. MediaPipe is a teacher, not the truth.", "",
             "| clip | frames | face found | landmarks, % of outer eye corners | % of pupils | pose, degrees"
             " | jitter x 1e-4 (MediaPipe's) |", "|---|---|---|---|---|---|---|"]
    for name, r in results.items():
        cells = [name, str(r["frames"]), f"{100 * r['face_share']:.1f} %"]
        if "landmark_error_pupils" in r:
            cells += [f"{100 * r['landmark_error_outer_eyes']:.2f}", f"{100 * r['landmark_error_pupils']:.2f}",
                      f"{r['pose_difference_deg']:.2f}", f"{1e4 * r['jitter']:.1f} ({1e4 * r['teacher_jitter']:.1f})"]
        lines.append("| " + " | ".join(cells + ["-"] * (7 - len(cells))) + " |")
    lines += ["", "Face found: share of MediaPipe's frames on which mien tracks. Pose: mean angle after the best constant"
              " rotation is removed.", "", "## Controls, within-clip correlation with MediaPipe", "",
              "Spread: standard deviation of MediaPipe's control within clips; below 0.02 it hardly moves.", "",
              "| control | correlation | spread |", "|---|---|---|"]
    lines += [f"| {c} | {r:.2f} | {s:.3f} |" for c, (r, s) in
              sorted(correlation.items(), key=lambda item: -item[1][0])]
    return "\n".join(lines) + "\n"


def overall(results):
    """Means over all frames of all clips."""
    keys = ["face_share", "landmark_error_outer_eyes", "landmark_error_pupils", "pose_difference_deg", "jitter",
            "teacher_jitter"]
    out = {"frames": sum(r["frames"] for r in results.values())}
    for key in keys:
        pairs = [(r[key], r["frames"]) for r in results.values() if key in r]
        if pairs:
            out[key] = float(np.average([p[0] for p in pairs], weights=[p[1] for p in pairs]))
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--mien", required=True, help="the built program")
    parser.add_argument("--clips", type=Path, default=data() / "clips")
    parser.add_argument("--out", type=Path, default=ROOT / "docs/results")
    parser.add_argument("--keep", type=Path, help="folder for the CSV files")
    parser.add_argument("options", nargs="*", help="further options of `mien track`, after --")
    args = parser.parse_args()
    folder = args.keep or Path(tempfile.mkdtemp())
    folder.mkdir(parents=True, exist_ok=True)
    results, pairs = {}, []
    for path in sorted(args.clips.glob("*.mediapipe.npz")):
        name = path.name[:-len(".mediapipe.npz")]
        clip = next(p for p in args.clips.glob(name + ".*") if p != path)
        table, landmarks = track(args.mien, clip, folder, args.options)
        results[name], pair = compare(table, landmarks, curves.Teacher(path, CONTROLS), video_size(clip))
        pairs += [pair] if pair else []
        print(name, json.dumps(results[name]))
    results["all"] = overall(results)
    correlation = pooled_correlations(pairs) if pairs else {}
    args.out.mkdir(parents=True, exist_ok=True)
    (args.out / "clips.json").write_text(json.dumps({"clips": results, "correlations": correlation}, indent=1) + "\n")
    (args.out / "clips.md").write_text(markdown(results, correlation))
    print("all", json.dumps(results["all"]))


if __name__ == "__main__":
    main()
