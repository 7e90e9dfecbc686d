"""Landmark errors of an encoder on validation portraits: from true crops, and from those it converges to.

usage: python3 -m mien_training.phase1.check_alignment [--network hifinet] CHECKPOINT...
The tracker fits each crop to the landmarks of the previous frame, so a network that follows errors of the crop drifts
away from a face. By yaw: mean error in distances between the pupils, at most WORST, and how many exceed RIGHT.
"""
import argparse
from pathlib import Path

import numpy as np
import torch
from tqdm import tqdm

from mien_training.data import faces
from mien_training.data.crop_sampler import sample
from mien_training.data.label_portraits import PUPILS
from mien_training.data.sequences import crop_to_image, fit_crop, load, template
from mien_training.evaluate.evaluate_wild import RIGHT
from mien_training.networks.architectures import FACE_NETWORKS

ALIGNMENTS = 7
YAWS = (0, 24, 36, 50, 90)  # degrees
WORST = 0.4


def errors(network, portraits, i):
    """Error from the true crop, and after ALIGNMENTS."""
    framing, crop = network.framing, portraits.crops[i]
    scale = framing.pixels_per_window(crop[2])
    image = faces.window(portraits.image(i), crop[:2], framing.window / scale, framing.window)[None]
    truth = torch.from_numpy((portraits.points[i] - crop[:2]) * scale + framing.window / 2).float()
    pupils = (truth[PUPILS[0]] - truth[PUPILS[1]]).norm().clamp(min=1)
    placed = torch.tensor([[*framing.middle[:3], crop[3]]], dtype=torch.float32)
    found = []
    for _ in range(ALIGNMENTS + 1):
        points = crop_to_image(placed, network(sample(image, placed, framing) * 2 - 1)["landmarks"])
        found.append(float((points[0] - truth).norm(dim=1).mean() / pupils))
        placed = fit_crop(template(), points)
    return found[0], found[-1]


@torch.no_grad()
def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--network", choices=FACE_NETWORKS, default="basenet")
    parser.add_argument("checkpoints", type=Path, nargs="+")
    options = parser.parse_args()
    portraits = faces.Portraits("val", ("faces_wild", "faces_more"))
    yaw = np.degrees(portraits.labels.yaw())
    for path in options.checkpoints:
        network = load(path, FACE_NETWORKS[options.network]())
        found = np.array([errors(network, portraits, i) for i in tqdm(range(len(portraits)), path.stem, mininterval=5)])
        for low, high in zip(YAWS, YAWS[1:]):
            rows = found[(yaw >= low) & (yaw < high)]
            if len(rows):
                first, last = np.minimum(rows, WORST).mean(0)
                wrong = (rows > RIGHT).sum(0)
                print(f"{path}: yaw {low} to {high}: {len(rows)} faces, error {first:.4f} -> {last:.4f}, "
                      f"wrong {wrong[0]} -> {wrong[1]}")


if __name__ == "__main__":
    main()
