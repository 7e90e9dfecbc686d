#!/usr/bin/env python3
"""Training on streamed features: it goes on where it was stopped, and what it leaves is a decoder of plain features."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import torch

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts/train"))
import stream_features  # noqa: E402
import train_streamed  # noqa: E402
from networks import ControlsDecoder  # noqa: E402
from whitening import Whitening  # noqa: E402

torch.set_num_threads(1)


def shard(path, tracks, frames):
    path.parent.mkdir(parents=True, exist_ok=True)
    shape = (tracks, frames)
    made = {"features": torch.randn(*shape, 512), "controls": torch.rand(*shape, 52), "visible": torch.ones(*shape, 52),
            "pose": torch.randn(*shape, 9), "stride": torch.ones(tracks), "landmark_error": torch.rand(*shape),
            "points": torch.rand(*shape, 175, 2)}
    torch.save(stream_features.kept(made), path)


class Streamed(unittest.TestCase):
    def train(self, folder, steps):
        out = Path(folder) / "decoders.pt"
        command = [sys.executable, ROOT / "scripts/train/train_streamed.py", "--network", "hifinet", "--stream", folder, "--out", out,
                   "--steps", str(steps), "--batch", "3", "--portraits", "4"]
        subprocess.run([str(c) for c in command], check=True, capture_output=True)
        return torch.load(out)

    def test_goes_on_and_leaves_a_decoder_of_plain_features(self):
        torch.manual_seed(1)
        with tempfile.TemporaryDirectory() as folder:
            for number in range(2):
                shard(Path(folder) / f"train/{number:05d}.pt", 6, 10)
            shard(Path(folder) / "portraits_train/00000.pt", 40, 2)
            first, second = self.train(folder, 3), self.train(folder, 5)
        self.assertEqual((first["step"], second["step"]), (3, 5))
        self.assertFalse(torch.equal(first["white"]["output.bias"], second["white"]["output.bias"]))
        whitening = Whitening(second["mean"], second["matrix"])
        plain, white = ControlsDecoder(), ControlsDecoder()
        plain.load_state_dict(second["controls_decoder"]), white.load_state_dict(second["white"])
        x = torch.randn(2, 7, 256)
        with torch.no_grad():
            apart = plain(x)[0] - white(whitening(x), whitening.start(white, 2))[0]
        self.assertLess(float(apart.abs().max()), 1e-3)

    def test_no_weight_falls_on_a_cut_from_face_to_face(self):
        data = {"features": torch.zeros(4, 5, 3), "controls": torch.zeros(4, 5, 52), "visible": torch.ones(4, 5, 52)}
        batch, mask = train_streamed.Tracks(data, 2, 3).batch()
        self.assertEqual(tuple(batch["features"].shape), (2, 15, 3))
        self.assertEqual(mask[0, :, 0].tolist(), [0.5, 1, 1, 1, 1] + [0, 1, 1, 1, 1] * 2)


if __name__ == "__main__":
    unittest.main()
