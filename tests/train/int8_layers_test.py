#!/usr/bin/env python3
"""Tests of mien_training.evaluate.int8_layers."""
import unittest

import torch
from torch import nn

from mien_convert.weight_file import MienFile
from mien_training.evaluate.int8_layers import Layer, with_bounds


def file_with(bounds):
    """Bytes of a file whose encoder has two pointwise layers with these input bounds."""
    file = MienFile()
    net = file.network("encoder", input=(4, 4, 8))
    weight = [[0.5 - abs(o - i) / 8 for i in range(8)] for o in range(8)]
    expanded = net.pointwise(net.input, weight, activation="relu6", input_bound=bounds[0])
    filtered = net.depthwise(expanded, [[[[0.125] * 3] * 3]] * 8, activation="relu6")
    net.output(net.pointwise(filtered, weight, input_bound=bounds[1]))
    return file.to_bytes()


def layer(name, channels=8):
    return Layer(name, nn.Conv2d(channels, 4, 1))


class Files(unittest.TestCase):
    def test_bounds_are_written_as_by_the_writer(self):
        self.assertEqual(with_bounds(file_with([0.0, 0.0]), [2.5, 6.0]), file_with([2.5, 6.0]))
        self.assertEqual(with_bounds(file_with([0.0, 0.0]), [0.0, 1.5]), file_with([0.0, 1.5]))

    def test_every_layer_needs_a_bound(self):
        with self.assertRaises(ValueError):
            with_bounds(file_with([0.0, 0.0]), [2.5])


class Layers(unittest.TestCase):
    def test_inputs_are_rounded_and_saturate(self):
        values = torch.tensor([-9.0, -0.3, 0.3, 9.0])
        signed, unsigned = layer("body.1.expand.0"), layer("body.1.project.0")
        self.assertEqual((signed.quantized(values, 12.7) * 10).round().tolist(), [-90, -3, 3, 90])
        self.assertEqual((signed.quantized(values, 1.27) * 100).round().tolist(), [-127, -30, 30, 127])
        self.assertEqual((unsigned.quantized(values, 2.55) * 100).round().tolist(), [0, 0, 30, 255])

    def test_an_outlier_does_not_decide_the_bound(self):
        one = layer("body.1.expand.0")
        one.values = [torch.cat([torch.linspace(-1, 1, 1000000), torch.tensor([2.0])])]
        one.choose_bound()
        self.assertGreater(one.bound, 0.9)
        self.assertLess(one.bound, 1.3)

    def test_weights_and_inputs_have_8_bits_only_inside(self):
        torch.manual_seed(1)
        one, x = layer("body.1.expand.0"), torch.rand(1, 8, 3, 3) * 2 - 1
        one.bound, before = 1.0, one.convolution(x)
        with one:
            inside = one.convolution(x)
            self.assertLessEqual(len(set(one.convolution.weight[0].flatten().tolist())), 8)
        self.assertTrue(torch.equal(one.convolution(x), before))
        error = (inside - before).abs().max().item()
        self.assertGreater(error, 0)
        self.assertLess(error, 8 * (0.5 / 127 * one.exact.abs().max().item() * 2 + 1e-4))


if __name__ == "__main__":
    unittest.main()
