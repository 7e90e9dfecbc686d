#!/usr/bin/env python3
"""Tests of mien_training.data.augment."""
import unittest

import torch

from mien_training.data import augment


def generator(seed=3):
    return torch.Generator().manual_seed(seed)


def pictures(count=64):
    return torch.rand(count, 3, 24, 24, generator=generator(1))


class Photometric(unittest.TestCase):
    def test_pictures_stay_pictures(self):
        for operation in (augment.colour, augment.coloured_light, augment.badly_exposed, augment.strange_light,
                          augment.low_light, augment.photometric):
            with self.subTest(operation.__name__):
                result = operation(pictures(), generator())
                self.assertEqual(result.shape, pictures().shape)
                self.assertTrue(((result >= 0) & (result <= 1)).all())

    def test_what_is_given_stays_as_it_was(self):
        given = pictures()
        augment.photometric(given, generator())
        self.assertTrue(torch.equal(given, pictures()))

    def test_the_same_seed_gives_the_same_pictures(self):
        self.assertTrue(torch.equal(*(augment.photometric(pictures(), generator()) for _ in range(2))))

    def test_light_of_one_colour_leaves_one_colour(self):
        spread = lambda x: (x / x.mean((2, 3), keepdim=True).clamp(min=1e-6)).std(1).mean()
        lit = augment.coloured_light(pictures(), generator())
        self.assertLess(spread(lit), 0.5 * spread(pictures()))
        means = lit.mean((2, 3))
        self.assertGreater((means.amax(1) / means.amin(1).clamp(min=1e-3)).median(), 1.5)

    def test_some_are_badly_exposed(self):
        means = augment.badly_exposed(pictures(), generator()).mean((1, 2, 3))
        self.assertTrue((means < 0.2).any() and (means > 0.8).any())


class Sequences(unittest.TestCase):
    def test_light_stays_from_frame_to_frame(self):
        chain, still = augment.OfSequence(64, 5), pictures()
        first, second = chain(still, 0), chain(still, 1)
        self.assertFalse(torch.equal(first, second))  # the noise does not
        self.assertLess((first.mean((2, 3)) - second.mean((2, 3))).abs().max(), 0.05)


if __name__ == "__main__":
    unittest.main()
