"""Portraits: boxes of faces, and a cache of face windows in the renderer's format.

usage: python3 -m mien_training.data.faces
Writes $MIEN_CACHE/faces/<split>[_hifinet]/{images.npy,labels.npz}: images uint8 [n,window,window,3], a square around
the centre of the crop (framing.py); landmarks [n,175,2] and crop [n,4] (cx, cy, side, theta) in pixels of that window;
trust [n], below 1 for blurred images, whose labels are less reliable. Also misplaced.npy, uint8 [2n,112,112,3]: windows
of training portraits that the tracker must not accept as a face.
"""
import cv2
import numpy as np
import torch
from tqdm import tqdm

from mien_convert.atomic_files import whole
from mien_training.data import portrait_labels
from mien_training.data.framing import BASENET, FRAMINGS
from mien_training.data.image_border import continued, warped
from mien_training.data.sequences import fit_crop, template
from mien_training.paths import cache

TEACHER_FOV = np.radians(63)  # vertical field of view of the camera that MediaPipe assumes (face_geometry)
GUESSED = 0.3                 # trust in labels of blurred images
# An image is blurred if the Laplacian of the face at BaseNet's scale has less variance, relative to the image's.
BLURRED = 0.1


class Portraits:
    """(image uint8 [h,w,3], box (cx, cy, side)) of one split."""

    def __init__(self, split, packs=portrait_labels.PACKS):
        self.labels = portrait_labels.of_split(split, packs)
        self.names, self.size_wh = self.labels.name, self.labels.size_wh
        self.points = self.labels.points
        self.crops = fit_crop(template(), torch.from_numpy(self.points)).numpy() if len(self) else np.zeros((0, 4),
                                                                                                            np.float32)

    def __len__(self):
        return len(self.names)

    def image(self, i):
        return cv2.imread(str(self.labels.path(i)))[..., ::-1]

    def __getitem__(self, i):
        if i >= len(self):
            raise IndexError
        return np.ascontiguousarray(self.image(i)), self.crops[i, :3]


def camera_labels(found, framing):
    """Position of the portraits in front of their camera according to the teacher: tensors as of a rendered shard."""
    window = np.concatenate([found.crops[:, :2], framing.window_crops * found.crops[:, 2:3]], 1)
    labels = {"rotation": found.labels.rotation, "translation": found.labels.translation,
              "f_px": found.size_wh[:, 1] / 2 / np.tan(TEACHER_FOV / 2), "camera_wh": found.size_wh, "window": window}
    return {name: torch.from_numpy(np.float32(value)) for name, value in labels.items()}


def leaves(image, centre, side):
    """Whether a square exceeds the image."""
    return bool((centre < side / 2).any() or (centre + side / 2 > image.shape[1::-1]).any())


def window(image, centre, side, pixels=BASENET.window):
    """A square of the image as [pixels,pixels,3]; blurred where it exceeds the image."""
    if leaves(image, centre, side):
        image, margin = continued(image)
        centre = centre + margin
    scale = pixels / side
    matrix = np.array([[scale, 0, pixels / 2 - scale * centre[0]], [0, scale, pixels / 2 - scale * centre[1]]])
    if scale < 0.7:
        image = cv2.GaussianBlur(image, (0, 0), 0.4 / scale)
    return warped(image, matrix, (pixels, pixels))


def misplaced(crop, rng):
    """Centre and side of a crop that misses its face: beside it, on the chest, a detail of it, or much too wide."""
    kind, angle = rng.random(), rng.uniform(0, 2 * np.pi)
    side, away = crop[2] * np.exp(rng.uniform(-0.3, 0.3)), 0.15
    if kind < 0.45:
        away = rng.uniform(0.5, 1.1)
    elif kind < 0.6:
        away, angle = rng.uniform(0.9, 1.6), np.pi / 2 + rng.normal(0, 0.4)
    else:
        side = crop[2] * (rng.uniform(0.2, 0.45) if kind < 0.8 else rng.uniform(2.2, 3.5))
        away = rng.uniform(0, 0.3)
    return crop[:2] + away * crop[2] * np.array([np.cos(angle), np.sin(angle)]), side


def blurred(face):
    """Whether a window has too little detail for reliable labels."""
    grey = cv2.cvtColor(cv2.resize(face, (BASENET.window,) * 2, interpolation=cv2.INTER_AREA), cv2.COLOR_RGB2GRAY)
    middle = slice(BASENET.window // 4, -(BASENET.window // 4))
    return cv2.Laplacian(grey, cv2.CV_32F)[middle, middle].var() < BLURRED * grey[middle, middle].var()


def write_split(split, framing, out):
    found, pixels = Portraits(split), framing.window
    out.mkdir(parents=True, exist_ok=True)
    images = np.empty((len(found), pixels, pixels, 3), np.uint8)
    scale = framing.pixels_per_window(found.crops[:, 2])
    trust = found.labels.trust.copy()
    for i in tqdm(range(len(found)), desc=out.name, mininterval=5):
        images[i] = window(found.image(i), found.crops[i, :2], pixels / scale[i], pixels)
        if blurred(images[i]):
            trust[i] = min(trust[i], GUESSED)
    landmarks = (found.points - found.crops[:, None, :2]) * scale[:, None, None] + pixels / 2
    middle = np.full(len(found), pixels / 2, np.float32)
    crop = np.stack([middle, middle, found.crops[:, 2] * scale, found.crops[:, 3]], 1)
    with whole(out / "images.npy") as file:
        np.save(file, images)
    with whole(out / "labels.npz") as file:
        np.savez(file, landmarks=landmarks.astype(np.float32), crop=crop.astype(np.float32), name=found.names,
                 trust=trust)


def write_misplaced(path, each=2, seed=3):
    found, rng = Portraits("train"), np.random.default_rng(seed)
    images = np.empty((each * len(found), BASENET.window, BASENET.window, 3), np.uint8)
    for i in tqdm(range(len(found)), desc="misplaced", mininterval=5):
        picture = found.image(i)
        for k in range(each):
            centre, side = misplaced(found.crops[i], rng)
            images[each * i + k] = window(picture, centre, BASENET.window_crops * side)
    with whole(path) as file:
        np.save(file, images)


def main():
    for framing in FRAMINGS.values():
        for split in ("train", "val", "test"):
            write_split(split, framing, cache() / "faces" / framing.folder(split))
    write_misplaced(cache() / "faces/misplaced.npy")


if __name__ == "__main__":
    main()
