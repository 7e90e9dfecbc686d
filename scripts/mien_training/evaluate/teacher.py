"""Agreement with MediaPipe Face Landmarker, a teacher and not the truth."""
import numpy as np

from mien_training.data.expressions import CONTROLS
from mien_training.evaluate import metrics
from mien_training.evaluate import report as out

MOVES = 0.02  # standard deviation of a control of the teacher's that responds


def pose_difference(ours, theirs):
    """Angles [n] in degrees between two lists of rotations after the best constant rotation is removed."""
    between = theirs.transpose(0, 2, 1) @ ours
    u, _, vt = np.linalg.svd(between.mean(0))
    mean = u @ np.diag([1, 1, np.linalg.det(u @ vt)]) @ vt
    trace = np.einsum("nij,ij->n", between, mean)
    return np.degrees(np.arccos(np.clip((trace - 1) / 2, -1, 1)))


def compare_controls(ours, theirs):
    """{control: correlation, error after the best linear map, error of the teacher's mean, the teacher's spread}, of
    [n,52] each.

    All controls of the teacher; those that mien does not drive have no correlation.
    """
    known = np.flatnonzero(np.isfinite(theirs).all(0))
    ours, theirs = ours[:, known], theirs[:, known]
    driven = np.isfinite(ours).all(0)
    correlation = np.where(driven, metrics.correlations(np.nan_to_num(ours), theirs), np.nan)
    error, constant = metrics.linear_map_error(np.nan_to_num(ours), theirs)
    rows = zip(correlation, np.where(driven, error, np.nan), constant, theirs.std(0))
    names = ("correlation", "error", "constant_error", "spread")
    return {CONTROLS[i]: dict(zip(names, out.rounded(row))) for i, row in zip(known, rows)}

