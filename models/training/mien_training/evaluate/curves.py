"""Readers of the output of `mien track` and of the teacher (MediaPipe Face Landmarker)."""
import csv
import json

import numpy as np
from scipy.spatial.transform import Rotation

from mien_training.paths import ROOT

MODELS = ROOT / "models"


def read_table(path):
    """A CSV with one row per frame: {column: array}; numbers as float64 with empty cells NaN, `status` as text."""
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    columns = zip(*rows[1:]) if len(rows) > 1 else [[] for _ in rows[0]]
    number = lambda cells: np.array([float(c) if c else np.nan for c in cells])
    return {name: np.array(cells) if name == "status" else number(cells) for name, cells in zip(rows[0], columns)}


def read_landmarks(path):
    """Landmarks [frames,175,2] in pixels; NaN without a face."""
    table = read_table(path)
    count = (len(table) - 1) // 2
    return np.stack([np.stack([table[f"x{i}"], table[f"y{i}"]], -1) for i in range(count)], 1)


def rotations(table):
    """R = Ry(yaw) Rx(pitch) Rz(roll) of every row, [frames,3,3]."""
    angles = np.stack([table[f"{name}_rad"] for name in ("yaw", "pitch", "roll")], 1)
    matrices = np.full((len(angles), 3, 3), np.nan)
    known = np.isfinite(angles).all(1)
    if known.any():  # older SciPy accepts no empty list
        matrices[known] = Rotation.from_euler("YXZ", angles[known]).as_matrix()
    return matrices


def blendshapes(data, controls):
    """The teacher's `controls` [n,controls] of an archive; NaN: unknown to it."""
    column = {str(name): values for name, values in zip(data["blendshape_names"], data["blendshapes"].astype(float).T)}
    return np.stack([column.get(name, np.full(len(data["blendshapes"]), np.nan)) for name in controls], 1)


class Teacher:
    """MediaPipe's answer for one clip, in our landmarks and controls."""

    def __init__(self, path, controls):
        data = np.load(path, allow_pickle=True)
        self.t_ms, self.found = data["t_ms"].astype(np.float64), data["found"].astype(bool)
        self.shares = data["landmarks"][..., :2].astype(np.float64)
        self.rotation = data["matrix_colmajor"].reshape(-1, 4, 4).transpose(0, 2, 1)[:, :3, :3].astype(np.float64)
        self.controls = blendshapes(data, controls)

    def points(self, size_wh):
        """(landmarks [n,175,2], outer eye corner distance [n], pupil distance [n]) in pixels."""
        points = self.shares * np.asarray(size_wh, np.float64)
        table = json.loads((MODELS / "landmarks.json").read_text())["points"]
        distance = lambda a, b: np.linalg.norm(points[:, a] - points[:, b], axis=-1)
        return points[:, [p["mediapipe"] for p in table]], distance(33, 263), distance(468, 473)
