"""Renders labelled synthetic faces: stills, or sequences of --frames (90) at 30 frames a second.

OUT/<split>_<kind>/shard_0000/images.npy is uint8 [n,window,window,3] RGB, with the window of the framing (framing.py).
labels.npz has for each image: landmarks [n,175,2] in camera pixels; window [n,3] (cx, cy, side of the stored image in
camera pixels); crop [n,4] (cx, cy, side, roll); controls [n,52]; rotation [n,3,3] and translation [n,3] (metres) of the
head in camera space; f_px [n]; camera_wh [n,2]; visibility [n,175]; identity, sequence, frame [n]. The number of the
shard and the options determine a shard; finished shards are kept.
"""
import argparse
import itertools
import os
import shutil
from functools import partial
from multiprocessing import Pool
from pathlib import Path

import numpy as np
from tqdm import tqdm

from mien_training.data import expressions
from mien_training.data.framing import BASENET, FRAMINGS
from mien_training.paths import cache
from mien_training.renderer import background, camera, lighting, look, motion, props
from mien_training.renderer.assets import note_missing_skins
from mien_training.renderer.rig import Rig
from mien_training.renderer.scene import Figure, Scene, Studio

SPLITS, KINDS = ("train", "val", "test"), ("stills", "sequences")
STILLS_PER_SHARD, SEQUENCES_PER_SHARD, FRAMES = 2000, 22, 90
BATCH = 16          # heads blended together
OCCLUDED = 0.15     # share of images with something in front of the face


class Set:
    """Surroundings of a sequence: camera, light, backdrop and an optional occluder."""

    def __init__(self, rng, split, person):
        environment = lighting.sample_environment(rng, split)
        self.camera = camera.sample_camera(rng)
        self.light = lighting.sample(rng, environment)
        self.backdrop = background.sample(rng, environment, self.camera)
        self.occluder = props.sample_occluder(rng, person.skin_colour()) if rng.random() < OCCLUDED else None
        self.target, self.offset, self.lift = rng.integers(175), rng.normal(0, [4, 4, 0]), rng.uniform(2, 7)

    def occluders(self, points, shift):
        """The occluder in front of its landmark of points [175,3] (camera space, cm), moved by shift [3]."""
        if self.occluder is None:
            return ()
        vertices, triangles, colour = self.occluder
        near = points[self.target] * (1 - self.lift / np.linalg.norm(points[self.target]))
        reach = max(vertices[:, 2].max(), 0)
        return ((vertices + near + self.offset + shift + [0, 0, reach], triangles, colour),)


def shoot(studio, framing, figure, vertices, place, pose, shift=np.zeros(3)):
    """Image and labels of one frame; `place` is a Set, `pose` (rotation, translation in cm)."""
    crop = camera.fit_crop(place.camera.project(studio.rig.landmarks(vertices) @ pose[0].T + pose[1]))
    window = np.array([*crop[:2], framing.window_crops * crop[2]])
    return photograph(studio, window, framing.window, figure, vertices, place, pose, shift)


def photograph(studio, window, pixels, figure, vertices, place, pose, shift=np.zeros(3)):
    """The same for any window (cx, cy, side) of the camera's image, as pixels x pixels."""
    landmarks = studio.rig.landmarks(vertices)
    points = landmarks @ pose[0].T + pose[1]
    seen_at = place.camera.project(points)
    view = place.camera.view(*(window[:2] - window[2] / 2), window[2], pixels, pixels)
    scene = Scene(figure, vertices, *pose, landmarks, place.light, view, background.behind(place.backdrop, view),
                  place.occluders(points, shift))
    image, visible = studio.render(scene)
    labels = dict(landmarks=np.float32(seen_at), window=np.float32(window), crop=np.float32(camera.fit_crop(seen_at)),
                  rotation=np.float32(pose[0]), translation=np.float32(pose[1] / 100),
                  f_px=np.float32(place.camera.f_px),
                  camera_wh=np.int16([place.camera.width, place.camera.height]), visibility=visible)
    return image, labels


