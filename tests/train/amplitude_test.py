#!/usr/bin/env python3
"""Measurement of amplitude and of closed eyes, and its restoration by a refitted output layer."""
import unittest
from pathlib import Path

import numpy as np
import torch

from mien_training.data import eyelids
from mien_training.data import landmark_points as lp
from mien_training.data.expressions import CONTROLS, INDEX
from mien_training.evaluate import evaluate_amplitude as measured
from mien_training.phase2 import refit_outputs as refit

ROOT = Path(__file__).resolve().parents[2]

torch.set_num_threads(1)


class Measures(unittest.TestCase):
    def test_half_the_motion_has_half_the_slope_and_deviation(self):
        truth = np.random.default_rng(0).random((3, 40, len(CONTROLS)))
        np.testing.assert_allclose(measured.slopes(0.5 * truth + 0.1, truth), 0.5)
        np.testing.assert_allclose(measured.ratios(0.5 * truth + 0.1, truth), 0.5)
        self.assertTrue(np.isnan(measured.ratios(truth, np.ones_like(truth))).all())

    def test_blinks_are_found_where_they_were_counted(self):
        curve = np.zeros(60)
        curve[10:13], curve[30], curve[50] = (0.4, 0.9, 0.4), 0.3, 0.7
        peaks, false = measured.blinks_of(curve, [[11, 12], [28, 29]])
        self.assertEqual((peaks, false), ([0.9, 0.3], 1))

    def test_every_counted_blink_has_its_frames_in_order(self):
        spans = [s for name, counted in measured.BLINKS.items() if name != "about" for s in counted]
        self.assertGreater(len(spans), 10)
        self.assertTrue(all(first < last < first + 12 for first, last in spans))


class Eyelids(unittest.TestCase):
    def face(self, height):
        """Landmarks of eyes of width 1 whose lids are `height` apart."""
        points = torch.zeros(175, 2)
        for inner in (362, 133):
            points[lp.POSITION[inner], 0] = 1
        for _, pairs in eyelids.EYES.values():
            for upper, _ in pairs:
                points[lp.POSITION[upper], 1] = height
        return points

    def test_open_and_closed_whatever_the_size(self):
        for size in (1.0, 40.0):
            self.assertEqual((eyelids.closures(self.face(0.35) * size)).tolist(), [0, 0])
            self.assertEqual((eyelids.closures(self.face(0.05) * size)).tolist(), [1, 1])
            middle = eyelids.closures(self.face((eyelids.OPEN + eyelids.CLOSED) / 2) * size)
            self.assertTrue(torch.allclose(middle, torch.tensor([0.5, 0.5]), atol=1e-5))


