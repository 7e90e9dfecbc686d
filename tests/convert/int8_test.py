#!/usr/bin/env python3
"""Tests --int8: the layers that get 8 bits, and that the engine's outputs differ as much as the converter estimates.

usage: int8_test.py MIEN_PROGRAM      exit 77: Python's onnx package is missing here
"""
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import numpy as np
    import onnx
    from conversion import PROGRAM, convert, run_network
    from operator_cases import Case, node

    from mien_convert.int8 import relative
    from mien_convert.weight_file import OPS, RECORD_BYTES
except ModuleNotFoundError as missing:
    print("skipped: missing Python module", missing.name + "; scripts/setup.sh convert installs it")
    sys.exit(77)
TIERS = ("avxvnni", "avx512vnni")  # that compute with 8 bits
random = np.random.default_rng(3)


def weights(*shape):
    return (random.standard_normal(shape) * 1.5 / np.sqrt(np.prod(shape[1:]))).astype(np.float32)


def inverted_residual(x, y, channels, hidden, out, constants):
    """Nodes of a block of MobileNetV2, with weights of their own."""
    constants.update({f"{y}1": weights(hidden, channels, 1, 1), f"{y}2": weights(hidden, 1, 3, 3),
                      f"{y}3": weights(out, hidden, 1, 1)})
    return [node("Conv", f"{x} {y}1", f"{y}a"), node("Clip", f"{y}a low high", f"{y}b"),
            node("Conv", f"{y}b {y}2", f"{y}c", group=hidden, pads=[1, 1, 1, 1]),
            node("Clip", f"{y}c low high", f"{y}d"), node("Conv", f"{y}d {y}3", y)]


def mobile_net(outlier=1.0):
    """Three blocks. The first input channel of the second, times `outlier`, has small weights."""
    constants = {"low": np.float32(0), "high": np.float32(6), "w": weights(16, 3, 3, 3)}
    nodes = [node("Conv", "x w", "s", strides=[2, 2]), *inverted_residual("s", "t", 16, 64, 24, constants),
             *inverted_residual("t", "u", 24, 96, 24, constants), *inverted_residual("u", "y", 24, 96, 32, constants)]
    constants["t3"][0] *= outlier
    constants["u1"][:, 0] /= outlier
    return Case("mobile", nodes, {"x": [1, 3, 40, 32]}, constants=constants)


class Int8(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="mien_int8_"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.samples = self.folder / "samples"
        self.samples.mkdir()
        np.save(self.samples / "a.npy", random.standard_normal((6, 3, 40, 32)).astype(np.float32))
        np.save(self.samples / "b.npy", random.standard_normal((3, 40, 32)))

    def convert(self, case, *arguments, name="y"):
        source, model = self.folder / "model.onnx", self.folder / f"{name}.mien"
        onnx.save(case.model(), str(source))
        status, report = convert([source, "-o", model, "--fp16-only", *arguments])
        return status, report, model

    def converted(self, case, *arguments, name="y"):
        status, report, model = self.convert(case, *arguments, name=name)
        self.assertEqual(status, 0)
        return report, model

    def bounds(self, model):
        """The input bounds of the pointwise layers."""
        file = model.read_bytes()
        networks, layers = struct.unpack_from("<II", file, 20)
        records = [RECORD_BYTES * (1 + networks + i) for i in range(layers)]
        return [struct.unpack_from("<f", file, at + 60)[0] for at in records
                if struct.unpack_from("<H", file, at)[0] == OPS["pointwise"]]

    def network(self, tier):
        return ("--network", "model", "--tier", tier)

    def tiers(self, model):
        np.save(self.folder / "x.npy", np.zeros((3, 40, 32), np.float32))
        for tier in TIERS:
            run = subprocess.run([PROGRAM, "run", model, "--input", self.folder / "x.npy", "--output",
                                  self.folder / "z.npy", "--tier", tier], capture_output=True)
            if run.returncode == 0:
                yield tier

    def test_the_engine_differs_as_much_as_estimated(self):
        case, x = mobile_net(), np.load(self.samples / "a.npy")
        exact = run_network(self.folder, self.converted(case, name="exact")[1], x, network=self.network("ref"))[0]
        report, model = self.converted(case, "--int8", self.samples, "--int8-error", "0.1")
        self.assertTrue(all(bound > 0 for bound in self.bounds(model)))
        self.assertIn("8 bits in 6 of 6 layers of inverted residual blocks, ", report)
        estimate = float(re.search(r"estimated error of the outputs: (\S+) of their deviation", report)[1])
        for tier in self.tiers(model):
            error = relative(run_network(self.folder, model, x, network=self.network(tier))[0], exact)
            self.assertLess(0.9 * estimate, error, tier)
            self.assertLess(error, 1.1 * estimate, tier)

    def test_layers_that_cost_too_much_keep_16_bits(self):
        case = mobile_net(outlier=300)  # most of the range of the second block's inputs is for one channel
        report, model = self.converted(case, "--int8", self.samples, "--int8-error", "0.05")
        self.assertIn("8 bits in 5 of 6 layers", report)
        self.assertEqual([bound > 0 for bound in self.bounds(model)], [True, True, False, True, True, True])
        self.assertLessEqual(float(re.search(r"error of the outputs: (\S+) of", report)[1]), 0.05)

    def test_other_networks_have_no_such_layers(self):
        case = Case("plain", [node("Conv", "x w")], {"x": [1, 3, 40, 32]}, constants={"w": weights(8, 3, 1, 1)})
        report, model = self.converted(case, "--int8", self.samples)
        self.assertIn("8 bits in 0 of 0 layers", report)
        self.assertEqual(model.read_bytes(), self.converted(case, name="without")[1].read_bytes())

    def rejected(self, *arguments):
        status, _, model = self.convert(mobile_net(), *arguments)
        self.assertFalse(model.exists())
        return str(status)

    def test_wrong_samples(self):
        self.assertIn("--int8: no folder", self.rejected("--int8", self.folder / "absent"))
        empty = self.folder / "empty"
        empty.mkdir()
        self.assertIn("--int8: no .npy file in", self.rejected("--int8", empty))
        for values, fault in ((np.zeros((3, 32, 40), np.float32), "shape (3, 32, 40) of float32 (expected [...,]3,40"),
                              (np.zeros((3, 40, 32), np.uint8), "of uint8 (expected"),
                              (np.full((3, 40, 32), np.nan, np.float32), "values that are not finite"),
                              (np.array([{}], object), "allow_pickle=False")):
            np.save(empty / "a.npy", values)
            self.assertIn(fault, self.rejected("--int8", empty))
        (empty / "a.npy").write_bytes(b"\x93NUMPY")
        self.assertIn("a.npy: ", self.rejected("--int8", empty))

    def test_networks_with_a_state_are_rejected(self):
        case = Case("steps", [node("Conv", "x w", pads=[1, 0])], {"x": [1, 5, 40]}, constants={"w": weights(5, 5, 2)})
        status, _, _ = self.convert(case, "--int8", self.samples)
        self.assertIn("--int8: the network has a state", str(status))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
