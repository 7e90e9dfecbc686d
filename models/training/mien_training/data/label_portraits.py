"""Labels portraits with the teacher, six times each: the mean is the label, and the scatter lowers its weight.

usage: python3 -m mien_training.data.label_portraits PACK [--splits SPLIT...]
Needs PyPI's mediapipe, and for a pack of names only, $MIEN_DATA/PACK/faces.npz, the images in $MIEN_CACHE/PACK/img.
Writes $MIEN_CACHE/PACK/labels.npz, which replaces the pack's own labels, with the same fields, and landmark_scatter
[n], the mean distance of the views' landmarks from their mean as a share of the distance between the pupils,
control_scatter [n,52], and views [n], of six, in which the teacher found a face. Keeps what an earlier run
labelled; a face needs at least three views that agree.
"""
import argparse
import time
import zlib

import cv2
import numpy as np
from scipy.spatial.transform import Rotation
from tqdm import tqdm

from mien_convert.atomic_files import whole
from mien_training.data import landmark_points as lp
from mien_training.data import portrait_labels
from mien_training.data.expressions import CONTROLS, MIRROR
from mien_training.data.image_border import continued, warped
from mien_training.paths import cache, data

VIEWS = 6
MIN_VIEWS = 3
MAX_SCATTER = 0.15  # of landmarks; beyond, the views show different faces
BORDER = 0.25     # of blurred image on each side, as a share of the height: many portraits are tight
PUPILS = (lp.POSITION[468], lp.POSITION[473])
FLIP = np.diag([-1.0, 1, 1])


def view(rng, mirrored, size):
    """An affine map [2,3] from the image to a view of it, of the same size, and its angle in radians."""
    angle = 0 if mirrored else np.radians(rng.uniform(-7, 7))
    scale = rng.uniform(0.93, 1.07)
    turn = scale * np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    middle = size / 2
    offset = middle + rng.uniform(-0.02, 0.02, 2) * size - turn @ middle
    if mirrored:
        turn, offset = np.diag([-1.0, 1]) @ turn, np.array([size[0] - offset[0], offset[1]])
    return np.column_stack([turn, offset]), angle


