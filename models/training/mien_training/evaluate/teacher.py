"""Agreement with MediaPipe Face Landmarker, a teacher and not the truth."""
import numpy as np
from scipy.spatial.transform import Rotation

from mien_training.data.expressions import CONTROLS
from mien_training.evaluate import metrics
from mien_training.evaluate import report as out

MOVES = 0.02  # standard deviation of a control of the teacher's that responds


def pose_difference(ours, theirs):
    """Angles [n] in degrees between two lists of rotations after the best constant rotation is removed."""
    between = Rotation.from_matrix(theirs).inv() * Rotation.from_matrix(ours)
    return np.degrees((between.mean().inv() * between).magnitude())


def compare_controls(ours, theirs, weight=None):
    """{control: correlation, error after the best linear map, error of the teacher's mean, the teacher's spread}, of
    [n,52] each; weight [n,52], of correlations.

    All controls of the teacher; those that mien does not drive have no correlation.
    """
    known = np.flatnonzero(np.isfinite(theirs).all(0))
    ours, theirs = ours[:, known], theirs[:, known]
    weight = None if weight is None else weight[:, known]
    driven = np.isfinite(ours).all(0)
    correlation = np.where(driven, metrics.correlations(np.nan_to_num(ours), theirs, weight), np.nan)
    error, constant = metrics.linear_map_error(np.nan_to_num(ours), theirs)
    rows = zip(correlation, np.where(driven, error, np.nan), constant, theirs.std(0))
    names = ("correlation", "error", "constant_error", "spread")
    return {CONTROLS[i]: dict(zip(names, out.rounded(row))) for i, row in zip(known, rows)}

