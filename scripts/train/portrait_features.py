#!/usr/bin/env python3
"""Features of the portraits, each held still for some frames, with the teacher's controls: what phase 2 sees of real faces.

usage: portrait_features.py --checkpoint BASENET.pt [--hifinet HIFINET.pt] --out FEATURES.pt      see also sequences.py
Their pose is not known: what stands in its place means nothing.
"""
import argparse
from pathlib import Path

import numpy as np
import torch

from faces import teacher_controls
from framing import BASENET, HIFINET
from landmark_points import TEACHER
from paths import cache
from sequences import BaseNetView, HiFiNetView, Sequences, extract


def portraits(split, framing):
    """Sequences of one frame each."""
    folder, n = cache() / "faces" / framing.folder(split), framing.window
    images, labels = np.load(folder / "images.npy", mmap_mode="r"), dict(np.load(folder / "labels.npz"))
    count = len(images)
    each = lambda *value: torch.tensor(value, dtype=torch.float32).expand(count, 1, len(value))
    found = {name: torch.from_numpy(labels[name]).unsqueeze(1) for name in ("landmarks", "crop")}
    found.update(controls=torch.from_numpy(teacher_controls(labels["name"])).unsqueeze(1), window=each(n / 2, n / 2, n),
                 visibility=torch.ones(count, 1, len(TEACHER)), rotation=torch.eye(3).expand(count, 1, 3, 3),
                 translation=each(0, 0, -0.6), f_px=each(n)[..., 0], camera_wh=each(n, n))
    return Sequences([image[None] for image in images], found)


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
    torch.save(extract(view, held, args.passes, args.seed, (1,), args.plain), args.out)


if __name__ == "__main__":
    main()
