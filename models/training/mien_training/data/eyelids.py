"""Eyelid closure from landmarks: the target of eyeBlink for all people, whatever the shape of their eyes.

The median neutral face of the rig has an aperture of 0.34, closed eyes have 0.06; the teacher's eyeBlink is 0.5 at
0.11.
"""
import torch

from mien_training.data import landmark_points as lp

# Outer and inner corner, and pairs of points of the upper and lower lid above each other (teacher indices).
EYES = {"Left": ((263, 362), ((386, 374), (385, 380), (387, 373))),
        "Right": ((33, 133), ((159, 145), (158, 153), (160, 144)))}
OPEN, CLOSED = 0.27, 0.07  # height over width above which an eye counts as open, and below which as closed


def apertures(points):
    """Height over width of both eyes, left first: [...,2] of landmarks [...,175,2]."""
    at = lambda k: points[..., lp.POSITION[k], :]
    out = []
    for (outer, inner), pairs in EYES.values():
        width = (at(outer) - at(inner)).norm(dim=-1).clamp(min=1e-6)
        out.append(sum((at(a) - at(b)).norm(dim=-1) for a, b in pairs) / len(pairs) / width)
    return torch.stack(out, -1)


def closures(points):
    """0 open .. 1 closed, [...,2] of landmarks [...,175,2]."""
    return ((OPEN - apertures(points)) / (OPEN - CLOSED)).clamp(0, 1)
