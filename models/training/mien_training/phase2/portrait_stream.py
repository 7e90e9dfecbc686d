"""Features of both networks of the portraits, each as a constant stream, in the format of stream_features.py.

usage: python3 -m mien_training.phase2.portrait_stream --split train|val|test [--out FOLDER]
Labels are the teacher's controls, pose and landmarks; the teacher's distance of a head has its own scale. Shards appear
in OUT/portraits_SPLIT one by one; it resumes.
"""
import argparse
from pathlib import Path

import numpy as np
import torch

from mien_convert.atomic_files import whole
from mien_training.data import faces
from mien_training.data.framing import HIFINET
from mien_training.data.landmark_points import TEACHER
from mien_training.data.sequences import BaseNetView, Sequences, extract
from mien_training.paths import cache
from mien_training.phase2.stream_features import BothViews, kept, points_seen

SHARD, HOLD, SEED = 512, 2, 5


def portraits(split):
    """(images, labels) with one frame each, in pixels of the whole images."""
    folder, found = cache() / "faces" / HIFINET.folder(split), faces.Portraits(split)
    images = np.load(folder / "images.npy", mmap_mode="r")
    labels = {"landmarks": found.points, "crop": found.crops, "controls": found.labels.controls,
              "visibility": np.ones((len(images), len(TEACHER)), np.float32)}
    labels = {name: torch.from_numpy(value) for name, value in labels.items()} | faces.camera_labels(found, HIFINET)
    return images, {name: value.unsqueeze(1) for name, value in labels.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--split", default="train")
    parser.add_argument("--checkpoints", type=Path, default=cache() / "runs/shipped",
                        help="where shipped_checkpoints.py put them")
    parser.add_argument("--out", type=Path, default=cache() / "stream")
    args = parser.parse_args()
    torch.set_num_threads(1)
    folder = args.out / f"portraits_{args.split}"
    folder.mkdir(parents=True, exist_ok=True)
    view = BothViews(BaseNetView(args.checkpoints / "basenet.pt"), args.checkpoints / "hifinet.pt")
    (images, labels), plain = portraits(args.split), args.split != "train"
    for number, start in enumerate(range(0, len(images), SHARD)):
        path, rows = folder / f"{number:05d}.pt", slice(start, start + SHARD)
        if path.exists():
            continue
        shown = Sequences([image[None] for image in images[rows]], {k: v[rows] for k, v in labels.items()})
        shown, mirrored = shown.held(HOLD), not plain and number % 2 == 1
        found = extract(view, shown, SEED + number, 1, plain, mirrored)
        found["points"] = points_seen(shown, found["crop"], mirrored)
        with whole(path) as out:
            torch.save(kept(found), out)


if __name__ == "__main__":
    main()
