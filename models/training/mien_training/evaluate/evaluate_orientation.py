"""The program on held-out portraits at any roll, as the first image of a video and as a face that enters a scene.

A detection is correct if the mean landmark error is below a share of the distance between the pupils within a second.
"""
import cv2
import numpy as np

from mien_training.data import faces
from mien_training.data import landmark_points as lp
from mien_training.evaluate import metrics
from mien_training.evaluate import report as out
from mien_training.evaluate.inputs import Missing
from mien_training.evaluate.program import FPS, y4m

SIZE = 480           # pixels of the square image
SHARE = 0.5          # of it that the portrait takes
CORRECT = 0.15       # of the pupils' distance
ROLLS = (0, 30, 60, 90, 120, 150, 180, -150, -120, -90, -60, -30)  # degrees clockwise
COUNT = 40           # portraits
FIRST, ENTERS = "first image", "enters an empty scene"


def turned(picture, points, roll):
    """The portrait in the middle of a plain square image, and its points [n,2]."""
    scale = SHARE * SIZE / max(picture.shape[:2])
    middle = np.array(picture.shape[1::-1]) / 2
    matrix = cv2.getRotationMatrix2D(tuple(map(float, middle)), -roll, scale)
    matrix[:, 2] += SIZE / 2 - middle
    image = cv2.warpAffine(picture, matrix, (SIZE, SIZE), flags=cv2.INTER_AREA, borderValue=(96, 96, 96))
    return image, points @ matrix[:, :2].T + matrix[:, 2]


def is_correct(tracked, points):
    pupils = np.linalg.norm(points[lp.POSITION[lp.IRIS[0][0]]] - points[lp.POSITION[lp.IRIS[1][0]]])
    error = metrics.point_error(tracked.landmarks[-1:], points[None], pupils)[0]
    return tracked.table["status"][-1] == "tracking" and error < CORRECT


def measure(setting):
    portraits = faces.Portraits("test", ("faces",))
    if not len(portraits):
        raise Missing("the portraits are absent: MIEN_DATA must name the folder of the data packs")
    chosen = np.linspace(0, len(portraits) - 1, min(COUNT, len(portraits))).astype(int)
    empty = np.full((SIZE, SIZE, 3), 96, np.uint8)
    report = {"portraits": len(chosen), "levels": {}}
    for name, lod in setting.levels("orientation").items():
        found = {FIRST: {}, ENTERS: {}}
        for roll in ROLLS:
            shown = [turned(portraits[i][0], portraits.points[i], roll) for i in chosen]
            tracked = {FIRST: [0] * 2, ENTERS: [1] * 5 + [0] * FPS}
            for how, order in tracked.items():
                right = [is_correct(setting.program.track(y4m([image, empty], order), lod), points)
                         for image, points in shown]
                found[how][str(roll)] = out.rounded(np.mean(right))
        report["levels"][name] = found
    return report


def markdown(report):
    levels = report["levels"]
    worst = lambda found: min(v for k, v in found.items() if k != "0") / found["0"]
    lines = ["# Faces at any orientation", "", "For everyone whose faces are not upright.",
             ""] + out.prose(f"""At the worst roll, turned faces are correctly detected this often relative to upright
        ones: in the first image {out.by_level(levels, lambda r: f"{100 * worst(r[FIRST]):.0f} %")}; within a second of
        entering an empty scene {out.by_level(levels, lambda r: f"{100 * worst(r[ENTERS]):.0f} %")}.""")
    lines += out.prose(
        f"""The data are {report['portraits']} held-out portraits, half as large as the plain image of {SIZE} x {SIZE}
        pixels. Correct: a mean landmark error below {100 * CORRECT:.0f} % of the distance between the pupils.""")
    header = ["roll to either side", *(f"{how}, {out.level(name)}" for name in levels for how in (FIRST, ENTERS))]
    share = lambda found, roll: np.mean([found[str(r)] for r in ROLLS if abs(r) == roll])
    rows = [[str(roll), *(f"{100 * share(found[how], roll):.0f} %" for found in levels.values()
                          for how in (FIRST, ENTERS))] for roll in (0, 90, 180)]
    return "\n".join(lines + out.table(header, rows))
