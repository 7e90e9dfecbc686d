#!/usr/bin/env python3
"""Test of scripts/train/step_bench.py: it runs the trainer of this checkout, and tells of every part."""
import re
import subprocess
import sys
import unittest
from pathlib import Path

import torch  # noqa: F401  (without it the test is skipped)

PROGRAM = Path(__file__).parents[2] / "scripts/train/step_bench.py"


class StepBench(unittest.TestCase):
    def test_it_tells_of_every_part(self):
        command = [sys.executable, PROGRAM, "--network", "basenet", "--batch", "8", "--rounds", "1", "--steps", "1"]
        done = subprocess.run(command, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        rates = dict(re.findall(r"^  (\S.*?)\s+(\d+)$", done.stdout, re.MULTILINE))
        self.assertEqual(list(rates), ["data", "augmentation", "forward and backward", "optimizer and average", "whole"])
        self.assertTrue(all(int(rate) > 0 for rate in rates.values()), rates)


if __name__ == "__main__":
    unittest.main()
