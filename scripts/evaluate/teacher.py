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
    """{control: correlation, error after the best linear map, that of the teacher's mean, the teacher's spread}, of [n,52] each."""
    both = np.flatnonzero(np.isfinite(ours).all(0) & np.isfinite(theirs).all(0))
    ours, theirs = ours[:, both], theirs[:, both]
    correlation, (error, constant) = metrics.correlations(ours, theirs), metrics.linear_map_error(ours, theirs)
    rows = zip(correlation, error, constant, theirs.std(0))
    names = ("correlation", "error", "constant_error", "spread")
    return {CONTROLS[i]: dict(zip(names, out.rounded(row))) for i, row in zip(both, rows)}


def control_lines(rows):
    """Table of compare_controls, those that move first."""
    order = sorted(rows.items(), key=lambda item: (item[1]["spread"] < MOVES, -(item[1]["correlation"] or -1)))
    cells = [[c + ("" if r["spread"] >= MOVES else " (hardly moves)"), out.number(r["correlation"], 2), out.number(r["error"]),
              out.number(r["constant_error"]), out.number(r["spread"])] for c, r in order]
    return out.table(["control", "correlation", "error after the best linear map", "the same of a constant", "MediaPipe's spread"], cells)
