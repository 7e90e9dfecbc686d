"""Windows for the face proposal: 24x24 images with or without a box.

The box of a face is the upright square of its crop (centre, side). A window is a square as well. It is positive if it
overlaps a box well, a part if it overlaps somewhat (it then teaches the regression only), otherwise negative.
Regression targets are (dx, dy, dlog): shift of the centre in window sides, log of box side over window side.
"""
import numpy as np
from PIL import Image

POSITIVE, PART, NEGATIVE = 1, 2, 0
WINDOW = 24


def iou(windows, box):
    """Overlap of squares [n,3] (cx,cy,side) with one square [3]."""
    half_w, half_b = windows[:, 2:] / 2, box[2] / 2
    low = np.maximum(windows[:, :2] - half_w, box[:2] - half_b)
    high = np.minimum(windows[:, :2] + half_w, box[:2] + half_b)
    common = np.clip(high - low, 0, None).prod(1)
    return common / (windows[:, 2] ** 2 + box[2] ** 2 - common)


def regression(windows, box):
    return np.column_stack([(box[0] - windows[:, 0]) / windows[:, 2], (box[1] - windows[:, 1]) / windows[:, 2],
                            np.log(box[2] / windows[:, 2])]).astype(np.float32)


def kinds(overlap):
    """POSITIVE, PART or NEGATIVE for each overlap; -1 if it is ambiguous."""
    return np.select([overlap >= 0.62, overlap >= 0.4, overlap < 0.28], [POSITIVE, PART, NEGATIVE], -1)


def cut(image, windows):
    """Windows of a uint8 [h,w,3] image, area-averaged to 24x24; outside the image it is black, as in the canvas."""
    picture = Image.fromarray(image)
    out = np.empty((len(windows), WINDOW, WINDOW, 3), np.uint8)
    for i, (cx, cy, side) in enumerate(windows):
        square = (round(cx - side / 2), round(cy - side / 2), round(cx + side / 2), round(cy + side / 2))
        out[i] = np.asarray(picture.crop(square).resize((WINDOW, WINDOW), Image.BOX if side > 36 else Image.BILINEAR))
    return out


def near(rng, box, count):
    """Random windows around a box: shifted by a few percent to a third of its size."""
    spread = rng.choice([0.06, 0.15, 0.35], (count, 1))
    shift = rng.uniform(-1, 1, (count, 2)) * spread
    side = box[2] * np.exp(rng.uniform(-1, 1, (count, 1)) * np.minimum(spread * 2, 0.5))
    return np.hstack([box[:2] + shift * box[2], side])


def anywhere(rng, size_wh, count, smallest=16):
    width, height = size_wh
    largest = max(min(width, height), smallest + 1)
    side = np.exp(rng.uniform(np.log(smallest), np.log(largest), (count, 1)))
    return np.hstack([rng.uniform(0, 1, (count, 2)) * [width, height], side])


def windows_of_face(rng, image, box, around=14, negatives=10):
    """Cut windows, kinds and regression targets of one image with one face."""
    size_wh = image.shape[1::-1]
    windows = np.vstack([near(rng, box, around), anywhere(rng, size_wh, negatives)])
    overlap = iou(windows, box)
    kind = kinds(overlap)
    # A tiny window inside the face overlaps little and shows only skin, so it is a valid negative.
    keep = kind >= 0
    return cut(image, windows[keep]), kind[keep].astype(np.int8), regression(windows[keep], box)


def windows_of_background(rng, image, count):
    windows = anywhere(rng, image.shape[1::-1], count)
    return cut(image, windows), np.zeros(count, np.int8), np.zeros((count, 3), np.float32)
