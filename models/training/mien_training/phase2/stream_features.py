"""Features of both networks from a stream of rendered sequences: render, track, encode, discard the frames.

usage: python3 -m mien_training.phase2.stream_features --count N [--split train] [--worker I/N] [--out FOLDER]
Needs the checkpoints of shipped_checkpoints.py. Shards of SHARD sequences appear in OUT one by one, so it resumes;
several workers share the work. Each sequence has two tracks: one with the encoders on every frame, one on alternate
frames. Of the split train one of them, at random, has the effects of a poor camera, and one is mirrored. Both networks
see the same windows (HiFiNet's).
"""
import argparse
import time
from pathlib import Path

import numpy as np
import torch

from mien_convert.atomic_files import whole
from mien_training.data import expressions, make_synthetic
from mien_training.data import landmark_points as lp
from mien_training.data.face_batches import to_crop
from mien_training.data.framing import HIFINET
from mien_training.data.sequences import BaseNetView, HiFiNetView, Sequences, crop_to_image, extract
from mien_training.networks.architectures import FEATURES
from mien_training.paths import cache
from mien_training.renderer.assets import note_missing_skins
from mien_training.renderer.rig import Rig
from mien_training.renderer.scene import Studio

SHARD, FRAMES, SEED = 16, 60, 21
KEPT = ("controls", "visible", "pose", "stride", "landmark_error", "points")
NETWORKS = ("basenet", "hifinet")


class BothViews(HiFiNetView):
    """Features of BaseNet and HiFiNet, one after the other, f32 [n,512]."""

    def look(self, images, crop, spoil):
        of_basenet, shape = self.basenet.look(images, crop, spoil)
        return torch.cat([of_basenet, self.close(images, crop_to_image(crop, shape), spoil)], 1), shape


def rendered(studio, rng, split, first, count):
    """`count` new people, as Sequences."""
    perform = expressions.sample_lesson if split == "train" else expressions.sample_sequence
    images, rows = [], []
    for k in range(count):
        shown, labels = zip(*make_synthetic.sequence(studio, HIFINET, rng, split, first + k, perform, FRAMES))
        images.append(np.stack(shown))
        rows.append({name: np.stack([row[name] for row in labels]) for name in labels[0]})
    return Sequences(images, {k: torch.from_numpy(np.stack([row[k] for row in rows])) for k in rows[0]})


def tracks(view, sequences, seed, varied):
    """Two tracks of every sequence, {name: [2 n, ...]}."""
    rng = np.random.default_rng(seed)
    plain, mirrored = (bool(rng.integers(2)) for _ in range(2)) if varied else (True, False)
    modes = [(1, plain, mirrored), (2, not plain or not varied, not mirrored and varied)]
    parts = []
    for stride, as_is, flip in modes:
        found = extract(view, sequences, seed, stride, as_is, flip)
        parts.append({**found, "points": points_seen(sequences, found["crop"], flip)})
    return {k: torch.cat([p[k] for p in parts]) for k in parts[0]}


def points_seen(sequences, crops, mirrored):
    """True landmarks [n,frames,175,2] in coordinates of the crops that the encoders saw."""
    points = sequences.label("landmarks")
    inside = to_crop(crops.flatten(0, 1), points.flatten(0, 1)).view_as(points)
    return (inside * torch.tensor([-1.0, 1]) + torch.tensor([1.0, 0]))[..., lp.MIRROR, :] if mirrored else inside


def kept(found):
    """The stored part of the tracks, in half precision where it suffices."""
    out = {k: found[k].half() if found[k].is_floating_point() else found[k] for k in KEPT}
    return {**out, **{name: found["features"][..., k * FEATURES:(k + 1) * FEATURES].half().clone()
                      for k, name in enumerate(NETWORKS)}}


def work(args, worker, workers):
    studio = Studio(Rig())
    view = BothViews(BaseNetView(args.checkpoints / "basenet.pt"), args.checkpoints / "hifinet.pt")
    folder = args.out / args.split
    folder.mkdir(parents=True, exist_ok=True)
    for shard in range(worker, -(-args.count // SHARD), workers):
        path = folder / f"{shard:05d}.pt"
        if path.exists():
            continue
        began, seed = time.time(), [SEED, make_synthetic.SPLITS.index(args.split), shard]
        sequences = rendered(studio, np.random.default_rng(seed), args.split, shard * SHARD, SHARD)
        between = time.time()
        found = kept(tracks(view, sequences, SEED * 100003 + shard, args.split == "train"))
        with whole(path) as out:
            torch.save(found, out)
        print(f"shard {shard}: rendered in {between - began:.0f} s, seen in {time.time() - between:.0f} s", flush=True)


def load(folder, network, most=None):
    """Stored tracks of a network, joined; the first `most` shards only."""
    parts = []
    for path in sorted(Path(folder).glob("*.pt"))[:most]:
        stored = torch.load(path, map_location="cpu")
        parts.append({"features": stored[network], **{k: stored[k] for k in KEPT if k in stored}})
    return {k: torch.cat([part[k] for part in parts]) for k in parts[0]}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, required=True, help="total number of sequences")
    parser.add_argument("--split", choices=make_synthetic.SPLITS, default="train")
    parser.add_argument("--worker", default="0/1", help="I/N: worker I, from 0, of N")
    parser.add_argument("--checkpoints", type=Path, default=cache() / "runs/shipped",
                        help="where shipped_checkpoints.py put them")
    parser.add_argument("--out", type=Path, default=cache() / "stream")
    args = parser.parse_args()
    torch.set_num_threads(1)
    note_missing_skins(args.split)
    with torch.no_grad():
        work(args, *map(int, args.worker.split("/")))


if __name__ == "__main__":
    main()
