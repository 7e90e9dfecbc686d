"""Crops of the demo clip as the encoders see them."""
import subprocess
from pathlib import Path

import mien
import numpy as np
import torch

from mien_training.data import sequences

ROOT = Path(__file__).resolve().parents[2]
CLIP = ROOT / "tests/data/demo.mp4"
WIDTH, HEIGHT, FPS = 640, 480, 30
EVERY = 3  # frames


def frames():
    """RGB uint8 [n,h,w,3]."""
    command = ["ffmpeg", "-nostdin", "-v", "error", "-i", CLIP, "-s", f"{WIDTH}x{HEIGHT}", "-pix_fmt", "rgb24", "-f",
               "rawvideo", "-"]
    data = subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout
    return np.frombuffer(data, np.uint8).reshape(-1, HEIGHT, WIDTH, 3)


def crops(framing):
    """f32 [n,3,height,width] in -1..1, of the tracked frames."""
    found = []
    with mien.Tracker(lod=4, sound=False, models=ROOT / "models") as tracker:
        for i, frame in enumerate(frames()):
            result = tracker.track(frame, i / FPS, color="rgb")
            if i % EVERY or result.status != mien.FaceStatus.TRACKING:
                continue
            crop = sequences.fit_crop(sequences.template(), torch.from_numpy(result.landmarks[None].copy()))
            image = torch.from_numpy(frame.copy()).permute(2, 0, 1)[None].float() / 255
            found.append(sequences.sample_crops(image, crop, framing) * 2 - 1)
    return torch.cat(found)
