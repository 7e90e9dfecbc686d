"""How our answers compare with MediaPipe Face Landmarker's, who is a teacher and not the truth."""
import numpy as np

import metrics
import report as out
from expressions import CONTROLS

MOVES = 0.02  # standard deviation of a control of the teacher's that responds


def pose_difference(ours, theirs):
    """Angles [n] in degrees between two lists of rotations after the best constant rotation is removed."""
    between = theirs.transpose(0, 2, 1) @ ours
    u, _, vt = np.linalg.svd(between.mean(0))
    mean = u @ np.diag([1, 1, np.linalg.det(u @ vt)]) @ vt
    trace = np.einsum("nij,ij->n", between, mean)
    return np.degrees(np.arccos(np.clip((trace - 1) / 2, -1, 1)))


def compare_controls(ours, theirs):
    """{control: correlation, error after the best linear map, that of the teacher's mean, the teacher's spread}, of [n,52] each.

    All controls of the teacher's; those that mien does not drive have no correlation.
    """
    known = np.flatnonzero(np.isfinite(theirs).all(0))
    ours, theirs = ours[:, known], theirs[:, known]
    driven = np.isfinite(ours).all(0)
    correlation = np.where(driven, metrics.correlations(np.nan_to_num(ours), theirs), np.nan)
    error, constant = metrics.linear_map_error(np.nan_to_num(ours), theirs)
    rows = zip(correlation, np.where(driven, error, np.nan), constant, theirs.std(0))
    names = ("correlation", "error", "constant_error", "spread")
    return {CONTROLS[i]: dict(zip(names, out.rounded(row))) for i, row in zip(known, rows)}


def control_lines(levels):
    """Table of compare_controls of each level {name: rows}: controls that the teacher moves and a level supports."""
    last = next(reversed(levels.values()))
    moving = [c for c, r in last.items() if r["spread"] >= MOVES and any(rows[c]["correlation"] is not None for rows in levels.values())]
    moving.sort(key=lambda c: -(last[c]["correlation"] or 0))
    cells = [[c, *(out.number(rows[c]["correlation"], 2) for rows in levels.values()), out.number(last[c]["spread"], 2)] for c in moving]
    return out.table(["control", *(f"correlation, {out.level(name)}" for name in levels), "MediaPipe's deviation"], cells)
