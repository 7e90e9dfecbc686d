#!/usr/bin/env python3
"""Tests of the Python writer beyond golden files: other kinds of inputs, rejected inputs, files on disk."""
import os
import tempfile
import unittest
from array import array
from pathlib import Path

from mien_convert.weight_file import MienFile
from mien_convert.xxhash64 import xxhash64

WEIGHT = [[0.5, -1.25, 3.0], [1e-7, 65504.0, -0.1]]


def file_with(weight=WEIGHT, bias=None, name="net", **options):
    file = MienFile()
    net = file.network(name, (1, 1, 3))
    net.output(net.pointwise(net.input, weight, bias, **options))
    return file


class Inputs(unittest.TestCase):
    def test_all_kinds_of_arrays_give_the_same_bytes(self):
        expected = file_with(bias=[1, 2]).to_bytes()
        flat = array("f", [x for row in WEIGHT for x in row])
        self.assertEqual(file_with((flat, (2, 3)), bias=(1.0, 2.0)).to_bytes(), expected)
        self.assertEqual(file_with((flat, [2, 3, 1, 1]), bias=[1, 2]).to_bytes(), expected)
        try:
            import numpy
        except ImportError:
            self.skipTest("no numpy")
        for kind in (numpy.float32, numpy.float64):
            self.assertEqual(file_with(numpy.array(WEIGHT, kind), numpy.array([1, 2])).to_bytes(), expected)
        transposed = numpy.asfortranarray(numpy.array(WEIGHT, numpy.float32))
        self.assertEqual(file_with(transposed, [1, 2]).to_bytes(), expected)

    def test_metadata_is_sorted(self):
        one, other = file_with(), file_with()
        one.metadata.update(a="1", b="2")
        other.metadata.update(b="2", a="1")
        self.assertEqual(one.to_bytes(), other.to_bytes())


class Refusals(unittest.TestCase):
    def refused(self, file_or_call):
        with self.assertRaises(ValueError):
            (file_or_call if callable(file_or_call) else file_or_call.to_bytes)()

    def test_numbers(self):
        for bad in (65520.0, float("nan"), float("inf"), 1e60):
            self.refused(lambda: file_with([[bad, 0, 0]]))
            self.refused(lambda: file_with(bias=[bad, 0]))
        for bad in (1e39, float("nan")):
            self.refused(lambda: MienFile().constant("c", [bad]))

    def test_shapes(self):
        self.refused(lambda: file_with([[1, 2]]))
        self.refused(lambda: file_with([[1, 2, 3], [1, 2]]))
        self.refused(lambda: file_with([]))
        self.refused(lambda: file_with(bias=[1]))
        self.refused(lambda: MienFile().network("n", (0, 1, 1)))
        self.refused(lambda: MienFile().constant("c", 1.0))
        self.refused(lambda: MienFile().constant("c", []))

    def test_options(self):
        self.refused(lambda: file_with(activation="swish"))
        self.refused(lambda: file_with(activation="leaky_relu"))
        self.refused(lambda: file_with(alpha=0.1))
        self.refused(lambda: file_with(activation="prelu"))
        self.refused(lambda: file_with(slopes=[1, 2]))
        self.refused(lambda: file_with(stride=2))
        for bad in (-1.0, 1e-30, 1e30, float("nan"), float("inf")):
            self.refused(lambda: file_with(input_bound=bad))
        net = MienFile().network("n", (4, 4, 8))
        self.refused(lambda: net.max_pool(0, 16))
        self.refused(lambda: net.max_pool(0, 5))
        self.refused(lambda: net.max_pool(0, 2, padding=2))
        self.refused(lambda: net.softmax(1))
        self.refused(lambda: net.softmax(0, input_bound=1.0))
        self.refused(lambda: net.add(0, 0, activation="relu"))
        self.refused(lambda: net.slice(0, 1, 8))
        self.refused(lambda: net.slice(0, 0, 8, (2, 0, 2, 0)))
        self.refused(lambda: net.slice(0, -1, 4))
        self.refused(lambda: net.slice(0, 0, 4, activation="relu"))
        self.refused(lambda: net.concat(0, net.global_average_pool(0)))

    def test_version_is_the_smallest_that_has_the_ops(self):
        self.assertEqual(file_with().to_bytes()[10], 0)
        file = MienFile()
        net = file.network("n", (4, 4, 8))
        net.output(net.global_average_pool(0))
        self.assertEqual(file.to_bytes()[10], 1)

    def test_names_and_texts(self):
        for bad in ("", "A", "a b", "x" * 64, "é", "a\n"):
            self.refused(lambda: file_with(name=bad))
        for bad in ("\r", "\x00", "\x7f", "\x80", "x" * 4097):
            file = file_with()
            file.metadata["key"] = bad
            self.refused(file)
        file = file_with()
        file.network("net", (1, 1, 1))
        self.refused(file)

    def test_networks(self):
        self.refused(MienFile())
        file = MienFile()
        net = file.network("n", (1, 1, 1))
        net.softmax(net.softmax(0))
        self.refused(file)
        self.refused(lambda: net.output(0))
        net.output(1)
        self.refused(file)  # layer 2 is unused
        any_size = MienFile().network("n", (4, 4, 1), any_size=True)
        self.refused(lambda: any_size.fully_connected(0, [[1.0] * 16]))


class Disk(unittest.TestCase):
    def test_a_rejected_file_leaves_only_the_old_one(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "a.mien"
            file_with().write(path)
            before = path.read_bytes()
            with self.assertRaises(ValueError):
                MienFile().write(path)
            self.assertEqual(os.listdir(folder), ["a.mien"])
            self.assertEqual(path.read_bytes(), before)


class Checksum(unittest.TestCase):
    def test_published_values(self):
        self.assertEqual(xxhash64(b""), 0xEF46DB3751D8E999)
        self.assertEqual(xxhash64(b"abc"), 0x44BC2CF5AD770999)
        # cspell:ignore spammish
        self.assertEqual(xxhash64(b"Nobody inspects the spammish repetition"), 0xFBCEA83C8A378BF1)


if __name__ == "__main__":
    unittest.main()
