"""Wrinkles: where an expression compresses the skin, it folds across the compression and darkens in the folds.

The shapes of the rig have no folds. The mesh gives the compression of each neighbourhood along the two directions in
which faces fold, vertical (forehead, nose, chin) and horizontal (between the brows, beside eyes and mouth). Folds are
waves on the head at rest, so they stay in place. They change the shading only, not the shape.
"""
from dataclasses import dataclass

import numpy as np

from mien_training.renderer import native

FROM, FULLY = 0.06, 0.40     # loss of length at which folds begin, and beyond which they are as deep as they get
SPACING = (0.7, 1.3)         # cm from fold to fold
BETWEEN = 0.35               # how dark skin gets between folds, of how dark in them
DARKEST = 0.6                # share of the light that the deepest folds take
AXES = [1, 0]                # pushes along y, then x


@dataclass
class Wrinkles:
    """The wrinkles of one person."""
    depth: float             # 0 none .. 1
    spacing: float           # cm
    phase: np.ndarray        # f32 [2] radians
    wobble: float            # how far folds stray from straight lines, cm


def sample(rng, old):
    """Deeper on old skin, hardly there on many young faces."""
    depth = rng.uniform(0.4, 1) if old else rng.choice([rng.uniform(0, 0.15), rng.uniform(0.15, 0.8)])
    return Wrinkles(depth, rng.uniform(*SPACING), np.float32(rng.uniform(0, 2 * np.pi, 2)), rng.uniform(0.05, 0.3))


def edges_of(triangles):
    """Vertices [edges] of every edge of triangles [n,3], the lower one first."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]).astype(np.int64)
    return np.divmod(np.unique(np.sort(edges, 1) @ [1 << 32, 1]), 1 << 32)


class Skin:
    """The skin of the face as a mesh that can be compressed."""

    def __init__(self, triangles, count):
        self.count = count
        self.first, self.second = (ids.astype(np.int32) for ids in edges_of(triangles))
        self.vertex, corners = np.unique(np.concatenate([self.first, self.second]), return_inverse=True)
        self.at, self.to = np.int32(corners).reshape(2, -1)
        n = len(self.vertex)
        ends = np.concatenate([np.arange(n), self.at, self.to])
        others = np.concatenate([np.arange(n), self.to, self.at])
        order = np.argsort(ends, kind="stable")
        self.neighbour = np.int32(others[order])
        self.start = np.int32(np.concatenate([[0], np.cumsum(np.bincount(ends, minlength=n))]))

    def around(self, values):
        """Sums [skin,2] of values [edges,2] over the edges at every vertex."""
        ends = np.concatenate([self.at, self.to])
        return np.stack([np.bincount(ends, np.tile(column, 2), len(self.vertex)) for column in values.T], 1)


class Folding:
    """How the skin of one person folds; rest f32 [vertices,3] is the head at rest."""

    def __init__(self, skin, rest, wrinkles):
        self.count = skin.count
        edge, here = rest[skin.second] - rest[skin.first], rest[skin.vertex]
        square = (edge * edge).sum(1) + 1e-6
        along = edge[:, AXES] ** 2 / square[:, None]
        bent = here[:, AXES] + wrinkles.wobble * np.sin(1.1 * here[:, AXES[::-1]] + wrinkles.phase[::-1])
        waves = 0.5 + 0.5 * np.cos(2 * np.pi * bent / wrinkles.spacing + wrinkles.phase)
        shade = DARKEST * wrinkles.depth * (BETWEEN + (1 - BETWEEN) * waves ** 2)
        ints = [skin.first, skin.second, skin.at, skin.to, skin.start, skin.neighbour, np.int32(skin.vertex)]
        floats = [np.ascontiguousarray(a, np.float32) for a in (square, along, 1 / (skin.around(along) + 1e-3), shade)]
        self.folds = native.folds(ints, floats, FROM, FULLY)

    def openness(self, posed):
        """How much light reaches every vertex of the posed head f32 [vertices,3] for its folds, f32 [vertices] in
        0..1."""
        return native.darkened(self.folds, np.ascontiguousarray(posed, np.float32), np.ones(self.count, np.float32))
