#!/usr/bin/env python3
"""Tests that only layers are kept precise for whose weights fp16 is too coarse, and that the converter's own evaluation
of a network agrees with the engine.

usage: precision_test.py MIEN_PROGRAM      exit 77: Python's onnx package is missing here
"""
import re
import shutil
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

HERE = Path(__file__).resolve().parent
try:
    import arithmetic_cases
    import numpy as np
    import onnx
    import operator_cases
    import random_graphs
    from conversion import convert, difference, run_network
    from operator_cases import Case, node

    from mien_convert import precision
    from mien_convert.evaluation import rounded, value_of
    from mien_convert.graph import converted
    from mien_convert.model import Graph
    from mien_convert.weight_file import MienFile
except ModuleNotFoundError as missing:
    print("skipped: missing Python module", missing.name + "; scripts/setup.sh convert installs it")
    sys.exit(77)
RANDOM_GRAPHS = 60


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="mien_precision_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def saved(self, case):
        path = self.folder / f"{case.name}.onnx"
        onnx.save(case.model(), str(path))
        return path

    def converted(self, case, *arguments):
        """The weight file, its size and the output."""
        model = self.folder / "y.mien"
        status, report = convert([self.saved(case), "-o", model, *case.arguments, *arguments])
        self.assertEqual(status, 0)
        return model, model.stat().st_size, report

    def error(self, case, x, want, *arguments):
        got, = run_network(self.folder, self.converted(case, *arguments)[0], x)
        return difference(got, want)


# 1 + 2^-12 is 1 in fp16: of the difference between two copies of the input nothing is left.
FINE = 1 + 2.0 ** -12


def copies(channels, kernel=1):
    """Pointwise weights that copy each channel twice."""
    return np.concatenate([np.eye(channels)] * 2).reshape(2 * channels, channels, 1, 1).astype(np.float32)


def differences(channels):
    """FINE times the first half minus the second: a small difference of large values."""
    weight = np.concatenate([FINE * np.eye(channels), -np.eye(channels)], 1).astype(np.float32)
    return {"a": copies(channels), "b": weight.reshape(channels, 2 * channels, 1, 1),
            "c": np.zeros(channels, np.float32)}


def pair(*more, **options):
    """Two convolutions; only the second needs more than fp16."""
    return Case("pair", [node("Conv", "x a", "t"), node("Conv", "t b c", "y" if not more else "u"),
                         *more], {"x": [1, 3, 6, 5]},
                constants=differences(3), **options)


