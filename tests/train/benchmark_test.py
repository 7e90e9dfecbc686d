"""Test of the training benchmark: it measures each part of a step."""
import unittest

from mien_training.phase1 import benchmark


class Benchmark(unittest.TestCase):
    def test_it_measures_each_part(self):
        seconds = benchmark.benchmark("basenet", batch=8, steps=1)
        self.assertEqual(set(seconds), set(benchmark.PARTS))
        self.assertTrue(all(value > 0 for value in seconds.values()), seconds)


if __name__ == "__main__":
    unittest.main()
