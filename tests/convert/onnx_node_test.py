#!/usr/bin/env python3
"""Runs ONNX's own tests of single nodes: each is converted with ONNX's results, or rejected in one line with the
reason.

usage: onnx_node_test.py MIEN_PROGRAM      exit 77: Python's onnx package, or the tests, are missing here
fetch_node_tests.sh beside this file fetches the tests.
"""
import os
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
try:
    import numpy as np
    import onnx
    from conversion import convert, difference, run_network, time_axis
    from onnx import numpy_helper
except ModuleNotFoundError as missing:
    print("skipped: missing Python module", missing.name + "; scripts/setup.sh convert installs it")
    sys.exit(77)

TESTS = Path(os.environ.get("MIEN_CACHE", Path.home() / ".cache/mien")) / "onnx-node-tests-1.13.1"
if not TESTS.is_dir():
    print(f"skipped: no tests in {TESTS}; tests/convert/fetch_node_tests.sh fetches them")
    sys.exit(77)
# Fewer mean that the converter rejects more than before. Most of the tests have batches, which it does not support.
MIN_CONVERTED, ALL = 30, 1097
TOLERANCE = 2e-3  # of the largest value: weights are rounded to 11 bits


def arrays(folder, kind):
    def read(path):
        return numpy_helper.to_array(onnx.load_tensor(str(path))).astype(np.float32)
    return [read(path)
            for path in sorted(folder.glob(f"test_data_set_0/{kind}_*.pb"), key=lambda p: int(p.stem.split("_")[1]))]


class NodeTests(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="mien_nodes_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def test_each_is_converted_right_or_refused_clearly(self):
        tests = sorted(path for path in TESTS.iterdir() if (path / "model.onnx").is_file())
        converted = 0
        for test in tests:
            with self.subTest(test.name):
                model = self.folder / "node.mien"
                model.unlink(missing_ok=True)
                status, _ = convert([test / "model.onnx", "-o", model])
                if status == 0:
                    self.compare(test, model)
                    converted += 1
                else:
                    self.check_refusal(test, status, model)
        print(f"{converted} of {len(tests)} converted, the others rejected")
        self.assertEqual(len(tests), ALL)
        self.assertGreaterEqual(converted, MIN_CONVERTED)

    def compare(self, test, model):
        self.assertIsNone(time_axis(model))
        x, = arrays(test, "input")
        results, wanted = run_network(self.folder, model, x), arrays(test, "output")
        self.assertEqual(len(results), len(wanted))
        for result, want in zip(results, wanted):
            self.assertLess(difference(result, want), TOLERANCE)

    def check_refusal(self, test, status, model):
        self.assertIsInstance(status, str)
        self.assertNotIn("\n", status)
        self.assertNotIn("malformed", status)  # none of them is
        prefix, reason = status.split(": ", 1)[0], status.split("model.onnx: ", 1)[1]
        self.assertEqual(prefix, "onnx_to_mien.py")
        self.assertGreater(len(reason), 5)
        self.assertFalse(model.exists(), "a rejected file leaves no output")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
