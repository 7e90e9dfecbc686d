"""Recorded motion of real faces: GRID's speaker through the video teacher, and an actor through an iPhone.

Functions take the names of the controls in their order; curves are f32 [n,52]. The same generator state gives the same
curve.
"""
import functools
import re

import numpy as np

from mien_training.paths import data

GRID_FPS, PHONE_FPS = 25, 30
DEAD = ("cheek", "noseSneer", "jawForward")        # the video teacher never moves these
SQUINT_AT_REST = 0.4                               # of the video teacher's eyeSquint
SPREAD_OF_GAINS = 0.2                              # of single controls on the phone, in log


def table_of(names, source_names, values):
    """Columns of values [n,k] in the order of names; a control that the source does not have stays 0."""
    known = {re.sub("^.", lambda m: m[0].lower(), str(name)): i for i, name in enumerate(source_names)}
    columns = [values[:, known[name]] if name in known else np.zeros(len(values)) for name in names]
    return np.float32(np.stack(columns, 1))


@functools.lru_cache(maxsize=1)
def grid_clips(names):
    """Clips of one speaker at 25 fps; every tenth is held out."""
    path = data() / "av/curves.npz"
    if not path.exists():
        return []
    source = np.load(path, allow_pickle=True)
    table = table_of(names, source["blendshape_names"], source["blendshapes"])
    for i, name in enumerate(names):
        if name.startswith(DEAD):
            table[:, i] = 0
        if name.startswith("eyeSquint"):
            table[:, i] = np.maximum(table[:, i] - SQUINT_AT_REST, 0) / (1 - SQUINT_AT_REST)
    offset, found = source["offset"], source["found"].astype(bool)
    spans = [slice(offset[i], offset[i + 1]) for i in range(len(offset) - 1) if i % 10]
    return [table[s] for s in spans if found[s].all() and s.stop - s.start > 30]


@functools.lru_cache(maxsize=1)
def phone_takes(names):
    """Takes of one actor at 30 fps, who goes through all expressions."""
    path = data() / "arkit_curves/curves.npz"
    if not path.exists():
        return []
    source = np.load(path, allow_pickle=True)
    table = table_of(names, source["names"], source["values"])
    return [table[a:b] for a, b in zip(source["offset"], source["offset"][1:])]


def replayed(clip, start, step, frames):
    """Frames of a clip from `start` on, `step` frames apart, played forwards and backwards if it is too short."""
    at = start + step * np.arange(frames)
    at = np.abs((at + len(clip) - 1) % (2 * (len(clip) - 1)) - (len(clip) - 1))
    low = np.floor(at).astype(int)
    high = np.minimum(low + 1, len(clip) - 1)
    return clip[low] + (at - low)[:, None] * (clip[high] - clip[low])


def of_grid(rng, frames, fps, names):
    """A clip of GRID with random speed and gain."""
    clips = grid_clips(names)
    clip = clips[rng.integers(len(clips))]
    step = GRID_FPS / fps * rng.uniform(0.75, 1.3)
    curve = replayed(clip, rng.uniform(0, len(clip)), step, frames)
    return (curve * rng.uniform(0.7, 1.7)).astype(np.float32)


def of_phone(rng, frames, fps, names, mirror):
    """A part of a take of the phone with random speed, every control with a gain of its own, as it is or mirrored.

    mirror: index of every control's counterpart.
    """
    takes = phone_takes(names)
    take = takes[rng.integers(len(takes))]
    step = PHONE_FPS / fps * rng.uniform(0.75, 1.3)
    gains = rng.uniform(0.8, 1.3) * np.exp(rng.normal(0, SPREAD_OF_GAINS, len(names)))
    gains = (gains + gains[mirror]) / 2  # both sides of a pair the same
    curve = replayed(take, rng.uniform(0, len(take)), step, frames) * gains
    return np.float32(curve[:, mirror] if rng.random() < 0.5 else curve)
