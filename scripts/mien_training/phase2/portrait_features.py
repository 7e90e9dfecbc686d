"""Features of the portraits, each as a constant stream, with the teacher's controls and pose.

usage: python3 -m mien_training.phase2.portrait_features --checkpoint BASENET.pt [--hifinet HIFINET.pt]
       --out FEATURES.pt
See also sequences.py. The teacher's distance of a head has its own scale.
"""
import argparse
from pathlib import Path

import numpy as np
import torch

from mien_convert.atomic_files import whole
from mien_training.data import faces
from mien_training.data.framing import BASENET, HIFINET
from mien_training.data.landmark_points import TEACHER
from mien_training.data.sequences import BaseNetView, HiFiNetView, Sequences, extract
from mien_training.paths import cache


def portraits(split, framing):
    """Sequences of one frame each, in pixels of the whole images."""
    folder, found = cache() / "faces" / framing.folder(split), faces.Portraits(split)
    images = np.load(folder / "images.npy", mmap_mode="r")
    labels = {"landmarks": found.points, "crop": found.crops, "controls": found.labels.controls,
              "visibility": np.ones((len(images), len(TEACHER)), np.float32)}
    labels = {name: torch.from_numpy(value) for name, value in labels.items()} | faces.camera_labels(found, framing)
    return Sequences([image[None] for image in images], {name: value.unsqueeze(1) for name, value in labels.items()})


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--checkpoint", type=Path, required=True, help="of BaseNet")
    parser.add_argument("--hifinet", type=Path, help="a checkpoint of HiFiNet, whose features are wanted then")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--split", default="train")
    parser.add_argument("--hold", type=int, default=3)
    parser.add_argument("--passes", type=int, default=2)
    parser.add_argument("--plain", action="store_true", help="no photometric variety")
    parser.add_argument("--seed", type=int, default=0)
    args = parser.parse_args()
    torch.set_num_threads(1)
    view = BaseNetView(args.checkpoint)
    if args.hifinet:
        view = HiFiNetView(view, args.hifinet)
    held = portraits(args.split, HIFINET if args.hifinet else BASENET).held(args.hold)
    args.out.parent.mkdir(parents=True, exist_ok=True)
    found = extract(view, held, args.passes, args.seed, (1,), args.plain)
    with whole(args.out) as out:
        torch.save(found, out)


if __name__ == "__main__":
    main()
