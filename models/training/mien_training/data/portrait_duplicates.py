"""Training portraits of held-out people: the same photograph under another name, or a person of the evaluation clips.

Members of Congress who change party or office get a second number with the same photograph, and some generated faces
differ only by their expression. The search compares small images of the faces once; $MIEN_CACHE/faces keeps the result.
"""
import cv2
import numpy as np

from mien_convert.atomic_files import whole
from mien_training.paths import cache

SIDE = 24      # pixels of the compared images
# correlation of two; of the 20 pairs above it between training and test portraits 19 show the same person to the eye
ALIKE = 0.96
CLIP_PORTRAITS = ("vv_040502.jpg", "vv_099911.jpg")  # who speaks in whitehouse_obama_weekly


def small(picture, points):
    """f32 [SIDE*SIDE]: a small grey image of the face, with mean 0 and norm 1."""
    low, high = points.min(0), points.max(0)
    side, centre = 1.1 * (high - low).max(), (low + high) / 2
    scale = SIDE / side
    soft = cv2.GaussianBlur(picture, (0, 0), max(0.5, 0.5 / scale))
    matrix = np.float32([[scale, 0, SIDE / 2 - scale * centre[0]], [0, scale, SIDE / 2 - scale * centre[1]]])
    face = cv2.warpAffine(soft, matrix, (SIDE, SIDE), borderMode=cv2.BORDER_REPLICATE).astype(np.float32).ravel()
    face -= face.mean()
    return face / (np.linalg.norm(face) + 1e-6)


def alike(faces, others):
    """bool [n]: which of `faces` [n,pixels] are duplicates of one of `others`."""
    return (faces @ others.T).max(1, initial=-1) > ALIKE


def twins(labels, split):
    """Names of training portraits to leave out; `split` [n] is the split of each of `labels`."""
    path = cache() / f"faces/twins_{len(labels)}.npy"
    if not path.exists():
        found = np.stack([small(cv2.imread(str(labels.path(i)), cv2.IMREAD_GRAYSCALE), labels.points[i])
                          for i in range(len(labels))])
        learned = np.flatnonzero(split == "train")
        chosen = learned[alike(found[learned], found[split != "train"])]
        path.parent.mkdir(parents=True, exist_ok=True)
        with whole(path) as out:
            np.save(out, labels.name[chosen])
    return {*np.load(path).tolist(), *CLIP_PORTRAITS}
