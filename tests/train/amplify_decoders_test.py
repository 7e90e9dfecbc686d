"""Gains of decoders that say too little, and of those that do not; what they cost; that the last layer has them."""
import unittest

import torch

from amplify_decoders import COST, GAINS, amplify, choose, judged
from expressions import CONTROLS, INDEX, MIRROR
from networks import FEATURES, ControlsDecoder

JAW, LEFT, RIGHT, NOISY = (INDEX[name] for name in ("jawOpen", "mouthSmileLeft", "mouthSmileRight", "mouthPucker"))


def parts(told_of):
    """Rendered and real people whose controls are mostly at rest, and what `told_of` makes of the truth [n,frames,52]."""
    generator = torch.Generator().manual_seed(1)
    made = []
    for people, frames in ((60, 30), (200, 1)):
        shape = (people, frames, len(CONTROLS))
        truth = torch.rand(shape, generator=generator) * (torch.rand(shape, generator=generator) < 0.4)
        made.append((told_of(truth, generator), {"controls": truth, "visible": torch.ones_like(truth)}))
    return made


class AmplifyDecoders(unittest.TestCase):
    def test_what_is_right_stays_as_it_is(self):
        gains, offsets = choose(parts(lambda truth, _: truth))
        self.assertTrue((gains == 1).all() and (offsets == 0).all())

    def test_what_is_said_too_softly_becomes_louder_on_both_sides(self):
        def told(truth, _):
            softly = truth.clone()
            softly[..., JAW] *= 0.5
            softly[..., [LEFT, RIGHT]] *= torch.tensor([0.5, 0.8])
            return softly
        gains, _ = choose(parts(told))
        self.assertAlmostEqual(gains[JAW], GAINS[-1])
        self.assertGreater(gains[LEFT], 1.15)
        self.assertEqual(gains[LEFT], gains[RIGHT])
        self.assertTrue((gains == gains[MIRROR]).all())
        self.assertEqual(gains[INDEX["tongueOut"]], 1)

    def test_a_little_where_nothing_is_goes_away(self):
        def told(truth, generator):
            doubtful = truth.clone()
            doubtful[..., NOISY] = 0.6 * truth[..., NOISY] + 0.02 * torch.rand(truth.shape[:-1], generator=generator)
            return doubtful
        gains, offsets = choose(parts(told))
        self.assertAlmostEqual(gains[NOISY], GAINS[-1])
        self.assertGreater(offsets[NOISY], 0.004)

    def test_it_costs_next_to_nothing(self):
        known = parts(lambda truth, generator: 0.7 * truth + 0.2 * torch.randn(truth.shape, generator=generator))
        gains, offsets = (torch.as_tensor(values, dtype=torch.float32) for values in choose(known))
        (error, correlation), (error_before, correlation_before) = judged(known, gains, offsets), judged(known, 1.0, 0.0)
        self.assertTrue((gains > 1).all())
        self.assertTrue((error + error[MIRROR] <= error_before + error_before[MIRROR] + 1e-6).all())
        self.assertTrue((correlation >= correlation_before - COST - 1e-6).all())

    def test_the_last_layer_has_them(self):
        torch.manual_seed(2)
        decoder, features = ControlsDecoder().eval(), torch.randn(2, 5, FEATURES)
        gains, offsets = 1 + torch.rand(len(CONTROLS)), 0.1 * torch.rand(len(CONTROLS))
        with torch.no_grad():
            before = decoder(features)[0]
            amplify(decoder, gains.numpy(), offsets.numpy())
            torch.testing.assert_close(decoder(features)[0], (before - offsets) * gains)


if __name__ == "__main__":
    unittest.main()
