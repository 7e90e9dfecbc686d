"""Portraits of the packs `faces`, `faces_wild` and `faces_more`: the teacher's labels, and splits.

`faces_more` names images of a public data set; $MIEN_CACHE/faces_more has them and their labels. Labels of
label_portraits.py, which are averages, replace those of the packs.

A hash of the name holds out 12 % for test and 5 % for validation; of GRID, whose frames show few people, by speaker.
People who are held out under another name are not used for training (portrait_duplicates.py).
"""
import functools
import hashlib
from dataclasses import dataclass

import numpy as np

from mien_training.data import landmark_points as lp
from mien_training.data import portrait_duplicates
from mien_training.data.expressions import CONTROLS
from mien_training.paths import cache, data

PACKS = ("faces", "faces_wild", "faces_more")
VALIDATION_SPEAKERS = ("GRID s5",)  # also in the clips of the evaluation
GREY_GROUP = "members of Congress"   # group of the first pack's photographs
NEAR_PROFILE = np.radians(38)        # yaw beyond which the teacher guesses half of a face
USUAL_SCATTER = 0.025  # of the landmarks of a portrait, as a share of the distance between the pupils


@dataclass(frozen=True)
class Labels:
    name: np.ndarray         # str [n], of the image file
    pack: np.ndarray         # str [n]
    group: np.ndarray        # str [n]: ethnic group of FairFace, GRID's speaker, or where the image comes from
    age: np.ndarray          # str [n], a range of years, '' where unknown
    sex: np.ndarray          # str [n], '' where unknown
    size_wh: np.ndarray      # f32 [n,2] pixels
    points: np.ndarray       # f32 [n,175,2] pixels
    controls: np.ndarray     # f32 [n,52]; 0 where the teacher has none
    rotation: np.ndarray     # f32 [n,3,3], camera space
    translation: np.ndarray  # f32 [n,3] metres
    trust: np.ndarray        # f32 [n] weight of landmarks, from the scatter of the labels; 1 for a single label
    control_trust: np.ndarray  # f32 [n,52], weight of controls

    def of(self, rows):
        return Labels(*(getattr(self, field)[rows] for field in self.__dataclass_fields__))

    def __len__(self):
        return len(self.name)

    def path(self, i):
        return folder(str(self.pack[i])) / "img" / str(self.name[i])

    def yaw(self):
        """f32 [n] radians, without a sign."""
        return np.abs(np.arctan2(self.rotation[:, 0, 2], self.rotation[:, 2, 2]))

    def near_profile(self):
        """bool [n]: heads turned so far that half of the labels are guesses."""
        return self.yaw() > NEAR_PROFILE


def split_of(name, group=""):
    if group.startswith("GRID"):
        return "val" if group in VALIDATION_SPEAKERS else "train"
    share = int(hashlib.sha256(str(name).encode()).hexdigest()[:8], 16) / 2 ** 32
    return "test" if share < 0.12 else "val" if share < 0.17 else "train"


def groups(table):
    if "group" in table:
        return [str(g) or str(n).partition("_")[0] for g, n in zip(table["group"], table["name"])]
    return [GREY_GROUP if str(n).startswith("vv_") else "cc0" for n in table["name"]]


def controls(table):
    known = {str(name): column for column, name in enumerate(table["blendshape_names"])}
    found = table["blendshapes"].astype(np.float32)
    return np.stack([found[:, known[c]] if c in known else np.zeros(len(found), np.float32) for c in CONTROLS], 1)


def folder(pack):
    return data() / pack if (data() / pack / "labels.npz").exists() else cache() / pack


def trust(table, controls):
    """Weights of landmarks [n] and controls [n,52], lower for a larger scatter of the labels."""
    if "control_scatter" not in table:
        return np.ones(len(controls), np.float32), np.ones_like(controls)
    variance = controls.var(0) + 1e-6
    return (np.minimum(1, USUAL_SCATTER / table["landmark_scatter"]).astype(np.float32),
            (variance / (variance + table["control_scatter"] ** 2)).astype(np.float32))


def read(path, pack):
    table = np.load(path)
    size = table["size_wh"].astype(np.float32)
    matrix = table["matrix_colmajor"].reshape(-1, 4, 4).transpose(0, 2, 1).astype(np.float32)
    unknown = np.full(len(size), "")
    age, sex = (table[key].astype(str) if key in table else unknown for key in ("age", "sex"))
    points, found = table["landmarks"][..., :2].astype(np.float32), controls(table)
    points = points if points.shape[1] == len(lp.TEACHER) else points[:, lp.TEACHER]
    return Labels(table["name"].astype(str), np.full(len(size), pack), np.array(groups(table)), age, sex, size,
                  points * size[:, None], found, matrix[:, :3, :3], matrix[:, :3, 3] / 100, *trust(table, found))


def none():
    text, numbers = np.zeros(0, str), lambda *shape: np.zeros((0, *shape), np.float32)
    return Labels(*[text] * 5, numbers(2), numbers(len(lp.TEACHER), 2), numbers(len(CONTROLS)), numbers(3, 3),
                  numbers(3), numbers(), numbers(len(CONTROLS)))


def joined(parts):
    return Labels(*(np.concatenate([getattr(p, field) for p in parts]) for field in Labels.__dataclass_fields__))


def of_pack(pack):
    """The labels of a pack: averages first, and the pack's own for portraits without."""
    found = joined([none()] + [read(folder / pack / "labels.npz", pack) for folder in (data(), cache())
                               if (folder / pack / "labels.npz").exists()])
    last = {name: row for row, name in enumerate(found.name)}  # in the order of the pack
    return found.of(np.array(list(last.values()), int))


@functools.lru_cache
def every():
    return joined([none()] + [of_pack(pack) for pack in PACKS])


def of_split(split, packs=PACKS):
    labels = every()
    belongs = np.array([split_of(name, group) for name, group in zip(labels.name, labels.group)], str)
    chosen = (belongs == split) & np.isin(labels.pack, packs)
    if split == "train" and len(labels):
        chosen &= ~np.isin(labels.name, list(portrait_duplicates.twins(labels, belongs)))
    return labels.of(np.flatnonzero(chosen))


def of_names(names):
    labels = every()
    row = {name: i for i, name in enumerate(labels.name)}
    return labels.of([row[str(name)] for name in names])
