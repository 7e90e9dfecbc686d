#!/usr/bin/env python3
"""Runs `mien track` on single pictures never trained on: portraits, and pieces of places without a face.

The portraits' landmarks are MediaPipe's; a portrait counts as found when mien's box overlaps the right one.
"""
import argparse
import json
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import cv2
import numpy as np
from PIL import Image

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "train"))
import curves  # noqa: E402
import faces  # noqa: E402
import landmark_points as lp  # noqa: E402
import metrics  # noqa: E402
from paths import ROOT, data  # noqa: E402
from proposal_data import iou  # noqa: E402
from renderer.assets import names  # noqa: E402


def track(program, picture, folder, number):
    """(box (cx, cy, side), landmarks [175,2]) of the one face mien finds in a picture uint8 [h,w,3], or None."""
    image, table, points = (folder / f"{number}.{kind}" for kind in ("png", "csv", "landmarks.csv"))
    cv2.imwrite(str(image), picture[..., ::-1])
    subprocess.run([program, "track", image, "-o", table, "--landmarks", points, "--quiet"], check=True)
    row = curves.read_table(table)
    if row["status"][0] != "tracking":
        return None
    side = row["w"][0]
    return np.array([row["x"][0] + side / 2, row["y"][0] + side / 2, side]), curves.read_landmarks(points)[0]


def empty_places(count, seed):
    """Pieces of held-out environments, of many sizes."""
    rng = np.random.default_rng(seed)
    pictures = [np.asarray(Image.open(data() / f"environments/{name}.jpg").convert("RGB")) for name in names("environments", "test")]
    for _ in range(count):
        picture = pictures[rng.integers(len(pictures))]
        side = int(np.exp(rng.uniform(np.log(120), np.log(min(picture.shape[:2])))))
        x, y = rng.integers(0, picture.shape[1] - side + 1), rng.integers(0, picture.shape[0] - side + 1)
        yield np.ascontiguousarray(picture[y:y + side, x:x + side])


def score_portraits(found, portraits):
    hits, errors = [], []
    for answer, box, points in zip(found, portraits.crops[:, :3], portraits.points):
        hits.append(answer is not None and iou(answer[0][None], box)[0] > 0.4)
        if hits[-1]:
            a, b = lp.OUTER_EYE_CORNERS
            errors.append(metrics.point_error(answer[1][None], points[None], np.linalg.norm(points[a] - points[b]))[0])
    return {"portraits": len(hits), "found": float(np.mean(hits)), "landmark_error_outer_eyes": float(np.mean(errors)),
            "landmark_error_p95": float(np.percentile(errors, 95))}


def markdown(report):
    r = report
    return "\n".join([
        "# Single pictures never trained on", "", "Made by `scripts/evaluate/evaluate_pictures.py`.", "",
        f"* {r['portraits']} test portraits: the face found in {100 * r['found']:.1f} %; landmarks "
        f"{100 * r['landmark_error_outer_eyes']:.2f} % of the outer eye corner distance from MediaPipe's (95th percentile "
        f"{100 * r['landmark_error_p95']:.2f} %).",
        f"* {r['places']} pieces of held-out places without a face: a face claimed in {r['false_faces']}.", ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--mien", required=True, help="the built program")
    parser.add_argument("--places", type=int, default=400, help="pictures without a face")
    parser.add_argument("--out", type=Path, default=ROOT / "docs/results")
    args = parser.parse_args()
    portraits = faces.portraits("test")
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(2) as pool:
        ask = lambda job: track(args.mien, job[1], Path(folder), job[0])
        found = list(pool.map(ask, ((f"face{i}", picture) for i, (picture, _) in enumerate(portraits))))
        empty = list(pool.map(ask, ((f"place{i}", picture) for i, picture in enumerate(empty_places(args.places, 5)))))
    report = {**score_portraits(found, portraits), "places": len(empty), "false_faces": sum(e is not None for e in empty)}
    (args.out / "pictures.json").write_text(json.dumps(report, indent=1) + "\n")
    (args.out / "pictures.md").write_text(markdown(report))
    print(json.dumps(report))


if __name__ == "__main__":
    main()
