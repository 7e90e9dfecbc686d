"""Controls of HiFiNet on portraits as labels of BaseNet, and agreement with the initial weights."""
import tempfile
import unittest
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import torch

from mien_training.data.expressions import CONTROLS, INDEX
from mien_training.data.face_batches import Portraits
from mien_training.data.framing import HIFINET
from mien_training.phase1.losses import Losses, of_portraits
from mien_training.phase2 import distil_controls

LEFT, RIGHT = INDEX["mouthFrownLeft"], INDEX["mouthFrownRight"]


def darker_sides(images):
    """A network that sees a frown where a side of the image is dark, and more of it on the right."""
    out = torch.zeros(len(images), len(CONTROLS))
    middle = images.shape[3] // 2
    dark = (1 - images.mean(1)) / 2
    out[:, LEFT], out[:, RIGHT] = dark[..., middle:].mean((1, 2)), 1.5 * dark[..., :middle].mean((1, 2))
    return {"controls": out}


class DistilControls(unittest.TestCase):
    def test_both_views_count_the_same(self):
        images = np.full((3, HIFINET.window, HIFINET.window, 3), 255, np.uint8)
        images[0, :, HIFINET.window // 2:], images[1, :, :HIFINET.window // 2] = 128, 128
        portraits = Portraits.__new__(Portraits)
        portraits.images, portraits.crop = images, torch.tensor(HIFINET.middle).expand(3, -1)
        found = distil_controls.controls(darker_sides, portraits)
        self.assertEqual(tuple(found.shape), (3, len(CONTROLS)))
        self.assertAlmostEqual(float(found[0, LEFT]), 1.25 * 0.5, delta=0.02)
        self.assertTrue(torch.allclose(found[0, [LEFT, RIGHT]], found[1, [RIGHT, LEFT]], atol=1e-4))
        self.assertLess(float(found[2].max()), 1e-6)

    def test_labels_replace_the_teachers(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "distilled.npz"
            np.savez(file, controls=np.full((2, 52), 0.5, np.float32), supported=np.arange(52) < 9)
            portraits = Portraits.__new__(Portraits)
            portraits.camera = {}
            portraits.distil(file)
        self.assertEqual(int(portraits.learned.sum()), 9)
        self.assertTrue((portraits.controls == 0.5).all() and (portraits.camera["trust"] == 1).all())


class Kept(unittest.TestCase):
    def test_a_change_counts_in_spreads_and_on_faces_only(self):
        before = torch.rand(400, len(CONTROLS), generator=torch.Generator().manual_seed(1))
        before[:, RIGHT] *= 0.1
        batch = SimpleNamespace(has_landmarks=torch.arange(400) < 300, has_controls=torch.arange(400) > 500)
        losses = Losses.__new__(Losses)

        def loss(control, change, rows=slice(300)):
            now = before.clone()
            now[rows, control] += change
            portraits = of_portraits(batch)
            return float(losses.kept(now[portraits], before[portraits]))

        self.assertEqual(loss(LEFT, 0.0), 0)
        self.assertAlmostEqual(loss(LEFT, 0.1), loss(RIGHT, 0.01), delta=0.2 * loss(LEFT, 0.1))
        self.assertGreater(loss(RIGHT, 0.1), 5 * loss(LEFT, 0.1))
        self.assertEqual(loss(LEFT, 0.5, slice(300, 400)), 0)


if __name__ == "__main__":
    unittest.main()
