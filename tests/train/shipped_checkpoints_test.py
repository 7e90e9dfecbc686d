#!/usr/bin/env python3
"""Committed weights come back from shipped_checkpoints.py exactly, and streamed features are stored as they are learned
from."""
import tempfile
import unittest
from pathlib import Path

import torch

from mien_training.networks import export, shipped_checkpoints, weight_reader
from mien_training.networks.round_weights import rounded
from mien_training.networks.warm_start import decoders_of
from mien_training.phase2 import stream_features

ROOT = Path(__file__).resolve().parents[2]


class Shipped(unittest.TestCase):
    def test_export_of_what_is_shipped_gives_the_same_bytes(self):
        for name in ("basenet", "hifinet"):
            path = ROOT / f"models/{name}.mien"
            with tempfile.TemporaryDirectory() as folder:
                files = [Path(folder) / "encoder.pt", Path(folder) / "decoders.pt"]
                torch.save(shipped_checkpoints.checkpoint(path, name), files[0])
                torch.save(decoders_of(path), files[1])
                made = rounded(export.FILES[name](*files).to_bytes())
            self.assertEqual(made, path.read_bytes(), name)

    def test_metadata(self):
        found = weight_reader.metadata(ROOT / "models/hifinet.mien")
        self.assertEqual(found["name"], "hifinet")
        self.assertGreater(int(found["encoder_samples"]), 0)


class Streamed(unittest.TestCase):
    def tracks(self, seed):
        torch.manual_seed(seed)
        shape = (4, 6)
        return {"features": torch.randn(*shape, 512), "controls": torch.rand(*shape, 52),
                "visible": torch.ones(*shape, 52),
                "pose": torch.randn(*shape, 9), "stride": torch.tensor([1, 1, 2, 2]),
                "landmark_error": torch.rand(*shape), "points": torch.rand(*shape, 175, 2)}

    def test_shards_join_in_order_and_each_network_finds_its_own(self):
        with tempfile.TemporaryDirectory() as folder:
            for number in (1, 0):
                torch.save(stream_features.kept(self.tracks(number)), Path(folder) / f"{number:05d}.pt")
            for k, name in enumerate(stream_features.NETWORKS):
                found = stream_features.load(folder, name)
                wanted = torch.cat([self.tracks(n)["features"][..., 256 * k:256 * (k + 1)] for n in (0, 1)])
                self.assertTrue(torch.equal(found["features"], wanted.half()), name)
                self.assertEqual(found["stride"].tolist(), [1, 1, 2, 2] * 2)
                self.assertEqual(len(stream_features.load(folder, name, 1)["stride"]), 4)


if __name__ == "__main__":
    unittest.main()
