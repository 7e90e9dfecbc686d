#!/usr/bin/env python3
"""Random expressions and curves are possible, smooth, balanced, and equal for equal seeds."""
import functools
import unittest

import numpy as np

from mien_training.data import expressions as e

FRAMES = 90


@functools.lru_cache
def stills(count=1000, seed=1):
    rng = np.random.default_rng(seed)
    return np.stack([e.sample_still(rng) for _ in range(count)])


@functools.lru_cache
def sequences(count=12, seed=2):
    rng = np.random.default_rng(seed)
    return np.stack([e.sample_sequence(rng, FRAMES) for _ in range(count)])


class Expressions(unittest.TestCase):
    def test_same_seed_same_faces(self):
        np.testing.assert_array_equal(stills.__wrapped__(20), stills.__wrapped__(20))
        np.testing.assert_array_equal(sequences.__wrapped__(3), sequences.__wrapped__(3))
        self.assertFalse(np.array_equal(stills(20), stills(20, seed=9)))

    def test_controls_stay_in_range_and_legal(self):
        for c in (stills(), sequences()):
            get = lambda name: c[..., e.INDEX[name]]
            self.assertTrue(np.isfinite(c).all() and c.min() >= 0 and c.max() <= 1)
            self.assertTrue((get("mouthClose") <= get("jawOpen") + 1e-6).all())
            self.assertTrue((get("jawOpen")[get("tongueOut") > 0.01] > 0.3).all(), "a tongue needs an open mouth")
            for a, b in (("jawLeft", "jawRight"), ("mouthLeft", "mouthRight"), ("eyeLookUpLeft", "eyeLookDownLeft")):
                self.assertLess(np.minimum(get(a), get(b)).max(), 1e-6, (a, b))

    def test_every_control_is_exercised(self):
        strong = (stills() > 0.5).mean(0)
        idle = [n for n, share in zip(e.CONTROLS, strong) if share < 0.01]
        self.assertEqual(idle, [])

    def test_sides_are_balanced(self):
        mean = stills(1500).mean(0)
        np.testing.assert_allclose(mean, mean[e.MIRROR], atol=0.04)

    def test_leaning_faces_are_those_of_before_on_one_side(self):
        rng, straight = np.random.default_rng(5), stills()
        leaning = np.stack([e.lean(rng, face) for face in straight])
        self.assertTrue((leaning <= straight).all())
        uneven = lambda c: np.abs(c[:, e.PAIRED_LEFT] - c[:, e.PAIRED_RIGHT])
        smile = e.PAIRED.index("mouthSmile")
        for pair, before, after in zip(e.PAIRED, (uneven(straight) > 0.3).mean(0), (uneven(leaning) > 0.3).mean(0)):
            self.assertGreaterEqual(after,
                                    0 if pair in ("jaw", "mouth") or pair.startswith("eyeLook") else 1.2 * before, pair)
        lean = (leaning[:, e.PAIRED_LEFT[smile]] - leaning[:, e.PAIRED_RIGHT[smile]]).mean()
        self.assertLess(abs(lean), 0.02, "to both sides alike")

    def test_of_units_apart_one_of_a_region_moves(self):
        rng = np.random.default_rng(7)
        faces = np.stack([e.sample_apart(rng) for _ in range(3000)])
        self.assertGreater((faces > 0.5).mean(0).min(), 0.005, "each control has its turn")
        np.testing.assert_allclose(faces.mean(0), faces.mean(0)[e.MIRROR], atol=0.02)
        needs_jaw = (faces[:, [e.INDEX["tongueOut"], e.INDEX["mouthClose"]]] > 0).any(1)
        mouth = [i for i, n in enumerate(e.CONTROLS) if n.startswith(("jaw", "mouth", "cheekPuff", "tongue"))]
        units = [{e.CONTROLS[i].removesuffix("Left").removesuffix("Right") for i in mouth if face[i] > 0}
                 for face in faces[~needs_jaw]]
        self.assertLessEqual(max(map(len, units)), 1)
        blink = np.sort(faces[:, [e.INDEX["eyeBlinkLeft"], e.INDEX["eyeBlinkRight"]]], 1)
        self.assertGreater(((blink[:, 0] == 0) & (blink[:, 1] > 0)).mean(), 0.05, "one eye alone")

    def test_stills_without_shares_are_those_of_before(self):
        a, b = (np.random.default_rng(3) for _ in range(2))
        np.testing.assert_array_equal(e.sample_stills(a, 50), np.stack([e.sample_still(b) for _ in range(50)]))

    def test_a_phone_takes_part_only_where_it_is_asked_to(self):
        a, b = (np.random.default_rng(4) for _ in range(2))
        np.testing.assert_array_equal(e.sample_sequence(a, 40), e.sample_sequence(b, 40, phone=0.0))
        if not e.recordings.phone_takes(e.NAMES):
            self.skipTest("the recordings of the phone are not here")
        curves = np.stack([e.sample_sequence(np.random.default_rng(k), 120, phone=1.0) for k in range(40)])
        self.assertTrue(curves.min() >= 0 and curves.max() <= 1)
        for name in ("jawOpen", "eyeBlinkLeft", "mouthPucker", "cheekPuff", "noseSneerRight"):
            self.assertGreater(curves[..., e.INDEX[name]].max(), 0.25, name)
        np.testing.assert_allclose(curves.mean((0, 1)), curves.mean((0, 1))[e.MIRROR], atol=0.06)

    def test_lessons_are_legal(self):
        curves = np.stack([e.sample_lesson(np.random.default_rng(k), 30) for k in range(20)])
        self.assertTrue(np.isfinite(curves).all() and curves.min() >= 0 and curves.max() <= 1)
        self.assertTrue((curves[..., e.INDEX["mouthClose"]] <= curves[..., e.INDEX["jawOpen"]] + 1e-6).all())

    def test_mirror_is_its_own_inverse(self):
        self.assertEqual([e.MIRROR[m] for m in e.MIRROR], list(range(52)))
        self.assertEqual(e.MIRROR[e.INDEX["eyeLookInLeft"]], e.INDEX["eyeLookInRight"])

    def test_curves_move_smoothly_but_for_blinks_and_saccades(self):
        step = np.abs(np.diff(sequences(), axis=1)).max((0, 1))
        quick = [n for n in e.CONTROLS if n.startswith("eye")]
        slow = [e.INDEX[n] for n in e.CONTROLS if n not in quick and not n.startswith(("jaw", "mouth", "tongue"))]
        self.assertLess(step[slow].max(), 0.75)
        self.assertGreater(step[e.INDEX["eyeBlinkLeft"]], 0.3, "fast blinks occur")


if __name__ == "__main__":
    unittest.main()
