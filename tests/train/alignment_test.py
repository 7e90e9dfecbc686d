"""Losses of encoders: the crops that the tracker fits to landmarks, and what portraits teach. False faces."""
import unittest
from types import SimpleNamespace
from unittest import mock

import numpy as np
import torch

from mien_training.data.expressions import CONTROLS, INDEX
from mien_training.data.face_batches import LEARNED_FROM_TEACHER, Backgrounds, Batch, looseness
from mien_training.data.framing import BASENET
from mien_training.data.sequences import template
from mien_training.phase1 import train_encoder
from mien_training.phase1.losses import Losses


def batch_of(landmarks, has_landmarks):
    labels = dict.fromkeys(Batch._fields) | {"landmarks": landmarks, "visible": torch.ones(landmarks.shape[:2]),
                                             "has_landmarks": has_landmarks}
    return Batch(**labels)


class Alignment(unittest.TestCase):
    def setUp(self):
        self.losses = Losses(BASENET, 0.3, "cpu")
        self.truth = template().repeat(4, 1, 1)
        self.batch = batch_of(self.truth, torch.tensor([True, True, True, False]))

    def loss(self, points):
        return float(self.losses.alignment(points, self.batch))

    def test_counts_position_size_and_roll(self):
        middle = self.truth.mean(1, keepdim=True)
        assert self.loss(self.truth) < 1e-6
        assert 0.09 < self.loss(self.truth + torch.tensor([0.03, 0.0])) < 0.11, "0.03 of the crop is 0.1 of the eyes"
        assert self.loss(middle + 1.1 * (self.truth - middle)) > 0.02
        turned = (self.truth - middle) @ torch.tensor([[0.0, 1.0], [-1.0, 0.0]])
        assert self.loss(middle + np.cos(0.1) * (self.truth - middle) + np.sin(0.1) * turned) > 0.02

    def test_ignores_shape_and_images_without_landmarks(self):
        pair = torch.zeros_like(self.truth)
        # Two points that move apart: the fitted similarity stays nearly the same.
        pair[:, 0, 0], pair[:, 1, 0] = 0.02, -0.02
        assert self.loss(self.truth + pair) < 0.002
        moved = self.truth.clone()
        moved[3] += 1
        assert self.loss(moved) < 1e-6

    def test_learns_nothing_from_images_without_landmarks(self):
        points = torch.zeros_like(self.truth).requires_grad_()
        self.losses.alignment(self.truth + points, self.batch).backward()
        assert torch.isfinite(points.grad).all() and not points.grad[3].any()


class Looseness(unittest.TestCase):
    def test_turned_heads_are_cropped_more_roughly(self):
        angle = torch.tensor([0.0, 0.3, 0.6, -0.6, 1.2])
        rotation = torch.zeros(5, 3, 3)
        rotation[:, 0, 2], rotation[:, 2, 2] = angle.sin(), angle.cos()
        found = looseness(rotation)[:, 0]
        assert found[0] == found[1] == 1 and found[4] == 2
        assert 1 < found[2] < 2 and torch.isclose(found[2], found[3])


class Portraits(unittest.TestCase):
    def setUp(self):
        self.losses = Losses(BASENET, 0.3, "cpu")
        self.labels = torch.rand(50, len(CONTROLS), generator=torch.Generator().manual_seed(1))
        self.labels[:, INDEX["eyeLookUpLeft"]] = 0.2  # moves on no portrait
        learned = torch.tensor([name.startswith(LEARNED_FROM_TEACHER) for name in CONTROLS])
        self.losses.learn_teacher(SimpleNamespace(controls=self.labels, learned=learned))

    def loss(self, name):
        """The loss of an output with a wrong control, on portraits only."""
        out = self.labels.clone()
        out[:, INDEX[name]] = out[:, INDEX[name]].flip(0)
        labels = dict.fromkeys(Batch._fields) | {
            "controls": self.labels, "has_landmarks": torch.ones(50, dtype=bool),
            "has_controls": torch.zeros(50, dtype=bool), "trust": torch.ones(50, len(CONTROLS))}
        return float(self.losses.teacher(out, Batch(**labels)))

    def test_teach_smiles_jaw_eyelids_and_gaze_only(self):
        assert all(self.loss(name) > 0.01 for name in ("mouthSmileLeft", "jawOpen", "eyeBlinkRight", "eyeLookInLeft"))
        assert all(self.loss(name) < 1e-4 for name in ("mouthPucker", "browDownLeft", "eyeSquintLeft", "eyeLookUpLeft"))


class Mistaken(torch.nn.Module):
    """Takes bright pieces for a face, where the crop is: it believes to be aligned."""

    def __init__(self):
        super().__init__()
        self.framing, self.face = BASENET, torch.nn.Linear(1, 1)
        torch.nn.init.constant_(self.face.weight, 10)
        torch.nn.init.zeros_(self.face.bias)
        self.landmarks = torch.nn.Parameter(template())

    def forward(self, images):
        return {"face": self.face(images.mean((1, 2, 3))[:, None])[:, 0],
                "landmarks": self.landmarks.expand(len(images), -1, -1)}


class FalseFaces(unittest.TestCase):
    def setUp(self):
        self.places = Backgrounds.__new__(Backgrounds)
        self.places.mistakes, self.places.rng = 0, np.random.default_rng(3)
        side = BASENET.window
        self.places.mistaken, self.places.mistaken_crop = np.zeros((50, side, side, 3), np.uint8), torch.zeros(50, 4)

    def show(self, bright, count=1500):
        """Dark pieces; one in `bright` is brighter."""
        side = BASENET.window
        levels = np.where(np.arange(count) % bright, 100, 180).astype(np.uint8)
        self.places.pieces = lambda count: np.broadcast_to(levels[:count, None, None, None], (count, side, side, 3))

    def test_thresholds_fit_after_calibration(self):
        self.show(bright=100)
        images = torch.full((50, 3, 8, 8), 250 / 255)
        exact = SimpleNamespace(part=lambda *_: SimpleNamespace(images=images))
        network = Mistaken()
        with mock.patch.object(train_encoder.face_batches, "Mixture", lambda *_, **options: exact):
            train_encoder.calibrate(network, self.places, None)
        logit = lambda level: network.face(torch.tensor([level / 255 * 2 - 1])).item()
        self.assertAlmostEqual(logit(180), train_encoder.RARE_PLACE[1], 3)
        self.assertAlmostEqual(logit(250), train_encoder.RARE_FACE[1], 3)

    def test_mistakes_are_kept_after_each_alignment(self):
        self.show(bright=100)
        self.places.mine(Mistaken())
        self.assertEqual(self.places.mistakes, 3 * 15)
        self.assertTrue((self.places.mistaken[:45] == 180).all())


if __name__ == "__main__":
    unittest.main()
