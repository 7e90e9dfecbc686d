#!/usr/bin/env python3
"""The head rig: every control moves the face, and gaze turns the eyes."""
import functools
import unittest

import numpy as np

from mien_training.data import expressions as e
from mien_training.data import landmark_points as lp
from mien_training.paths import data
from mien_training.renderer.rig import Rig

PUPILS = [lp.POSITION[ring[0]] for ring in lp.IRIS]  # right, left
PUPIL_SHIFT = {"In": 0.61, "Out": 0.57, "Up": 0.48, "Down": 0.61}  # cm: 1.05 times the sine of an iPhone's angle


@functools.lru_cache
def rig():
    return Rig()


def shift(controls):
    """Of both pupils [2,3], right first."""
    moved = rig().landmarks(rig().expression(controls[None])[0])
    return moved[PUPILS]


def alone(control):
    out = e.zeros()
    out[e.INDEX[control]] = 1
    return out


class RigTest(unittest.TestCase):
    def setUp(self):
        if not (data() / "rig").exists():
            self.skipTest(f"no rig in {data()}")

    def test_every_control_moves_the_face(self):
        moved = np.linalg.norm(rig().expression(np.eye(52, dtype=np.float32)), axis=-1).max(1)
        self.assertEqual([], [name for name, far in zip(e.CONTROLS, moved) if far < 0.2])

    def test_gaze_turns_the_eye_as_far_as_a_human_one(self):
        away = {"In": (-1, 0), "Out": (1, 0), "Up": (0, 1), "Down": (0, -1)}  # of the left eye; x to the subject's left
        for side, mirror in (("Right", -1), ("Left", 1)):
            for direction, (x, y) in away.items():
                moved = shift(alone(f"eyeLook{direction}{side}"))
                eye, other = (moved[0], moved[1]) if side == "Right" else (moved[1], moved[0])
                expected = np.multiply(PUPIL_SHIFT[direction], [mirror * x, y])
                np.testing.assert_allclose(eye[:2], expected, atol=0.05, err_msg=direction + side)
                self.assertLess(np.abs(other).max(), 0.01)

    def test_eyes_look_the_same_way(self):
        for horizontal, vertical in ((1, 0), (-1, 0), (0, 1), (0, -1), (0.5, -0.5)):
            right, left = shift(e.gaze(horizontal, vertical))[:, :2]
            np.testing.assert_allclose(right, left, atol=0.08)  # an iPhone turns eyes further in than out
            self.assertGreater(right @ [horizontal, vertical], 0.2)


if __name__ == "__main__":
    unittest.main()
