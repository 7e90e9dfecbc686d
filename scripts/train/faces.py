#!/usr/bin/env python3
"""The real portraits: split, boxes, and a cache of face windows like those the renderer writes.

usage: faces.py      writes $MIEN_CACHE/faces/<split>[_hifinet]/{images.npy,labels.npz}: images uint8 [n,window,window,3], a
square around the crop's centre (framing.py); landmarks [n,175,2] and crop [n,4] (cx, cy, side, theta) in pixels of that window.
And misplaced.npy, uint8 [2n,112,112,3]: windows of the training portraits that the tracker must not take for a face in place.
"""
import hashlib

import cv2
import numpy as np
import torch
from tqdm import tqdm

import landmark_points as lp
from expressions import CONTROLS
from paths import cache, data
from framing import BASENET, FRAMINGS
from sequences import fit_crop, template


TEACHER_FOV = np.radians(63)  # vertical, of the camera that MediaPipe takes for granted (face_geometry)


def split_of(name):
    """Held out by a hash of the name: 12 % test, 5 % val."""
    share = int(hashlib.sha256(str(name).encode()).hexdigest()[:8], 16) / 2 ** 32
    return "test" if share < 0.12 else "val" if share < 0.17 else "train"


class Portraits:
    """(picture uint8 [h,w,3], box (cx, cy, side)) of one split."""

    def __init__(self, split):
        labels = np.load(data() / "faces/labels.npz")
        self.rows = [i for i, name in enumerate(labels["name"]) if split_of(name) == split]
        self.names, self.size_wh = labels["name"][self.rows], labels["size_wh"][self.rows].astype(np.float32)
        self.points = (labels["landmarks"][self.rows][:, lp.TEACHER, :2] * self.size_wh[:, None]).astype(np.float32)
        self.crops = fit_crop(template(), torch.from_numpy(self.points)).numpy()

    def __len__(self):
        return len(self.names)

    def image(self, i):
        return cv2.imread(str(data() / "faces/img" / str(self.names[i])))[..., ::-1]

    def __getitem__(self, i):
        if i >= len(self):
            raise IndexError
        return np.ascontiguousarray(self.image(i)), self.crops[i, :3]


def teacher_labels(names):
    """What the teacher says, and in which of its rows it speaks of these portraits."""
    labels = np.load(data() / "faces/labels.npz")
    row = {str(name): i for i, name in enumerate(labels["name"])}
    return labels, [row[str(name)] for name in names]


def teacher_controls(names):
    """The teacher's controls f32 [n,52] of portraits; 0 where it has none."""
    labels, rows = teacher_labels(names)
    known = [str(name) for name in labels["blendshape_names"]]
    out = np.zeros((len(rows), len(CONTROLS)), np.float32)
    for i, control in enumerate(CONTROLS):
        if control in known:
            out[:, i] = labels["blendshapes"][rows, known.index(control)]
    return out


def teacher_poses(names):
    """The teacher's head poses in camera space of portraits: rotation f32 [n,3,3], translation f32 [n,3] (metres)."""
    labels, rows = teacher_labels(names)
    matrix = labels["matrix_colmajor"][rows].reshape(-1, 4, 4).transpose(0, 2, 1)
    return matrix[:, :3, :3].astype(np.float32), matrix[:, :3, 3].astype(np.float32) / 100


def camera_labels(found, framing):
    """Where Portraits are in front of which camera, the teacher's word: tensors as of a rendered shard."""
    rotation, translation = teacher_poses(found.names)
    window = np.concatenate([found.crops[:, :2], framing.window_crops * found.crops[:, 2:3]], 1)
    labels = {"rotation": rotation, "translation": translation, "f_px": found.size_wh[:, 1] / 2 / np.tan(TEACHER_FOV / 2),
              "camera_wh": found.size_wh, "window": window}
    return {name: torch.from_numpy(np.float32(value)) for name, value in labels.items()}


def portraits(split):
    return Portraits(split)


def window(image, centre, side, pixels=BASENET.window):
    """A square of the picture as [pixels,pixels,3]; the border is repeated outwards."""
    scale = pixels / side
    matrix = np.array([[scale, 0, pixels / 2 - scale * centre[0]], [0, scale, pixels / 2 - scale * centre[1]]])
    matrix[:, 2] += scale * 0.5 - 0.5  # OpenCV puts pixel centres at whole numbers
    if scale < 0.7:
        image = cv2.GaussianBlur(image, (0, 0), 0.4 / scale)
    return cv2.warpAffine(image, matrix, (pixels, pixels), flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)


def misplaced(crop, rng):
    """Centre and side of a crop that misses its face: beside it, on the chest, a detail of it, or far too wide."""
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


def write_split(split, framing, out):
    found, pixels = portraits(split), framing.window
    out.mkdir(parents=True, exist_ok=True)
    images = np.empty((len(found), pixels, pixels, 3), np.uint8)
    scale = framing.pixels_per_window(found.crops[:, 2])
    for i in tqdm(range(len(found)), desc=out.name):
        images[i] = window(found.image(i), found.crops[i, :2], pixels / scale[i], pixels)
    landmarks = (found.points - found.crops[:, None, :2]) * scale[:, None, None] + pixels / 2
    middle = np.full(len(found), pixels / 2, np.float32)
    crop = np.stack([middle, middle, found.crops[:, 2] * scale, found.crops[:, 3]], 1)
    np.save(out / "images.npy", images)
    np.savez(out / "labels.npz", landmarks=landmarks.astype(np.float32), crop=crop.astype(np.float32), name=found.names)


def write_misplaced(path, each=2, seed=3):
    found, rng = portraits("train"), np.random.default_rng(seed)
    images = np.empty((each * len(found), BASENET.window, BASENET.window, 3), np.uint8)
    for i in tqdm(range(len(found)), desc="misplaced"):
        picture = found.image(i)
        for k in range(each):
            centre, side = misplaced(found.crops[i], rng)
            images[each * i + k] = window(picture, centre, BASENET.window_crops * side)
    np.save(path, images)


def main():
    for framing in FRAMINGS.values():
        for split in ("train", "val", "test"):
            write_split(split, framing, cache() / "faces" / framing.folder(split))
    write_misplaced(cache() / "faces/misplaced.npy")


if __name__ == "__main__":
    main()
