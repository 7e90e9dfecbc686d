#!/usr/bin/env python3
"""The metrics of the evaluation, one definition for every script. Run as a program it tests itself.

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
    """Mean of what is known; NaN where nothing is."""
    values = np.asarray(values, np.float64)
    known = np.isfinite(values)
    count = known.sum(axis)
    return np.where(count > 0, np.where(known, values, 0).sum(axis) / np.maximum(count, 1), np.nan)[()]


def linear_map_error(answers, wanted):
    """Mean |error| of each column of `wanted` [n,c] after the best linear map of `answers`, and that of its mean alone: [2,c]."""
    a, b = answers - answers.mean(0), wanted - wanted.mean(0)
    slope = (a * b).sum(0) / np.maximum((a * a).sum(0), 1e-9)
    return np.abs(b - slope * a).mean(0), np.abs(b).mean(0)


def still_stretches(points, scale, most=0.003, least=6):
    """Runs (slices of at least `least` frames) in which the mean point of [n,p,2] moves by at most `most` of `scale` [n] a frame."""
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


def self_test():
    still = np.zeros((1, 6, 1))
    assert jitter(still) == 0
    ramp = np.arange(6.0)[None, :, None]
    assert jitter(ramp) == 0
    zigzag = np.array([0, 1, 0, 1, 0, 1.0])[None, :, None]
    assert abs(jitter(zigzag) - 4 / 6) < 1e-12  # five differences, four turns of size 1
    assert abs(jitter(np.concatenate([ramp, zigzag], 2)) - 2 / 6) < 1e-12
    rng = np.random.default_rng(0)
    truth = rng.random((3, 50, 4))
    assert np.allclose(correlations(2 * truth + 1, truth), 1) and np.allclose(correlations(-truth, truth), -1)
    assert np.isnan(correlations(np.ones_like(truth), truth)).all()
    assert constant_errors(truth)["median"] <= constant_errors(truth)["mean"]
    assert asymmetry(truth * [1, 0, 1, 1], np.ones_like(truth), [(0, 1)]) == truth[..., 0].mean()
    assert facs_error(truth + 0.25, truth) - 0.25 < 1e-12
    assert np.array_equal(known_mean([[1.0, np.nan], [3, np.nan]]), [2, np.nan], equal_nan=True)
    fitted, constant = linear_map_error(truth[0], 3 * truth[0] - 1)
    assert np.allclose(fitted, 0) and (constant > 0.1).all()
    said = np.array([True, False, True, False])
    assert [area_under_roc(np.array(scores), said) for scores in ([3, 1, 4, 2], [1, 3, 2, 4], [2, 1, 4, 3])] == [1, 0, 0.75]
    points = np.zeros((12, 5, 2))
    points[4:, :, 0] = 1  # one jump between two pauses of 4 and 8 frames
    assert still_stretches(points, np.ones(12)) == [slice(4, 12)]
    assert still_stretches(points, np.ones(12), least=4) == [slice(0, 4), slice(4, 12)]
    assert still_stretches(points, np.full(12, 1000.0)) == [slice(0, 12)]
    trembling = np.concatenate([ramp[0], zigzag[0]])
    assert abs(jitter_of_stretches(trembling, [slice(0, 6), slice(6, 12)]) - 2 / 6) < 1e-12
    assert np.isnan(jitter_of_stretches(trembling, []))
    print("metrics: ok")


if __name__ == "__main__":
    self_test()
