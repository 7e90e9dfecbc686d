"""Wrinkles that come with an expression: where it pushes skin together, skin folds across the push and the folds lie in shadow.

The rig's shapes have no folds of their own. Here the mesh tells how much of its length every neighbourhood lost along the two
directions in which faces fold, up and down (forehead, nose, chin) and sideways (between the brows, beside the eyes and the mouth);
folds are waves on the head at rest, so that they come and go where they are. Only their shade is shown, not their shape.
"""
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix, diags, identity

FROM, FULLY = 0.06, 0.40     # loss of length at which folds begin, and beyond which they are as deep as they get
SPACING = (0.7, 1.3)         # cm from fold to fold
BETWEEN = 0.35               # how dark skin gets between folds, of how dark in them
AXES = [1, 0]                # pushes along y, then x


@dataclass
class Wrinkles:
    """Of one person."""
    depth: float             # 0 none .. 1
    spacing: float           # cm
    phase: np.ndarray        # f32 [2] radians
    wobble: float            # how far folds stray from straight lines, cm


def sample(rng, old):
    """Deeper on old skin, hardly there on many young faces."""
    depth = rng.uniform(0.4, 1) if old else rng.choice([rng.uniform(0, 0.15), rng.uniform(0.15, 0.8)])
    return Wrinkles(depth, rng.uniform(*SPACING), np.float32(rng.uniform(0, 2 * np.pi, 2)), rng.uniform(0.05, 0.3))


class Folding:
    """The skin of the face, as what can be pushed together."""

    def __init__(self, triangles, count):
        self.count = count
        self.inside, corners = np.unique(triangles, return_inverse=True)
        n, corners = len(self.inside), corners.reshape(-1, 3)
        edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
        self.first, self.second = np.divmod(np.unique(np.sort(edges, 1) @ [n, 1]), n)
        ones, numbers = np.ones(len(self.first), np.float32), np.arange(len(self.first))
        ends = lambda ids: csr_matrix((ones, (ids, numbers)), (n, len(numbers)))
        self.gather = ends(self.first) + ends(self.second)  # [vertices,edges]
        neighbours = csr_matrix((ones, (self.first, self.second)), (n, n))
        neighbours = neighbours + neighbours.T + identity(n, dtype=np.float32)
        mean = diags(1 / neighbours.sum(1).A1) @ neighbours
        self.smooth = csr_matrix(mean @ mean, dtype=np.float32)

    def push(self, rest, posed):
        """Share of its length that the skin around every vertex of the face has lost along y and x, [vertices,2]."""
        before, now = rest[self.second] - rest[self.first], posed[self.second] - posed[self.first]
        squared = (before * before).sum(1) + 1e-6
        lost = 1 - np.sqrt((now * now).sum(1) / squared)
        along = before[:, AXES] ** 2 / squared[:, None]
        return self.smooth @ ((self.gather @ (along * lost[:, None])) / (self.gather @ along + 1e-3))

    def openness(self, rest, posed, wrinkles):
        """How much light reaches every vertex for its folds, f32 [vertices] in 0..1; heads [vertices,3] at rest and posed."""
        out = np.ones(self.count, np.float32)
        rest, posed = rest[self.inside], posed[self.inside]
        depth = 1 - np.exp(-3 * np.clip((self.push(rest, posed) - FROM) / (FULLY - FROM), 0, 1))
        across, along = rest[:, AXES], rest[:, AXES[::-1]]
        bent = across + wrinkles.wobble * np.sin(1.1 * along + wrinkles.phase[::-1])
        waves = 0.5 + 0.5 * np.cos(2 * np.pi * bent / wrinkles.spacing + wrinkles.phase)
        out[self.inside] -= 0.6 * wrinkles.depth * (depth * (BETWEEN + (1 - BETWEEN) * waves ** 2)).max(1)
        return out


def self_test():
    """A sheet that is squeezed along y folds across y, deepest where the waves say; one at rest or stretched does not."""
    y, x = np.mgrid[0:30, 0:30].astype(np.float32) * 0.3
    rest = np.stack([x.ravel(), y.ravel(), np.zeros(900, np.float32)], 1)
    corner = (np.arange(29)[:, None] * 30 + np.arange(29)).ravel()
    triangles = np.concatenate([corner[:, None] + [0, 1, 30], corner[:, None] + [1, 31, 30]])
    folding, wrinkles = Folding(triangles, 900), Wrinkles(1.0, 1.2, np.zeros(2, np.float32), 0.0)
    posed = lambda sx, sy: rest * np.float32([sx, sy, 1])
    assert np.abs(folding.openness(rest, rest, wrinkles) - 1).max() < 1e-5
    assert np.abs(folding.openness(rest, posed(1.2, 1.1), wrinkles) - 1).max() < 1e-5
    pushed = folding.push(rest, posed(1.0, 0.7)).reshape(30, 30, 2)[5:-5, 5:-5]
    assert pushed[..., 0].min() > 0.2 and pushed[..., 1].max() < pushed[..., 0].min() / 2, (pushed.min((0, 1)), pushed.max((0, 1)))
    shade = folding.openness(rest, posed(1.0, 0.7), wrinkles).reshape(30, 30)[5:-5, 5:-5]
    assert shade.min() < 0.75 and shade.std(0).mean() > 5 * shade.std(1).mean()
    print("wrinkles: ok")


if __name__ == "__main__":
    self_test()
