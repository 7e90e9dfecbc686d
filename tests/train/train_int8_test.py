#!/usr/bin/env python3
"""Tests of mien_training.phase1.train_int8."""
import unittest
from pathlib import Path

import torch
from torch import nn

from mien_training.data.sequences import faster
from mien_training.evaluate.int8_layers import Layer
from mien_training.networks.shipped_checkpoints import network_of
from mien_training.phase1.train_int8 import QuantizedPointwise, checkpoint, quantized

BASENET = Path(__file__).resolve().parents[2] / "models/basenet.mien"


def layer(bound=1.0):
    torch.manual_seed(1)
    one = Layer("body.1.expand.0", nn.Conv2d(8, 4, 1))
    one.bound = bound
    return one


class Rounding(unittest.TestCase):
    def test_the_output_is_that_of_the_simulation(self):
        one, x = layer(), torch.rand(2, 8, 3, 3) * 3 - 1.5
        with one, torch.no_grad():
            wanted = one.convolution(x)
        self.assertLess((QuantizedPointwise(one)(x) - wanted).abs().max().item(), 1e-5)

    def test_the_gradient_passes_the_rounding_but_not_the_bound(self):
        one = layer()
        x = torch.tensor([0.3, 2.0]).repeat(4).view(1, 8, 1, 1).requires_grad_()
        QuantizedPointwise(one)(x).sum().backward()
        self.assertTrue((x.grad.view(-1)[::2] != 0).all())
        self.assertTrue((x.grad.view(-1)[1::2] == 0).all())
        self.assertEqual(one.convolution.weight.grad.view(4, 8).abs().sum(1).gt(0).tolist(), [True] * 4)


class Checkpoints(unittest.TestCase):
    def test_trained_weights_are_kept(self):
        torch.manual_seed(1)
        images, network = torch.rand(2, 3, 65, 65) * 2 - 1, network_of(BASENET, "basenet")
        encoder = faster(network.encoder)
        convolution = next(m for m in encoder.modules() if isinstance(m, nn.Conv2d) and m.kernel_size == (1, 1))
        student = quantized(encoder, {})
        with torch.no_grad():
            convolution.weight *= 0.5
            got = network_of(BASENET, "basenet")
            got.load_state_dict(checkpoint(student, BASENET, "basenet")["average"])
            self.assertLess((got.eval().encoder(images) - encoder(images)).abs().max().item(), 1e-4)
            self.assertGreater((network.encoder(images) - encoder(images)).abs().max().item(), 1e-2)


if __name__ == "__main__":
    unittest.main()
