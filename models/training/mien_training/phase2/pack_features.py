"""Packs streamed features of one network into a small file for an accelerator, and unpacks it.

usage: python3 -m mien_training.phase2.pack_features pack --network basenet|hifinet FILE.npz [--megabytes M]
       [--stream FOLDER]
       python3 -m mien_training.phase2.pack_features unpack --network basenet|hifinet FILE.npz FOLDER
Features get 8 bits per value, between the smallest and the largest of each. The file has the last frame of each
portrait and, if two do not fit, one track of each rendered sequence; sequences that do not fit are left out.
train_decoders.py --stream reads FOLDER.
"""
import argparse
import sys
from pathlib import Path

import numpy as np
import torch

from mien_convert.atomic_files import whole
from mien_training.networks.architectures import FACE_NETWORKS
from mien_training.paths import cache
from mien_training.phase2 import stream_features

MEGABYTE = 1 << 20
KINDS = ("train", "portraits_train")
LEVELS = 255
HALVES = ("pose", "points")


def quantised(values):
    """uint8 of values [...,c], and the smallest and the step of each of the c."""
    flat = values.reshape(-1, values.shape[-1])
    low = flat.min(0)
    step = np.maximum((flat.max(0) - low) / LEVELS, 1e-8)
    return np.rint((values - low) / step).astype(np.uint8), low, step


def packed(features, data, prefix):
    """{name: array} of tracks."""
    codes, low, step = quantised(features)
    out = {"features": codes, "low": low.astype(np.float32), "step": step.astype(np.float32)}
    for name in ("controls", "visible"):
        out[name] = np.rint(data[name].float().numpy() * LEVELS).astype(np.uint8)
    for name in HALVES:
        out[name] = data[name].half().numpy()
    return {f"{prefix}_{name}": value for name, value in out.items()}


def one_of_each(tracks):
    """Rows of one track of every sequence: of shards in turn that with the encoders on every frame, and that on
    alternate frames."""
    shards = torch.arange(tracks).view(-1, 2, stream_features.SHARD)
    return torch.cat([both[number % 2] for number, both in enumerate(shards)])


def of_renders(stream, network, room):
    """As many tracks as take no more than `room` bytes. Landmarks of renders are not learned from."""
    data = stream_features.load(stream / KINDS[0], network)
    tracks, frames = data["features"].shape[:2]
    # visibility and zeros compress well
    size = frames * sum(data[name].shape[-1] for name in ("features", "controls", "pose", "pose"))
    rows = torch.arange(tracks) if tracks * size <= room else one_of_each(tracks)[:room // size]
    data = {name: value[rows] for name, value in data.items()}
    return packed(data["features"].float().numpy(), {**data, "points": torch.zeros(len(rows), 0)},
                  KINDS[0]), len(rows), tracks


def portrait_stills(stream, network):
    data = {name: value[:, -1:] for name, value in stream_features.load(stream / KINDS[1], network).items()
            if value.dim() > 1}
    return packed(data["features"].float().numpy(), data, KINDS[1])


def pack(args):
    portraits = portrait_stills(args.stream, args.network)
    room = args.megabytes * MEGABYTE - sum(value.nbytes for value in portraits.values())
    renders, kept, known = of_renders(args.stream, args.network, int(room))
    with whole(args.file) as out:
        np.savez_compressed(out, **renders, **portraits)
    size = args.file.stat().st_size / MEGABYTE
    print(
        f"{args.file.name}: {kept} of {known} tracks of renders, {len(portraits[f'{KINDS[1]}_features'])} portraits, "
        f"{size:.1f} MB")
    if size > args.megabytes:
        sys.exit(f"--megabytes: the file is too large (got {size:.1f}, expected at most {args.megabytes})")


def unpack(args):
    table = np.load(args.file)
    for kind in KINDS:
        of = lambda name: table[f"{kind}_{name}"]
        features = of("features").astype(np.float32) * of("step") + of("low")
        stored = {args.network: torch.from_numpy(features).half(),
                  **{name: torch.from_numpy(of(name)) for name in HALVES}}
        for name in ("controls", "visible"):
            stored[name] = (torch.from_numpy(of(name)).float() / LEVELS).half()
        (args.folder / kind).mkdir(parents=True, exist_ok=True)
        with whole(args.folder / kind / "00000.pt") as out:
            torch.save(stored, out)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(required=True)
    for run in (pack, unpack):
        command = commands.add_parser(run.__name__)
        command.set_defaults(run=run)
        command.add_argument("--network", choices=FACE_NETWORKS, required=True)
        command.add_argument("file", type=Path)
        if run is pack:
            command.add_argument("--megabytes", type=int, default=56)
            command.add_argument("--stream", type=Path, default=cache() / "stream")
        else:
            command.add_argument("folder", type=Path)
    args = parser.parse_args()
    args.run(args)


if __name__ == "__main__":
    main()
