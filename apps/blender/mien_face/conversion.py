"""Values of one vocabulary from those of another, as in mien_vocabulary_values of mien's C API."""

import math

from .vocabularies import ROBLOX, VISEME_POSES, VISEMES, VRM0, VRM1

ROWS = {"roblox": ROBLOX, "vrm0": VRM0, "vrm1": VRM1}
VOCABULARIES = ("arkit", "roblox", "visemes", "vrm1", "vrm0")

_POSES = tuple(VISEME_POSES.values())
_MOUTH = {control for pose in _POSES for control in pose}
_GRAM = [[sum(value * b.get(control, 0.0) for control, value in a.items()) for b in _POSES] for a in _POSES]
_TOLERANCE = 1e-12


def _combined(combination, values):
    """None if a control that the row needs has no value."""
    known = [value for value in values if value is not None]
    if combination == "max":
        return max(known, default=None)
    if len(known) < len(values):
        return None
    return min(known) if combination == "min" else sum(known) / max(1, len(known))


def _of_rows(rows, controls):
    found = ((name, _combined(how, [controls.get(control) for control in row])) for name, (how, row) in rows.items())
    return {name: value for name, value in found if value is not None}


def _solve(target, chosen):
    """Least squares over the chosen poses by Cholesky decomposition; weights in the order of `chosen`."""
    lower, y = [], []
    for row, i in enumerate(chosen):
        line = []
        for column, j in enumerate(chosen[:row]):
            known = sum(line[k] * lower[column][k] for k in range(column))
            line.append((_GRAM[i][j] - known) / lower[column][column])
        line.append(math.sqrt(_GRAM[i][i] - sum(value * value for value in line)))
        y.append((target[i] - sum(line[k] * y[k] for k in range(row))) / line[row])
        lower.append(line)
    solution = [0.0] * len(chosen)
    for row in reversed(range(len(chosen))):
        known = sum(lower[k][row] * solution[k] for k in range(row + 1, len(chosen)))
        solution[row] = (y[row] - known) / lower[row][row]
    return solution


def _step(weights, chosen, wanted):
    """Moves towards `wanted` until a weight would become negative. Returns False if it reaches `wanted`."""
    limits = [weights[i] / (weights[i] - goal) for i, goal in zip(chosen, wanted) if goal <= 0.0]
    step = min(limits, default=1.0)
    for i, goal in zip(chosen, wanted):
        weights[i] += min(1.0, step) * (goal - weights[i])
    if step >= 1.0:
        return False
    for i, goal in list(zip(chosen, wanted)):
        if goal <= 0.0 and weights[i] <= _TOLERANCE:
            chosen.remove(i)
            weights[i] = 0.0
    return True


def _mixture(target):
    """Non-negative least squares (Lawson and Hanson, 1974, chapter 23)."""
    weights, chosen = [0.0] * len(_POSES), []
    for _ in range(10 * len(_POSES)):
        gradient = [target[i] - sum(g * w for g, w in zip(_GRAM[i], weights)) for i in range(len(_POSES))]
        free = [i for i in range(len(_POSES)) if i not in chosen and gradient[i] > _TOLERANCE]
        if not free:
            break
        chosen = sorted([*chosen, max(free, key=gradient.__getitem__)])
        while _step(weights, chosen, _solve(target, chosen)):
            pass
    return weights


def _visemes(controls):
    """The mixture of poses nearest to the mouth, and silence as the remainder to 1."""
    if not _MOUTH & controls.keys():
        return {}
    weights = _mixture([sum(value * controls.get(control, 0.0) for control, value in pose.items()) for pose in _POSES])
    total = sum(weights)
    shares = [max(0.0, 1.0 - total), *(min(1.0, weight / max(1.0, total)) for weight in weights)]
    return dict(zip(VISEMES, shares))


def values_in(vocabulary, frame):
    """The frame's values in a vocabulary, by name; empty if they do not follow from the frame."""
    if vocabulary in frame.values:
        return frame.values[vocabulary]
    controls = frame.values.get("arkit", {})
    if vocabulary == "visemes":
        return _visemes(controls)
    return _of_rows(ROWS[vocabulary], controls) if vocabulary in ROWS and controls else {}