def answers(ask, picture, rng):
    """The answer for each view with a face: landmarks [175,2] in pixels of the image, controls [52], matrix [4,4]."""
    wide, margin = continued(picture, BORDER)
    size = np.array(wide.shape[1::-1], float)
    found = []
    for k in range(VIEWS):
        mirrored = k % 2 == 1
        matrix, angle = view(rng, mirrored, size)
        answer = ask(warped(wide, matrix, wide.shape[1::-1]))
        if answer is None:
            continue
        points, controls, pose = answer
        points = (points * size - matrix[:, 2]) @ np.linalg.inv(matrix[:, :2]).T - margin
        if mirrored:
            points, controls = points[lp.MIRROR], controls[MIRROR]
            pose[:3, :3] = FLIP @ pose[:3, :3] @ FLIP
            pose[0, 3] *= -1
        roll = np.array([[np.cos(angle), np.sin(angle), 0], [-np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
        pose[:3] = roll.T @ pose[:3]
        found.append((points, controls, pose))
    return found


def label(found, size, height_of_view):
    """Means and scatters of the labels of one image, whose camera has a narrower field of view than the views'."""
    points, controls, poses = (np.stack(values) for values in zip(*found))
    mean = points.mean(0)
    pupils = np.linalg.norm(mean[PUPILS[0]] - mean[PUPILS[1]])
    matrix = np.eye(4)
    matrix[:3, :3] = Rotation.from_matrix(poses[:, :3, :3]).mean().as_matrix()
    matrix[:3, 3] = poses[:, :3, 3].mean(0) * [1, 1, size[1] / height_of_view]
    return {"landmarks": np.float32(mean / size), "blendshapes": np.float32(controls.mean(0)),
            "matrix_colmajor": np.float32(matrix.T.ravel()), "size_wh": np.float32(size),
            "landmark_scatter": np.float32(np.linalg.norm(points - mean, axis=2).mean() / max(pupils, 1)),
            "control_scatter": np.float32(controls.std(0)), "views": np.int32(len(found))}


def teacher():
    """ask(RGB uint8 [h,w,3]) -> landmarks [175,2] as shares of the sides, controls [52], matrix [4,4]; or None."""
    import mediapipe as mp
    from mediapipe.tasks.python import BaseOptions, vision
    task = str(data() / "teacher/face_landmarker.task")
    landmarker = vision.FaceLandmarker.create_from_options(vision.FaceLandmarkerOptions(
        base_options=BaseOptions(model_asset_path=task), output_face_blendshapes=True,
        output_facial_transformation_matrixes=True))

    def ask(picture):
        result = landmarker.detect(mp.Image(image_format=mp.ImageFormat.SRGB, data=np.ascontiguousarray(picture)))
        if not result.face_landmarks:
            return None
        by_name = {c.category_name: c.score for c in result.face_blendshapes[0]}
        return (np.array([(result.face_landmarks[0][k].x, result.face_landmarks[0][k].y) for k in lp.TEACHER]),
                np.array([by_name.get(c, 0.0) for c in CONTROLS]),
                np.array(result.facial_transformation_matrixes[0], float))
    return ask


def save(path, rows, table):
    names = sorted(rows)
    place = {str(name): i for i, name in enumerate(table["name"])}
    picked = [place[name] for name in names]
    columns = {field: np.stack([rows[name][field] for name in names]) for field in rows[names[0]]}
    kept = {field: table[field][picked] for field in ("group", "age", "sex", "kind") if field in table}
    with whole(path) as file:
        np.savez(file, name=np.array(names), blendshape_names=np.array(CONTROLS), **kept, **columns)


def portraits_of(pack):
    """The table of a pack's names, with its own labels where it has some."""
    named = data() / pack / "faces.npz"
    return np.load(named if named.exists() else data() / pack / "labels.npz")


def names_of(table, splits):
    """The portraits of some splits, without those in which the pack's authors found no face."""
    names, groups = table["name"].astype(str), portrait_labels.groups(table)
    faces = table["kind"] != "unlabelled" if "kind" in table else np.full(len(names), True)
    return [str(name) for name, group, face in zip(names, groups, faces)
            if face and portrait_labels.split_of(name, group) in splits]


def load(path):
    if not path.exists():
        return {}
    table = np.load(path)
    fields = ("landmarks", "blendshapes", "matrix_colmajor", "size_wh", "landmark_scatter", "control_scatter", "views")
    columns = {field: table[field] for field in fields}
    return {str(name): {f: columns[f][i] for f in fields} for i, name in enumerate(table["name"])}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pack")
    parser.add_argument("--splits", nargs="*", default=["train", "val", "test"])
    options = parser.parse_args()
    folder, images = cache() / options.pack, portrait_labels.folder(options.pack) / "img"
    table = portraits_of(options.pack)
    rows = load(folder / "labels.npz")
    asked = [name for name in names_of(table, options.splits) if name not in rows]
    folder.mkdir(parents=True, exist_ok=True)
    ask, saved = teacher(), time.time()
    for name in tqdm(asked, mininterval=10):
        if time.time() - saved > 120:
            save(folder / "labels.npz", rows, table)
            saved = time.time()
        picture = cv2.imread(str(images / name))[..., ::-1]
        found = answers(ask, picture, np.random.default_rng(zlib.crc32(name.encode())))
        if len(found) < MIN_VIEWS:
            continue
        row = label(found, np.array(picture.shape[1::-1]), (1 + 2 * BORDER) * picture.shape[0])
        if row["landmark_scatter"] < MAX_SCATTER:
            rows[name] = row
    save(folder / "labels.npz", rows, table)


if __name__ == "__main__":
    main()
