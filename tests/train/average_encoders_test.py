"""Encoders between two: the ends of the line, and norms that know the maps they are given."""
import unittest

import torch

from mien_training.networks.architectures import BaseNet, ConvNorm
from mien_training.phase1.average_encoders import measure_norms
from mien_training.phase2.blend_decoders import between


class AverageEncoders(unittest.TestCase):
    def test_the_line_ends_at_both(self):
        torch.manual_seed(1)
        ours, others = BaseNet().state_dict(), BaseNet().state_dict()
        for share, end in ((0, ours), (1, others)):
            state = between(ours, others, share)
            for name, value in end.items():
                torch.testing.assert_close(state[name], value)

    def test_norms_know_their_maps(self):
        torch.manual_seed(2)
        network = BaseNet()
        pictures = torch.rand(6, 3, network.framing.height, network.framing.width) * 2 - 1
        measure_norms(network.encoder, pictures)
        seen = []
        hooks = [m[1].register_forward_pre_hook(lambda norm, inputs: seen.append((norm, inputs[0])))
                 for m in network.encoder.modules()
                 if isinstance(m, ConvNorm)]
        with torch.no_grad():
            network.encoder.eval()(pictures)
        self.assertEqual(len(hooks), len(seen))
        for norm, maps in seen:
            torch.testing.assert_close(norm.running_mean, maps.mean((0, 2, 3)), atol=1e-4, rtol=1e-3)
            torch.testing.assert_close(norm.running_var, maps.var((0, 2, 3)), atol=1e-4, rtol=1e-3)


if __name__ == "__main__":
    unittest.main()