class Layers(Folder):
    x = np.random.default_rng(2).standard_normal((3, 6, 5)).astype(np.float32)

    def test_a_layer_that_needs_it_is_kept_precise(self):
        want = (FINE - 1) * self.x
        self.assertLess(self.error(pair(), self.x, want), 1e-3)
        self.assertGreater(self.error(pair(), self.x, want, "--fp16-only"), 0.1)

    def test_its_activation_comes_behind_the_sum(self):
        case = pair(node("Sigmoid", "u"))
        case.constants["b"] *= 4096
        self.assertLess(self.error(case, self.x, 1 / (1 + np.exp(-self.x))), 1e-3)

    def test_what_it_costs_is_printed(self):
        case = pair()
        _, large, report = self.converted(case)
        _, small, plain = self.converted(case, "--fp16-only")
        self.assertRegex(report,
                         r"kept precise by a second layer each \(\+42 bytes, \+0.0 million multiplications\): Conv "
                         r"'the_conv'\n")
        self.assertGreater(large, small + 42)
        self.assertNotIn("kept precise", plain)
        before, = re.findall(r"; (\S+) with --fp16-only", report)
        after, = re.findall(r"estimated error: (\S+) of", report)
        self.assertGreater(float(before), 0.1)
        self.assertLess(float(after), precision.AIM)
        self.assertIn(f"estimated error: {before} of the largest value", plain)

    def test_a_network_that_does_not_need_it_stays_as_it_is(self):
        weight = np.random.default_rng(4).standard_normal((5, 3, 1, 1)).astype(np.float32)
        case = Case("plain", [node("Conv", "x w")], {"x": [1, 3, 6, 5]}, constants={"w": weight})
        _, size, report = self.converted(case)
        self.assertEqual(size, self.converted(case, "--fp16-only")[1])
        self.assertIn("1 layers", report)
        self.assertIn("estimated error", report)
        case.constants["w"] = rounded(weight)
        self.assertNotIn("estimated error", self.converted(case)[2])

    def test_no_more_layers_than_it_takes(self):
        case = pair(node("Conv", "u d"))
        case.constants["d"] = (copies(3)[:3] * (1 + 2.0 ** -13)).astype(np.float32)
        self.assertRegex(self.converted(case)[2], r"kept precise .*: Conv 'node_1'\n")

    def test_a_bias(self):
        case = Case("bias", [node("Conv", "x w b", "t"), node("Softmax", "t", axis=1)], {"x": [1, 3, 6, 5]},
                    constants={"w": np.full((3, 3, 1, 1), 2.0 ** -14, np.float32),
                               "b": np.array([2048.7, 2048, 2049.2], np.float32)})
        logits = 2.0 ** -14 * self.x.sum(0, keepdims=True) + np.array([0.7, 0, 1.2]).reshape(3, 1, 1)
        want = np.exp(logits) / np.exp(logits).sum(0)
        self.assertLess(self.error(case, self.x, want), 1e-3)
        self.assertGreater(self.error(case, self.x, want, "--fp16-only"), 0.05)

    def test_a_depthwise_layer(self):
        case = Case("depthwise", [node("Conv", "x w", "t", group=3, pads=[1, 1, 1, 1]),
                                  node("Sub", "t x")], {"x": [1, 3, 6, 5]},
                    constants={"w": np.pad(np.full((3, 1, 1, 1), FINE, np.float32), ((0, 0), (0, 0), (1, 1), (1, 1)))})
        want = (FINE - 1) * self.x
        self.assertLess(self.error(case, self.x, want), 1e-3)
        self.assertGreater(self.error(case, self.x, want, "--fp16-only"), 0.1)

    def test_layers_of_a_stream(self):
        weight = np.zeros((4, 4, 2), np.float32)
        weight[:, :, 1] = FINE * np.eye(4)
        case = Case("stream", [node("Conv", "x w", "t", pads=[1, 0]), node("Sub", "t x")], {"x": [1, 4, 9]},
                    constants={"w": weight})
        x = np.random.default_rng(3).standard_normal((9, 4)).astype(np.float32)
        self.assertLess(self.error(case, x, (FINE - 1) * x), 1e-3)
        self.assertGreater(self.error(case, x, (FINE - 1) * x, "--fp16-only"), 0.1)

    def test_a_network_too_large_to_evaluate_is_converted_with_a_note(self):
        for limit in ("MAX_NUMBERS", "MAX_WORK"):
            with mock.patch.object(precision, limit, 10):
                self.assertIn("note: too large to estimate", self.converted(pair())[2])

    def test_in_any_order_as_many_are_kept_as_it_takes(self):
        """The search for an order is left out where it takes long."""
        with mock.patch.object(precision, "MAX_WORK",
                               2 * precision.INPUTS * 1000), mock.patch.object(precision, "work", lambda layer: 1000):
            self.assertLess(self.error(pair(), self.x, (FINE - 1) * self.x), 1e-3)


class Evaluation(Folder):
    """Compared with `mien run` with the same weights, rounded to fp16."""

    def test_of_operators(self):
        self.check([*operator_cases.accepted(), *arithmetic_cases.accepted()], 150)

    def test_of_graphs_drawn_by_chance(self):
        self.check(random_graphs.graphs(RANDOM_GRAPHS, seed=1000), RANDOM_GRAPHS)

    def check(self, cases, least):
        compared, random = 0, np.random.default_rng(5)
        for case in cases:
            if case.arguments or case.feedback or case.steps > 1 or case.layout != "chw":
                continue
            with self.subTest(case.name):
                self.compare(case, random)
                compared += 1
        self.assertGreaterEqual(compared, least)

    def compare(self, case, random):
        conversion = converted(Graph(self.saved(case)), {})
        network, file = conversion.network(), MienFile()
        shape, steps = conversion.source.shape, conversion.t.steps
        network.write(file.network("net", shape))
        file.write(self.folder / "y.mien")
        x = random.standard_normal((steps or 1, *shape)).astype(np.float32)
        given = x.transpose(0, 3, 1, 2) if steps else x[0].transpose(2, 0, 1)
        given = given.reshape(steps, -1) if steps and shape[:2] == (1, 1) else given
        values = {id(conversion.source): x}
        for layer in network.layers:
            values[id(layer)] = value_of(layer, [values[id(x)] for x in layer.inputs], rounded, rounded)
        for output, got in zip(network.outputs, run_network(self.folder, self.folder / "y.mien", given)):
            want = values[id(output)]
            self.assertLess(difference(got, want if steps else want.transpose(0, 3, 1, 2)), 2e-5)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
