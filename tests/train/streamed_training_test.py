#!/usr/bin/env python3
"""Training on streamed features: it resumes, and writes decoders of plain features and the controls they support."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
import torch

from mien_training.data.expressions import INDEX
from mien_training.networks.architectures import ControlsDecoder, PoseDecoder
from mien_training.phase2 import decoder_scores, pack_features, stream_features, train_decoders
from mien_training.phase2.whitening import Whitening

ROOT = Path(__file__).resolve().parents[2]

torch.set_num_threads(1)


def shard(path, tracks, frames):
    path.parent.mkdir(parents=True, exist_ok=True)
    shape = (tracks, frames)
    made = {"features": torch.randn(*shape, 512), "controls": torch.rand(*shape, 52), "visible": torch.ones(*shape, 52),
            "pose": torch.randn(*shape, 9), "stride": torch.ones(tracks), "landmark_error": torch.rand(*shape),
            "points": torch.rand(*shape, 175, 2)}
    torch.save(stream_features.kept(made), path)


class Streamed(unittest.TestCase):
    def train(self, folder, steps, *options, network="hifinet"):
        out = Path(folder) / "decoders.pt"
        command = [sys.executable, "-m", "mien_training.phase2.train_decoders", "--network", network, "--stream",
                   folder, "--out", out, "--steps", str(steps), "--batch", "3", "--portraits", "4", *options]
        subprocess.run([str(c) for c in command], check=True, capture_output=True)
        return torch.load(out)

    def test_resumes_and_exports_a_decoder_without_whitening(self):
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
        plain.load_state_dict(second["controls_decoder"])
        white.load_state_dict(second["white"])
        x = torch.randn(2, 7, 256)
        with torch.no_grad():
            apart = plain(x)[0] - white(whitening(x), whitening.start(white, 2))[0]
        self.assertLess(float(apart.abs().max()), 1e-3)

    def test_a_pose_decoder_keeps_the_controls_decoder(self):
        torch.manual_seed(1)
        before = {"controls_decoder": ControlsDecoder().state_dict(), "pose_decoder": PoseDecoder().state_dict(),
                  "supported": torch.ones(52), "optimiser": "of another run"}
        with tempfile.TemporaryDirectory() as folder:
            torch.save(before, Path(folder) / "before.pt")
            shard(Path(folder) / "train/00000.pt", 6, 10)
            shard(Path(folder) / "portraits_train/00000.pt", 40, 2)
            after = self.train(folder, 3, "--decoder", "pose", "--start-from", f"{folder}/before.pt", network="basenet")
        same = lambda name: all(torch.equal(v, after[name][k]) for k, v in before[name].items())
        self.assertTrue(same("controls_decoder"))
        self.assertFalse(same("pose_decoder"))
        self.assertNotEqual(after["optimiser"], before["optimiser"])
        self.assertEqual(after["supported"].tolist(), [1] * 52)

    def test_supported_controls_are_those_that_follow_the_truth(self):
        torch.manual_seed(1)
        controls, noise = torch.rand(40, 6, 52), 0.7 * torch.randn(40, 6, 52)
        blinks, gaze = ([INDEX[unit + side] for side in ("Left", "Right")] for unit in ("eyeBlink", "eyeLookUp"))
        jaw = INDEX["jawOpen"]
        noise[..., [jaw, *blinks, *gaze]] = 0
        noise[..., blinks[0]] = 2 * torch.randn(40, 6)  # one side of a pair
        people = {"features": controls + noise, "controls": controls, "visible": torch.ones_like(controls),
                  "stride": torch.tensor([1, 2] * 20)}
        portraits = {**people, "controls": torch.zeros_like(controls)}  # the teacher knows none
        chosen = decoder_scores.supported_controls(lambda x: (x, None), people, portraits, np.zeros(52, bool))
        self.assertEqual(chosen.nonzero()[0].tolist(), sorted([jaw, *gaze]))

    def test_portraits_hold_still(self):
        number = torch.arange(40.0).view(40, 1, 1)
        data = {name: number.expand(40, 2, width) for name, width in (("features", 4), ("pose", 9), ("controls", 52),
                                                                      ("visible", 52))}
        batch, mask = train_decoders.Portraits({**data, "points": torch.rand(40, 2, 175, 2)}, 100).batch()
        self.assertEqual(tuple(batch["features"].shape), (100, 10, 4))
        self.assertTrue(torch.equal(batch["features"][:, 1:], batch["features"][:, :-1]))
        self.assertTrue(torch.equal(batch["features"][..., 0], batch["pose"][..., 0]))
        self.assertEqual(mask[0, :, 0].tolist(), [0.25] * 2 + [1] * 8)

    def test_no_weight_falls_on_a_cut_from_face_to_face(self):
        data = {"features": torch.zeros(4, 5, 3), "controls": torch.zeros(4, 5, 52), "visible": torch.ones(4, 5, 52),
                "pose": torch.zeros(4, 5, 9)}
        batch, mask = train_decoders.Tracks(data, 2).batch()
        self.assertEqual(tuple(batch["features"].shape), (2, 10, 3))
        self.assertEqual(mask[0, :, 0].tolist(), [0.5, 1, 1, 1, 1] + [0, 1, 1, 1, 1])


class Packed(unittest.TestCase):
    """What travels to an accelerator, and back; here the accelerator is the CPU."""

    def on_gpu(self, folder, *arguments):
        asked = {"MIEN_CACHE": folder, "PYTHON": sys.executable, "DEVICE": "cpu", "STEPS": "6",
                 "OPTIONS": "--batch 3 --portraits 4"}
        command = [ROOT / "models/training/mien_training/phase2/on_gpu.sh", *arguments]
        return subprocess.run([str(c) for c in command], env={**os.environ, **asked}, capture_output=True, text=True)

    def test_trains_from_the_packed_file_to_decoders_that_can_be_exported(self):
        torch.manual_seed(2)
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            shard(folder / "stream/train/00000.pt", 6, 10)
            shard(folder / "stream/portraits_train/00000.pt", 40, 2)
            for arguments in (("pack", "basenet", folder), ("train", "basenet", folder, folder / "out")):
                done = self.on_gpu(name, *arguments)
                self.assertEqual(done.returncode, 0, done.stderr)
            files = sorted(path.name for path in (folder / "out").iterdir())
            known = torch.load(folder / "out/basenet_decoders.pt")
        self.assertEqual(files, ["basenet_decoders.pt", *(f"basenet_decoders_{step}.pt" for step in range(1, 7))])
        self.assertEqual(known["step"], 6)
        self.assertEqual(len(known["supported"]), 52)
        self.assertIn("pose_decoder", known)

    def test_packed_features_are_unpacked_within_a_rounding(self):
        torch.manual_seed(3)
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            shard(folder / "train/00000.pt", 6, 10)
            shard(folder / "portraits_train/00000.pt", 40, 2)
            for command in (["pack", "--stream", name, folder / "x.npz"], ["unpack", folder / "x.npz",
                                                                           folder / "back"]):
                subprocess.run([sys.executable, "-m", "mien_training.phase2.pack_features", command[0], "--network",
                                "hifinet", *map(str, command[1:])], check=True, capture_output=True)
            for kind, frames in (("train", slice(None)), ("portraits_train", slice(-1, None))):
                before, after = (stream_features.load(f / kind, "hifinet") for f in (folder, folder / "back"))
                for field, most in (("features", 0.03), ("controls", 0.003), ("visible", 0.003)):
                    apart = (before[field][:, frames].float() - after[field].float()).abs().max()
                    self.assertLess(float(apart), most, f"{kind}, {field}")
            self.assertTrue(torch.equal(before["points"][:, -1:], after["points"]))

    def test_one_track_of_each_sequence(self):
        rows = pack_features.one_of_each(4 * stream_features.SHARD)
        size = stream_features.SHARD
        self.assertEqual(rows.tolist(), [*range(size), *range(3 * size, 4 * size)])

    def test_unknown_commands_are_refused(self):
        done = self.on_gpu("/nowhere", "fetch", "basenet", "/nowhere")
        self.assertEqual(done.returncode, 64)
        self.assertIn("expected pack or train", done.stderr)


if __name__ == "__main__":
    unittest.main()
