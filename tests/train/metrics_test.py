"""Metrics of the evaluation."""
import unittest

import cv2
import numpy as np

from mien_training.data import landmark_points as lp
from mien_training.evaluate.metrics import (
    area_under_roc,
    asymmetry,
    constant_errors,
    correlations,
    facs_error,
    jitter,
    jitter_of_stretches,
    known_mean,
    linear_map_error,
    still_stretches,
)
from mien_training.evaluate.skin_tone import NO_TONE, angle, cheeks, group


class Metrics(unittest.TestCase):
    def test_known_values(self):
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
        assert [area_under_roc(np.array(scores), said)
                for scores in ([3, 1, 4, 2], [1, 3, 2, 4], [2, 1, 4, 3])] == [1, 0, 0.75]
        points = np.zeros((12, 5, 2))
        points[4:, :, 0] = 1  # one jump between two pauses of 4 and 8 frames
        assert still_stretches(points, np.ones(12)) == [slice(4, 12)]
        assert still_stretches(points, np.ones(12), least=4) == [slice(0, 4), slice(4, 12)]
        assert still_stretches(points, np.full(12, 1000.0)) == [slice(0, 12)]
        trembling = np.concatenate([ramp[0], zigzag[0]])
        assert abs(jitter_of_stretches(trembling, [slice(0, 6), slice(6, 12)]) - 2 / 6) < 1e-12
        assert np.isnan(jitter_of_stretches(trembling, []))


class SkinTone(unittest.TestCase):
    def test_groups_and_cheeks(self):
        of = lambda *rgb: group(angle(np.float32([rgb]) / 255))
        assert of(128, 128, 128) == NO_TONE and group(angle([])) == NO_TONE
        assert of(245, 220, 200) == "very light" and of(200, 160, 130) in ("light", "intermediate") and of(90, 60,
                                                                                                           45) == "dark"
        lab = cv2.cvtColor(np.float32([[[0.8, 0.6, 0.5]]]), cv2.COLOR_RGB2LAB)[0, 0]
        assert abs(angle(np.float32([[0.8, 0.6, 0.5]])) - np.degrees(np.arctan((lab[0] - 50) / lab[2]))) < 1e-3
        picture = np.zeros((100, 100, 3), np.uint8)
        picture[:, :50], picture[:, 50:] = (200, 0, 0), (0, 200, 0)
        points = np.zeros((175, 2))
        for x, side in zip((20, 70), lp.CHEEK):
            points[[lp.POSITION[k] for k in side]] = np.array([[0, 0], [10, 0], [10, 10], [0, 10], [5, 5]]) + [x, 40]
        assert np.allclose(cheeks(picture, points) * 255, [[200, 0, 0], [0, 200, 0]], atol=1e-3)


if __name__ == "__main__":
    unittest.main()
