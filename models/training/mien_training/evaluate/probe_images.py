"""Renders the images of the probes, and single people, into $MIEN_CACHE/synthetic/probe_<kind>.

The people are test identities, whose skins, hair and places never occur in training. Nothing covers the face: no
glasses, hat or occluder. Folders have the layout of make_synthetic.py with the whole image as the window, so
sequences.py can read them.
"""
import argparse
import shutil

import numpy as np
from tqdm import tqdm

from mien_training.data import expressions
from mien_training.data import make_synthetic as ms
from mien_training.evaluate.inputs import Missing
from mien_training.evaluate.probes import PLANS
from mien_training.paths import cache, data
from mien_training.renderer import camera, look, motion
from mien_training.renderer.rig import Rig
from mien_training.renderer.scene import Figure, Studio

SEED = 71
IDENTITIES = 24
PIXELS, SIDE = 256, 150.0    # of the image; of the face's crop in it, at rest
LENS = camera.Camera(PIXELS, PIXELS, PIXELS / 2 / np.tan(np.radians(20)))
WINDOW = np.array([PIXELS / 2, PIXELS / 2, PIXELS])
PEOPLE = 400                 # stills, each of a person of their own
PEOPLE_YAW, PEOPLE_TILT = 60, np.array([12, 8])  # degrees: uniform yaw up to; deviation of pitch and roll


def sitter(studio, rng):
    """(figure, head at rest [26719,3], Set) of a new person before the probes' camera."""
    person = look.sample(rng, "test")
    person.glasses = person.hat = None
    place = ms.Set(rng, "test", person)
    place.camera, place.occluder = LENS, None
    head = studio.rig.identity(person.identity[None])[0]
    return Figure(studio, person, head), head, place


def take(studio, figure, faces, place, poses):
    """Yields (image, labels) of faces [n,26719,3] in poses (rotation, translation)."""
    for vertices, pose in zip(faces, poses):
        yield ms.photograph(studio, WINDOW, PIXELS, figure, vertices, place, pose)


def turned(studio, head, angles):
    """Poses that turn a head about the neck, from one that faces the camera."""
    ahead, rest = camera.pose_at(LENS, studio.rig.landmarks(head), (0, 0, 0), (WINDOW[:2], SIDE))
    for degrees in angles:
        rotation = ahead @ camera.rotation(*np.radians(degrees))
        yield rotation, rest + (ahead - rotation) @ motion.NECK


def identity_pictures(studio, plan, number):
    """Yields (image, labels) of the images of a plan, of identity `number`."""
    figure, head, place = sitter(studio, np.random.default_rng([SEED, number]))
    for start in range(0, len(plan.controls), ms.BATCH):
        part = slice(start, start + ms.BATCH)
        faces = head + studio.rig.expression(np.stack(plan.controls[part]))
        shots = take(studio, figure, faces, place, turned(studio, head, plan.angles[part]))
        for k, (image, labels) in enumerate(shots):
            yield image, dict(labels, controls=plan.controls[start + k], angles=np.float32(plan.angles[start + k]),
                              identity=number, sequence=number, frame=start + k)


def people_pictures(studio):
    """Yields (image, labels) of people with random expressions and large head rotations."""
    for number in range(PEOPLE):
        rng = np.random.default_rng([SEED, IDENTITIES + number])
        figure, head, place = sitter(studio, rng)
        controls = expressions.sample_still(rng)
        angles = np.array([rng.uniform(-PEOPLE_YAW, PEOPLE_YAW), *rng.normal(0, PEOPLE_TILT)])
        face = head + studio.rig.expression(controls[None])
        image, labels = next(take(studio, figure, face, place, turned(studio, head, [angles])))
        yield image, dict(labels, controls=controls, angles=np.float32(angles), identity=number, sequence=number,
                          frame=0)


def folder_of(kind, number=0):
    return cache() / "synthetic" / f"probe_{kind}" / f"shard_{number:04d}"


def is_of(folder, plan):
    """Whether a folder has the images of this plan, and not those of an earlier one."""
    if not folder.exists():
        return False
    stored = np.load(folder / "labels.npz")
    return np.array_equal(stored["controls"], plan.controls) and np.array_equal(stored["angles"],
                                                                                np.float32(plan.angles))


def load(folder):
    """(images uint8 [n,PIXELS,PIXELS,3], labels)."""
    return np.load(folder / "images.npy", mmap_mode="r"), dict(np.load(folder / "labels.npz"))


def require_rig():
    if not (data() / "rig/rig.npz").exists():
        raise Missing("the rig pack is absent: MIEN_DATA must name the folder of the data packs")


def identities(kind, count=IDENTITIES):
    """Yields (images, labels) of the first identities of a plan, rendered where they are not in the cache yet."""
    require_rig()
    plan, studio = PLANS[kind](), None
    for number in tqdm(range(count), f"probe {kind}", mininterval=5):
        folder = folder_of(kind, number)
        if not is_of(folder, plan):
            shutil.rmtree(folder, ignore_errors=True)
            studio = studio or Studio(Rig())
            ms.save(folder, identity_pictures(studio, plan, number))
        yield load(folder)


def people():
    require_rig()
    folder = folder_of("people")
    if not folder.exists():
        ms.save(folder, tqdm(people_pictures(Studio(Rig())), "probe people", PEOPLE, mininterval=5))
    return load(folder)


def main():
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    for kind in PLANS:
        for _ in identities(kind):
            pass
    people()


if __name__ == "__main__":
    main()
