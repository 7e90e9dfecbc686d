"""The metrics of the evaluation, one definition for every script.

Curves are [frames, controls] of one uninterrupted stream; several streams are given as [streams, frames, controls].
"""
import numpy as np


def facs_error(predicted, truth):
    """Mean absolute difference to the truth."""
    return float(np.abs(predicted - truth).mean()) if truth.size else float("nan")


def area_under_roc(scores, truth):
    """The share of pairs that are in the right order."""
    order = np.argsort(scores, kind="stable")
    ranks = np.empty(len(scores))
    ranks[order] = np.arange(1, len(scores) + 1)
    positive = truth.sum()
    return (ranks[truth].sum() - positive * (positive + 1) / 2) / max(positive * (len(truth) - positive), 1)


def jitter(curves):
    """Sum of |first difference| where its sign differs from the previous frame's, over frames and controls."""
    if not curves.size:
        return float("nan")
    step = np.diff(curves, axis=-2)
    turned = np.sign(step[..., 1:, :]) != np.sign(step[..., :-1, :])
    return float((np.abs(step[..., 1:, :]) * turned).sum() / curves.size)


def constant_errors(truth):
    """FACS error of answering each control's mean, and its median (the best constant there is)."""
    if not truth.size:
        return {"mean": float("nan"), "median": float("nan")}
    flat = truth.reshape(-1, truth.shape[-1])
    return {"mean": facs_error(flat.mean(0), flat), "median": facs_error(np.median(flat, 0), flat)}


def correlations(predicted, truth, weight=None):
    """Pearson correlation of every control [c]; NaN where the truth or the prediction is constant."""
    p, t = (a.reshape(-1, a.shape[-1]).astype(np.float64) for a in (predicted, truth))
    w = np.ones_like(t) if weight is None else weight.reshape(t.shape).astype(np.float64)
    w = w / np.maximum(w.sum(0), 1e-9)
    p, t = p - (w * p).sum(0), t - (w * t).sum(0)
    spread = np.sqrt((w * p * p).sum(0) * (w * t * t).sum(0))
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(spread > 1e-9, (w * p * t).sum(0) / spread, np.nan)


def asymmetry(curves, truth, pairs, tolerance=0.05):
    """Mean |left - right| over (left, right) index pairs, where the truth of a pair is symmetric."""
    left, right = np.array(pairs).T
    symmetric = np.abs(truth[..., left] - truth[..., right]) < tolerance
    return float(np.abs(curves[..., left] - curves[..., right])[symmetric].mean())


def known_mean(values, axis=0):
    """Mean of the known values; NaN without any."""
    values = np.asarray(values, np.float64)
    known = np.isfinite(values)
    count = known.sum(axis)
    return np.where(count > 0, np.where(known, values, 0).sum(axis) / np.maximum(count, 1), np.nan)[()]


def linear_map_error(answers, wanted):
    """Mean |error| of each column of `wanted` [n,c] after the best linear map of `answers`, and that of its mean alone:
    [2,c]."""
    a, b = answers - answers.mean(0), wanted - wanted.mean(0)
    slope = (a * b).sum(0) / np.maximum((a * a).sum(0), 1e-9)
    return np.abs(b - slope * a).mean(0), np.abs(b).mean(0)


def still_stretches(points, scale, most=0.003, least=6):
    """Runs (slices of at least `least` frames) in which the mean point of [n,p,2] moves by at most `most` of `scale`
    [n] a frame."""
    step = np.linalg.norm(np.diff(points, axis=0), axis=-1).mean(-1) / scale[1:]
    still = np.concatenate([[False], step <= most, [False]]).astype(int)
    starts, ends = np.flatnonzero(np.diff(still) == 1), np.flatnonzero(np.diff(still) == -1)
    return [slice(a, b + 1) for a, b in zip(starts, ends) if b + 1 - a >= least]


def jitter_of_stretches(curves, stretches):
    """Jitter over several uninterrupted pieces of curves [n,c]."""
    sizes = [curves[s].size for s in stretches]
    return float(np.average([jitter(curves[s]) for s in stretches], weights=sizes)) if sizes else float("nan")


def point_error(predicted, truth, scale):
    """Mean point distance of every frame over a length: predicted, truth [n,p,2], scale [n] -> [n]."""
    return np.linalg.norm(predicted - truth, axis=-1).mean(-1) / scale