class Refit(unittest.TestCase):
    def made(self, gain):
        """Renders and portraits of a layer that outputs `gain` times the truth, from states that determine it."""
        torch.manual_seed(1)

        def part(rows):
            made = refit.Parts.__new__(refit.Parts)
            controls = torch.rand(rows, len(CONTROLS)) * (torch.rand(rows, 1) > 0.2)
            made.hidden = torch.cat([controls, torch.randn(rows, 96 - len(CONTROLS)), torch.ones(rows, 1)], 1)
            made.controls, made.seen = controls, torch.ones_like(controls)
            made.closed = controls[:, [INDEX["eyeBlinkLeft"], INDEX["eyeBlinkRight"]]]
            return made
        layer = torch.zeros(len(CONTROLS), 97)
        layer[range(len(CONTROLS)), range(len(CONTROLS))] = gain
        return layer, part(3000), part(2000)

    def test_amplitude_comes_back_and_faces_at_rest_stay_there(self):
        layer, renders, portraits = self.made(0.7)
        after = refit.refitted(layer, renders, portraits)
        answers = renders.hidden @ after.T
        ratio = answers.std(0) / renders.controls.std(0)
        self.assertGreater(float(ratio.min()), 0.83)
        self.assertLess(float(ratio.max()), 1.1)
        still = renders.controls.amax(1) == 0
        self.assertLess(float(answers[still].abs().max()), 0.05)

    def test_what_does_not_follow_the_truth_gets_no_gain(self):
        layer, renders, portraits = self.made(0.7)
        funnel = INDEX["mouthFunnel"]
        layer[funnel] = 0
        layer[funnel, [60, -1]] = torch.tensor([0.1, -0.1])  # noise, which the clamp keeps low at rest
        after = refit.refitted(layer, renders, portraits)
        self.assertTrue(torch.equal(after[funnel], layer[funnel]))

    def test_neutral_portraits_get_little(self):
        layer, renders, portraits = self.made(1.0)
        brow = INDEX["browDownLeft"]
        layer[brow, -1] = 0.3
        rows = refit.neutral(portraits)
        self.assertGreater(int(rows.sum()), 100)
        after = refit.quieted(layer, portraits, rows, refit.NEUTRAL)
        self.assertLess(float(refit.mean_answer(after, portraits, rows).max()), refit.NEUTRAL + 0.01)
        others = [i for i in range(len(CONTROLS)) if i != brow]
        self.assertTrue(torch.equal(after[others], layer[others]))

    def test_rendered_faces_at_rest_get_little(self):
        layer, renders, portraits = self.made(1.0)
        layer[INDEX["browOuterUpLeft"], -1] = 0.08
        after = refit.refitted(layer, renders, portraits)
        self.assertGreater(float(refit.mean_answer(layer, renders, refit.resting(renders)).max()), 0.07)
        self.assertLess(float(refit.mean_answer(after, renders, refit.resting(renders)).max()), refit.RESTING + 0.005)

    def test_eyelids_close_in_winks(self):
        layer, renders, _ = self.made(1.0)
        left, right = INDEX["eyeBlinkLeft"], INDEX["eyeBlinkRight"]
        renders.controls[:, [left, right]] = renders.hidden[:, [left, right]] = 0
        renders.controls[:40, left] = renders.controls[40:80, right] = 1
        renders.hidden[:80, [left, right]] = renders.controls[:80, [left, right]]
        layer[right] *= 0.7
        gain = lambda eye, other, rest: refit.wink_gain(layer, eye, other, rest, renders)
        rest = torch.zeros(len(CONTROLS))
        self.assertEqual(gain(left, right, rest), 1)  # which closes already
        needed = gain(right, left, rest)
        self.assertAlmostEqual(needed * 0.7, refit.CLOSED, delta=0.7 * refit.WINK_STEP)
        layer[right, -1] = 0.18  # the open eye of a wink is nearly too closed
        layer[right, right] = 0.4
        limited = gain(right, left, rest)
        self.assertLessEqual(limited * 0.18, refit.OPEN)
        self.assertLess(limited, 0.9 / 0.58)
        few = refit.WINKS - 1
        renders.controls[few:40, left] = 0
        self.assertEqual(gain(right, left, rest), 1)

    def test_a_refit_raises_the_closed_eye_of_winks(self):
        layer, renders, portraits = self.made(0.7)
        left, right = INDEX["eyeBlinkLeft"], INDEX["eyeBlinkRight"]
        portraits.closed[:, 1] *= 0.75  # portraits that ask for less
        after = refit.refitted(layer, renders, portraits)
        rows = refit.winks(renders, right, left)
        self.assertGreater(int(rows.sum()), refit.WINKS)
        self.assertGreater(float(refit.mean_answer(after, renders, rows)[right]), refit.CLOSED - 0.03)

    def test_what_moves_enough_is_left_alone(self):
        layer, renders, portraits = self.made(1.0)
        after = refit.refitted(layer, renders, portraits)
        others = [i for i, name in enumerate(CONTROLS) if not name.startswith(("eyeBlink", "eyeLook", "mouthSmile"))]
        self.assertTrue(torch.equal(after[others], layer[others]))

    def test_gaze_is_learned_where_the_decoder_has_none(self):
        layer, renders, portraits = self.made(1.0)
        gaze = [i for i, name in enumerate(CONTROLS) if name.startswith("eyeLook")]
        layer[gaze] = 0
        answers = portraits.hidden @ refit.refitted(layer, renders, portraits).T
        self.assertLess(float((answers - portraits.controls)[:, gaze].abs().max()), 0.02)


if __name__ == "__main__":
    unittest.main()
