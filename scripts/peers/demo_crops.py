"""Crops of the demo clip as the encoders see them."""
from pathlib import Path

import mien
import torch
from clip_frames import FPS, frames

from mien_training.data import sequences

ROOT = Path(__file__).resolve().parents[2]
CLIP = ROOT / "tests/data/demo.mp4"
EVERY = 3  # frames


def crops(framing):
    """f32 [n,3,height,width] in -1..1, of the tracked frames."""
    found = []
    with mien.Tracker(lod=4, sound=False, models=ROOT / "models") as tracker:
        for i, frame in enumerate(frames(CLIP)):
            result = tracker.track(frame, i / FPS, color="rgb")
            if i % EVERY or result.status != mien.FaceStatus.TRACKING:
                continue
            crop = sequences.fit_crop(sequences.template(), torch.from_numpy(result.landmarks[None].copy()))
            image = torch.from_numpy(frame.copy()).permute(2, 0, 1)[None].float() / 255
            found.append(sequences.sample_crops(image, crop, framing) * 2 - 1)
    return torch.cat(found)
