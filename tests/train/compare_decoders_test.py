"""The comparison of decoders: improvements, controls that fall too far, and standard errors."""
import unittest

import numpy as np
import torch

from mien_training.data.expressions import CONTROLS
from mien_training.phase2.compare_decoders import People, compare, verdict

FALLING, SUPPORTED = 3, 10  # the control that gets worse; number of supported controls
SEQUENCES, FRAMES = 40, 12


def people(noise, generator, truth):
    """Output with an error of `noise` [52], on rendered people and on portraits. The teacher knows the odd controls of
    portraits only."""
    made = People.__new__(People)
    made.supported = np.arange(len(CONTROLS)) < SUPPORTED
    known = torch.arange(len(CONTROLS)).remainder(2).float()
    made.parts = []
    for controls, visible in ((truth, torch.ones_like(truth)), (truth[:, -1:], known.expand_as(truth[:, -1:]))):
        off = generator.normal(size=controls.shape) * noise
        made.parts.append((controls.numpy() + off, {"controls": controls, "visible": visible}))
    return made


class CompareDecoders(unittest.TestCase):
    def setUp(self):
        self.generator = np.random.default_rng(1)
        self.truth = torch.from_numpy(self.generator.random((SEQUENCES, FRAMES, len(CONTROLS)))).float()
        self.noise = np.full(len(CONTROLS), 0.4)

    def changed(self, noise):
        before = people(self.noise, self.generator, self.truth)
        return *compare(before, people(noise, self.generator, self.truth)), before.supported

    def test_smaller_errors_are_accepted(self):
        self.assertRegex(verdict(*self.changed(self.noise / 3)), r"^accepted: 10 of 10 rise, mean \+0\.[1-9]")

    def test_one_control_that_falls_prevents_acceptance(self):
        noise = self.noise / 3
        noise[FALLING] = 2
        line = verdict(*self.changed(noise))
        self.assertRegex(line, "^not accepted: 9 of 10 rise")
        self.assertIn(CONTROLS[FALLING] + " -0.", line)

    def test_unsupported_controls_do_not_count(self):
        noise = self.noise / 3
        noise[SUPPORTED:] = 2
        self.assertRegex(verdict(*self.changed(noise)), "^accepted")

    def test_the_standard_error_is_that_of_chance(self):
        """Of decoders that differ by chance alone: three standard errors contain almost all differences, half of one
        does not."""
        differences, errors, _, supported = self.changed(self.noise)
        off = np.abs(differences / errors)
        self.assertLess(np.quantile(off, 0.95), 3)
        self.assertGreater(np.quantile(off, 0.95), 0.5)
        self.assertTrue((errors[supported] > 0).all())


if __name__ == "__main__":
    unittest.main()