def stills(studio, framing, rng, args, first, perform, count):
    """Yields (image, labels) of `count` stills numbered from `first`, args.alike of each person, a share of them
    args.turned; `perform` makes the controls of several."""
    for start in range(0, count, BATCH):
        wanted = min(BATCH, count - start)
        people = [look.sample(rng, args.split) for _ in range(-(-wanted // args.alike))]
        people = [person for person in people for _ in range(args.alike)][:wanted]
        controls = perform(rng, len(people))
        heads = studio.rig.identity(np.stack([p.identity for p in people]))
        faces = heads + studio.rig.expression(controls)
        for k, person in enumerate(people):
            place = Set(rng, args.split, person)
            pose = camera.pose_at(place.camera, studio.rig.landmarks(faces[k]), camera.sample_angles(rng, args.turned),
                                  camera.sample_place(rng, place.camera))
            image, labels = shoot(studio, framing, Figure(studio, person, heads[k]), faces[k], place, pose)
            number = first + start + k
            yield image, dict(labels, controls=controls[k], identity=number // args.alike, sequence=number, frame=0)


def sequence(studio, framing, rng, split, number, perform, frames):
    """Yields (image, labels) of `frames` frames of one person; `perform` makes the controls of a sequence."""
    person = look.sample(rng, split)
    place = Set(rng, split, person)
    head = studio.rig.identity(person.identity[None])[0]
    figure = Figure(studio, person, head)
    controls = perform(rng, frames)
    rotations, translations, sweep = motion.head_poses(rng, place.camera, studio.rig.landmarks(head), frames)
    for start in range(0, frames, BATCH):
        faces = head + studio.rig.expression(controls[start:start + BATCH])
        for k, vertices in enumerate(faces):
            t = start + k
            image, labels = shoot(studio, framing, figure, vertices, place, (rotations[t], translations[t]), sweep[t])
            yield image, dict(labels, controls=controls[t], identity=number, sequence=number, frame=t)


def frames_of_shard(studio, framing, args, shard, count, perform):
    """Yields (image, labels); `count` is of stills or sequences in this shard."""
    rng = np.random.default_rng([1, SPLITS.index(args.split), KINDS.index(args.kind), shard])
    if args.kind == "stills":
        yield from stills(studio, framing, rng, args, shard * STILLS_PER_SHARD, perform, count)
    else:
        for k in range(count):
            yield from sequence(studio, framing, rng, args.split, shard * SEQUENCES_PER_SHARD + k, perform, args.frames)


def write_shard(studio, framing, folder, args, shard, count, perform, position):
    total = count * (args.frames if args.kind == "sequences" else 1)
    source = frames_of_shard(studio, framing, args, shard, count, perform)
    save(folder, tqdm(source, f"{folder.parent.name} {shard}", total, position=position, mininterval=5, leave=False))


def save(folder, pictures):
    """Writes the (image, labels) of a shard; a folder that is not whole never appears under its name."""
    images, labels = zip(*pictures)
    unfinished = folder.with_name(f".{folder.name}.{os.getpid()}")
    unfinished.mkdir(parents=True, exist_ok=True)
    np.save(unfinished / "images.npy", np.stack(images))
    table = {k: np.stack([row[k] for row in labels]) for k in labels[0]}
    for name in ("identity", "sequence", "frame"):
        table[name] = table[name].astype(np.int32)
    np.savez(unfinished / "labels.npz", **table)
    unfinished.rename(folder)


def work(job):
    """Renders the shards of one worker, `job` = (arguments, worker number)."""
    args, worker = job
    per_shard = STILLS_PER_SHARD if args.kind == "stills" else SEQUENCES_PER_SHARD
    studio, framing = None, FRAMINGS[args.framing]
    perform = expressions.sample_sequence if args.kind == "sequences" else partial(
        expressions.sample_stills, leaning=args.leaning, apart=args.apart)
    place = args.out / framing.folder(f"{args.split}_{args.kind}")
    for shard in numbers_of(args, per_shard, place, worker):
        folder = place / f"shard_{shard:04d}"
        if folder.exists():
            continue
        studio = studio or Studio(Rig())
        count = per_shard if args.keep else min(per_shard, args.count - shard * per_shard)
        write_shard(studio, framing, folder, args, shard, count, perform, worker)
        delete_old(place, args.keep)


def numbers_of(args, per_shard, place, worker):
    """The shards of a worker: those of --count, or with --keep all that follow the last one there is."""
    if not args.keep:
        return range(worker, -(-args.count // per_shard), args.workers)
    last = max((int(shard.name.split("_")[1]) for shard in place.glob("shard_*")), default=-1)
    return itertools.count((last // args.workers + 1) * args.workers + worker, args.workers)


def delete_old(place, keep):
    """A process that has mapped the images of a deleted shard keeps them until it refreshes."""
    for shard in sorted(place.glob("shard_*"))[:-keep] if keep else ():
        shutil.rmtree(shard, ignore_errors=True)  # another worker may do the same


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--split", choices=SPLITS, required=True)
    parser.add_argument("--kind", choices=KINDS, required=True)
    amount = parser.add_mutually_exclusive_group(required=True)
    amount.add_argument("--count", type=int, help="stills or sequences in all")
    amount.add_argument("--keep", type=int, metavar="SHARDS", help="renders without end, keeping the latest shards")
    parser.add_argument("--framing", choices=FRAMINGS, default=BASENET.name)
    parser.add_argument("--frames", type=int, default=FRAMES, help="of a sequence")
    parser.add_argument("--leaning", type=float, default=0, help="share of stills whose expression leans to one side")
    parser.add_argument("--apart", type=float, default=0, help="share of stills with one moving unit a region at most")
    parser.add_argument("--turned", type=float, default=0, help="share of stills whose head looks far to one side")
    parser.add_argument("--alike", type=int, choices=(1, 2, 4, 8), default=1, help="stills of each person")
    parser.add_argument("--out", type=Path, default=cache() / "synthetic")
    parser.add_argument("--workers", type=int, default=1)
    args = parser.parse_args()
    if (args.leaning or args.apart or args.turned or args.alike > 1) and args.kind == "sequences":
        parser.error("--leaning, --apart, --turned and --alike are for stills")
    note_missing_skins(args.split)
    jobs = [(args, worker) for worker in range(args.workers)]
    if args.workers == 1:
        work(jobs[0])
    else:
        with Pool(args.workers) as pool:
            pool.map(work, jobs)


if __name__ == "__main__":
    main()
