#!/usr/bin/env python3
"""Tests of mien_training.networks.round_weights, and that the weights that are shipped were rounded by it."""
import struct
import unittest
from pathlib import Path

from mien_convert.weight_file import MienFile, sealed
from mien_training.networks.round_weights import FEW_WEIGHTS, rounded, rounded_number

ROOT = Path(__file__).parents[2]


def number(value):
    return struct.unpack("<H", struct.pack("<e", value))[0]


def value(number):
    return struct.unpack("<e", struct.pack("<H", number))[0]


class Numbers(unittest.TestCase):
    def test_ties_go_to_even(self):
        for before, after in ((1 + 1 / 128, 1 + 1 / 128), (1 + 1 / 256, 1), (1 + 3 / 256, 1 + 2 / 128), (1 + 5 / 256,
                                                                                                         1 + 2 / 128),
                              (1 + 5 / 1024, 1 + 1 / 128), (1 + 3 / 1024, 1), (2 - 1 / 1024, 2), (2 - 1 / 256, 2)):
            self.assertEqual(value(rounded_number(number(before))), after)
            self.assertEqual(value(rounded_number(number(-before))), -after)

    def test_every_number_goes_to_a_nearest_one(self):
        finite = range(0x7C00)
        for bits in (1, 8, 9, 10):
            kept = [value(n) for n in finite if n % (1 << 11 - bits) == 0]
            steps = sorted(kept)
            for n in finite:
                result = value(rounded_number(n, bits))
                self.assertEqual(rounded_number(n | 0x8000, bits), rounded_number(n, bits) | 0x8000)
                self.assertIn(result, (steps[n >> 11 - bits], steps[min((n >> 11 - bits) + 1, len(steps) - 1)]))
                neighbours = steps[max(0, (n >> 11 - bits) - 1):(n >> 11 - bits) + 3]
                self.assertEqual(abs(result - value(n)), min(abs(s - value(n)) for s in neighbours))

    def test_all_bits_are_none_less(self):
        self.assertTrue(all(rounded_number(n, 11) == n for n in range(0x7C00)))

    def test_the_largest_stay_finite(self):
        for sign in (0, 0x8000):
            self.assertEqual(rounded_number(0x7BFF | sign), 0x7BF8 | sign)

    def test_zeros_keep_their_sign(self):
        self.assertEqual((rounded_number(0), rounded_number(0x8000)), (0, 0x8000))


def file_of(outputs):
    file = MienFile()
    net = file.network("net", (1, 1, 64))
    net.output(
        net.pointwise(net.input, [[(64 * o + i) / 7919 for i in range(64)] for o in range(outputs)], [0.1] * outputs))
    file.constant("third", [1 / 3], "fp16")
    file.metadata["name"] = "x"
    return file.to_bytes()


class Files(unittest.TestCase):
    def test_only_many_weights_are_rounded(self):
        self.assertEqual(rounded(file_of(FEW_WEIGHTS // 64 - 8)), file_of(FEW_WEIGHTS // 64 - 8))
        before = file_of(FEW_WEIGHTS // 64)
        after = rounded(before)
        data, = struct.unpack_from("<Q", before, 48)
        weights = slice(data, data + 2 * FEW_WEIGHTS)
        numbers = struct.unpack(f"<{FEW_WEIGHTS}H", before[weights])
        self.assertEqual(after[weights], struct.pack(f"<{FEW_WEIGHTS}H", *map(rounded_number, numbers)))
        self.assertNotEqual(after[weights], before[weights])
        self.assertEqual(after, sealed(before[:data] + after[weights] + before[weights.stop:]))
        self.assertEqual(rounded(after), after)

    def test_shipped_weights_are_rounded(self):
        files = sorted((ROOT / "models").glob("*.mien"))
        self.assertGreaterEqual(len(files), 4)
        for path in files:
            self.assertTrue(rounded(path.read_bytes()) == path.read_bytes(),
                            f"{path.name}: mien_training.networks.round_weights was not run")


if __name__ == "__main__":
    unittest.main()
