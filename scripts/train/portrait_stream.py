#!/usr/bin/env python3
"""Features of both networks of the portraits, each held still for some frames, beside those of stream_features.py.

usage: portrait_stream.py --split train|val|test [--hold FRAMES] [--out FOLDER]
Labels are the teacher's controls and landmarks. Shards appear in OUT/portraits_SPLIT one by one, so that it goes on where it was stopped.
"""
import argparse
from pathlib import Path

import torch

from framing import HIFINET
from paths import cache
from portrait_features import portraits
from sequences import BaseNetView, Sequences, extract
from stream_features import BothViews, kept, points_seen
from whole_files import whole

SHARD = 512


def part(sequences, rows):
    return Sequences(sequences.images[rows], {k: v[rows] for k, v in sequences.labels.items()})


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--split", default="train")
    parser.add_argument("--hold", type=int, default=2)
    parser.add_argument("--checkpoints", type=Path, default=cache() / "runs/shipped", help="where shipped.py put them")
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
