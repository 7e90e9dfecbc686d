"""Parts of the training of decoders."""
import time
import unittest

import numpy as np
import torch

from mien_training.data import expressions
from mien_training.data.expressions import CONTROLS
from mien_training.networks.architectures import TemporalDecoder
from mien_training.paths import data
from mien_training.phase2.amplitude_losses import discordance, discordance_within
from mien_training.phase2.decoder_output import SIDED, output_controls
from mien_training.phase2.landmark_stream import KNOWN, PointRig, batch
from mien_training.phase2.whitening import Whitening
from mien_training.renderer import look
from mien_training.renderer.rig import Rig


class DecoderOutput(unittest.TestCase):
    def test_clamps_and_symmetrizes(self):
        answers = torch.zeros(2, 3, 52)
        a, b, jaw = CONTROLS.index("browDownLeft"), CONTROLS.index("browDownRight"), CONTROLS.index("jawLeft")
        answers[..., a], answers[0, 0, b], answers[..., jaw] = 0.02, 1.5, 0.02
        controls = output_controls(answers)
        assert len(SIDED) == 16
        assert torch.allclose(controls[0, 0, [a, b, jaw]], torch.tensor([0.02, 1, 0.02]))
        assert torch.allclose(controls[1, 2, [a, b, jaw]], torch.tensor([0.014, 0.006, 0.02]))
        assert answers[0, 0, b] == 1.5, "given outputs stay unchanged"


class AmplitudeLosses(unittest.TestCase):
    def test_concordance_is_best_at_the_true_amplitude(self):
        torch.manual_seed(0)
        truth, weight = torch.rand(20, 50, 3), torch.ones(20, 50, 3)
        assert discordance(truth, truth, weight).max() < 1e-6 and discordance_within(truth, truth, weight).max() < 1e-6
        # Of guesses that explain half of the variance, concordance is best at the truth's amplitude, a squared error at
        # half of it.
        noisy = truth - 0.5 + torch.randn_like(truth) * truth.std()
        gains = torch.linspace(0.3, 1.5, 25)
        best = lambda loss: gains[torch.stack([loss(g * noisy + 0.5) for g in gains]).argmin()]
        ratio = lambda g: float(g * noisy.std() / truth.std())
        assert abs(ratio(best(lambda p: discordance(p, truth, weight).mean())) - 1) < 0.1
        assert abs(ratio(best(lambda p: discordance_within(p, truth, weight).mean())) - 1) < 0.1
        assert ratio(best(lambda p: ((p - truth) ** 2).mean())) < 0.8
        shifted = truth + torch.rand(20, 1, 3)
        assert discordance_within(shifted, truth, weight).max() < 1e-6 < 0.1 < discordance(shifted, truth, weight).min()
        # Invisible controls have no weight.
        weight[:, 25:] = 0
        spoilt = truth.clone()
        spoilt[:, 25:] = 0
        assert discordance(spoilt, truth, weight).max() < 1e-6 and discordance_within(spoilt, truth,
                                                                                      weight).max() < 1e-6


class LandmarkStream(unittest.TestCase):
    def test_points_match_whole_heads(self):
        """Landmarks alone are those of whole heads, and the stream does not repeat."""
        if not (data() / "rig").exists():
            self.skipTest(f"no rig in {data()}")
        rig = Rig()
        points, rng = PointRig(rig), np.random.default_rng(0)
        identity, controls = look.sample_identity(rng), expressions.sample_sequence(rng, 5, phone=1.0)
        whole = rig.landmarks(rig.identity(identity[None]) + rig.expression(controls))
        assert np.abs(points.moved(identity, controls)[1] - whole).max() < 1e-3
        began = time.time()
        features, answers = batch(points, rng, 100, 90)
        print(f"{100 / (time.time() - began) * 60:.0f} sequences of 90 frames a minute")
        assert features.shape == (100, 90, KNOWN) and answers.shape == (100, 90, 52) and bool(features.isfinite().all())
        assert not torch.equal(batch(points, rng, 100, 90)[1], answers)
        again = batch(points, np.random.default_rng(3), 2, 30)
        assert all(torch.equal(a, b) for a, b in zip(again, batch(points, np.random.default_rng(3), 2, 30)))


class WhiteningTest(unittest.TestCase):
    def test_folded_decoder_gives_the_same_output(self):
        torch.manual_seed(0)
        samples = torch.randn(2000, 12) @ torch.randn(12, 12) * torch.logspace(-2, 2, 12) + 3
        whitening = Whitening.of(samples)
        white = whitening(samples)
        assert (white.T @ white / len(white) - torch.eye(12)).abs().max() < 0.05
        decoder = TemporalDecoder([8, 8, 8], 5, 12)
        twin = TemporalDecoder([8, 8, 8], 5, 12)
        twin.load_state_dict(whitening.fold(decoder.state_dict()))
        x = samples[:60].view(4, 15, 12)
        apart = (twin(x)[0] - decoder(whitening(x), whitening.start(decoder, 4))[0]).abs().max()
        assert apart < 1e-3, apart
        again = whitening.unfold(twin.state_dict())
        assert all(torch.allclose(again[k], v, atol=1e-3) for k, v in decoder.state_dict().items())


if __name__ == "__main__":
    unittest.main()
