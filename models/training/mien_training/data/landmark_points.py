"""The 175 landmarks: their names and their counterparts among the teacher's 478 points (MediaPipe Face Landmarker).

Right and left are the subject's. A pair is listed right side first; its two lists mirror each other point by point.
"""
import json
from functools import lru_cache

import numpy as np

from mien_training.paths import ROOT

EYE_LOWER = ([33, 7, 163, 144, 145, 153, 154, 155, 133], [263, 249, 390, 373, 374, 380, 381, 382, 362])
EYE_UPPER = ([246, 161, 160, 159, 158, 157, 173], [466, 388, 387, 386, 385, 384, 398])
IRIS = ([468, 469, 470, 471, 472], [473, 476, 475, 474, 477])  # centre, nasal, top, temporal, bottom
BROW_UPPER = ([70, 63, 105, 66, 107], [300, 293, 334, 296, 336])
BROW_LOWER = ([46, 53, 52, 65, 55], [276, 283, 282, 295, 285])
NOSE_SIDE = ([97, 75, 98, 64, 48, 129, 198, 217], [326, 305, 327, 294, 278, 358, 420, 437])
CHEEK = ([50, 205, 101, 118, 187], [280, 425, 330, 347, 411])

NOSE_BRIDGE = [168, 6, 197, 195, 5, 4, 1, 2]
MIDLINE = [151, 9, 199]  # forehead, glabella, chin
# Closed or open curves from the subject's right corner to the left one.
LIPS_OUTER_UPPER = [61, 185, 40, 39, 37, 0, 267, 269, 270, 409, 291]
LIPS_OUTER_LOWER = [146, 91, 181, 84, 17, 314, 405, 321, 375]
LIPS_INNER_UPPER = [78, 191, 80, 81, 82, 13, 312, 311, 310, 415, 308]
LIPS_INNER_LOWER = [95, 88, 178, 87, 14, 317, 402, 318, 324]
# From the top of the forehead over the subject's left side round the chin.
FACE_OVAL = [10, 338, 297, 332, 284, 251, 389, 356, 454, 323, 361, 288, 397, 365, 379, 378, 400, 377, 152,
             148, 176, 149, 150, 136, 172, 58, 132, 93, 234, 127, 162, 21, 54, 103, 67, 109]

IBUG68 = [162, 234, 93, 58, 172, 136, 149, 148, 152, 377, 378, 365, 397, 288, 323, 454, 389,
          70, 63, 105, 66, 107, 336, 296, 334, 293, 300, 168, 197, 5, 4, 75, 97, 2, 326, 305,
          33, 160, 158, 133, 153, 144, 362, 385, 387, 263, 373, 380,
          61, 39, 37, 0, 267, 269, 291, 405, 314, 17, 84, 181, 78, 82, 13, 312, 308, 317, 14, 87]


def _pairs():
    return {"eye_lower": EYE_LOWER, "eye_upper": EYE_UPPER, "iris": IRIS, "brow_upper": BROW_UPPER,
            "brow_lower": BROW_LOWER, "nose_side": NOSE_SIDE, "cheek": CHEEK}


def _curves():
    return {"nose_bridge": NOSE_BRIDGE, "midline": MIDLINE, "lips_outer_upper": LIPS_OUTER_UPPER,
            "lips_outer_lower": LIPS_OUTER_LOWER, "lips_inner_upper": LIPS_INNER_UPPER,
            "lips_inner_lower": LIPS_INNER_LOWER, "face_oval": FACE_OVAL}


def named_points():
    """(name, teacher index) of the 175 landmarks, in their order."""
    points = []
    for name, (right, left) in _pairs().items():
        points += [(f"right_{name}_{i}", k) for i, k in enumerate(right)]
        points += [(f"left_{name}_{i}", k) for i, k in enumerate(left)]
    for name, curve in _curves().items():
        points += [(f"{name}_{i}", k) for i, k in enumerate(curve)]
    return points


@lru_cache
def template():
    """[175,2] of the mean face in its crop, 0..1."""
    return np.array(json.loads((ROOT / "models/landmarks.json").read_text())["template"])


@lru_cache
def head():
    """[175,3] of an average head at rest, in its own frame (docs/pose.md), metres."""
    return np.array(json.loads((ROOT / "models/landmarks.json").read_text())["head"])


def _teacher_mirror():
    """Teacher index -> index of its mirror image."""
    mirror = {}
    for right, left in _pairs().values():
        mirror.update(zip(right, left))
        mirror.update(zip(left, right))
    for curve in (LIPS_OUTER_UPPER, LIPS_OUTER_LOWER, LIPS_INNER_UPPER, LIPS_INNER_LOWER, FACE_OVAL[1:]):
        mirror.update(zip(curve, reversed(curve)))
    mirror.update({k: k for k in NOSE_BRIDGE + MIDLINE + FACE_OVAL[:1]})
    return mirror


TEACHER = [k for _, k in named_points()]
POSITION = {k: i for i, k in enumerate(TEACHER)}
MIRROR = [POSITION[_teacher_mirror()[k]] for k in TEACHER]
IBUG = [POSITION[k] for k in IBUG68]
OUTER_EYE_CORNERS = (POSITION[33], POSITION[263])

assert len(TEACHER) == 175 and len(POSITION) == 175
assert all(MIRROR[MIRROR[i]] == i for i in range(175))
