"""Features of both networks of the portraits, each as a constant stream, in the format of stream_features.py.

usage: python3 -m mien_training.phase2.portrait_stream --split train|val|test [--hold FRAMES] [--out FOLDER]
Labels are the teacher's controls and landmarks. Shards appear in OUT/portraits_SPLIT one by one; it resumes.
"""
import argparse
from pathlib import Path

import torch

from mien_convert.atomic_files import whole
from mien_training.data.framing import HIFINET
from mien_training.data.sequences import BaseNetView, Sequences, extract
from mien_training.paths import cache
from mien_training.phase2.portrait_features import portraits
from mien_training.phase2.stream_features import BothViews, kept, points_seen

SHARD = 512


def part(sequences, rows):
    return Sequences(sequences.images[rows], {k: v[rows] for k, v in sequences.labels.items()})


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--split", default="train")
    parser.add_argument("--hold", type=int, default=2)
    parser.add_argument("--checkpoints", type=Path, default=cache() / "runs/shipped",
                        help="where shipped_checkpoints.py put them")
    parser.add_argument("--out", type=Path, default=cache() / "stream")
    parser.add_argument("--seed", type=int, default=5)
    args = parser.parse_args()
    torch.set_num_threads(1)
    folder = args.out / f"portraits_{args.split}"
    folder.mkdir(parents=True, exist_ok=True)
    view = BothViews(BaseNetView(args.checkpoints / "basenet.pt"), args.checkpoints / "hifinet.pt")
    faces, plain = portraits(args.split, HIFINET), args.split != "train"
    for number, start in enumerate(range(0, len(faces), SHARD)):
        path = folder / f"{number:05d}.pt"
        if path.exists():
            continue
        shown = part(faces, slice(start, start + SHARD)).held(args.hold)
        mirrored = not plain and number % 2 == 1
        with torch.no_grad():
            found = extract(view, shown, 1, args.seed + number, (1,), plain, mirrored)
        found["points"] = points_seen(shown, found["crop"], mirrored)
        with whole(path) as out:
            torch.save(kept(found), out)


if __name__ == "__main__":
    main()
