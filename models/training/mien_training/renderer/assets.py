"""Assets of looks: names by split, images and meshes of the rig pack, skins from portraits.

Skins, hair styles and environments of val and test never occur in train. Skins of portraits are for train only; their
name is <skin of the pack>+<portrait>, and they continue with that skin where the photograph ends.
"""
import functools
import json
import re
import sys

import numpy as np
from PIL import Image

from mien_training.data import portrait_labels
from mien_training.paths import cache, data

HELD_OUT = {
    "skins": {"old_light_male", "old_light_female2", "mid_dark_male", "mid_light_female2", "young_light_female3"},
    "hair": {"short02", "short02_mirror", "ponytail01", "ponytail01_mirror"},
    "environments": {"brown_photostudio_06", "forest_slope", "lab", "st_fagans_interior", "venice_sunset", "workshop"},
}


def pack(*parts):
    return data().joinpath("rig", *parts)


@functools.lru_cache
def skin_table():
    return json.loads(pack("skins/skins.json").read_text())


@functools.lru_cache
def portrait_skins():
    """Names by the group of their portraits; empty before portrait_skins.py has run."""
    found = sorted(p.stem for p in (cache() / "portrait_skins").glob("*+*.jpg"))
    groups, out = portrait_labels.of_names(name.partition("+")[2] + ".jpg" for name in found).group, {}
    for name, group in zip(found, groups):
        out.setdefault(re.sub("^GRID.*", "GRID", group), []).append(name)
    return out


def note_missing_skins(split):
    """Prints a note if training people have only the few skins of the pack, from which decoders learn less."""
    if split == "train" and not portrait_skins():
        print("note: no skins of portraits in the cache, so all people have a skin of the rig's pack; "
              "mien_training.renderer.portrait_fit and portrait_skins create them", file=sys.stderr, flush=True)


def skin_file(name, tile):
    """Image of a skin on the tile `face` or `back`."""
    of_pack, _, portrait = name.partition("+")
    if portrait and tile == "face":
        return cache() / "portrait_skins" / f"{name}.jpg"
    return pack("skins", f"{of_pack}_{tile}.jpg")


@functools.lru_cache
def names(kind, split="train"):
    """Names a split may use of skins, hair, environments, brows, beards, glasses, hats or irises."""
    patterns = {"skins": pack("skins").glob("*_face.jpg"), "hair": pack("hair").glob("*.npz"),
                "environments": (data() / "environments").glob("*.hdr"), "irises": pack("eyes").glob("iris_*.jpg"),
                "brows": pack("brows").glob("*.png"), "beards": pack("beards").glob("*.png"),
                "glasses": pack("glasses").glob("*.npz"), "hats": pack("hats").glob("*.npz")}
    found = sorted(p.stem.removesuffix("_face") for p in patterns[kind])
    held_out = HELD_OUT.get(kind)
    if held_out is None:
        return found
    return [n for n in found if (n in held_out) == (split != "train")]


def picture(path):
    """uint8 [height,width,4] RGBA; a grey image fills red, green and blue."""
    return np.array(Image.open(path).convert("RGBA"))


@functools.lru_cache
def environment_picture(name):
    return np.array(Image.open(data() / "environments" / f"{name}.jpg").convert("RGB"))


@functools.lru_cache
def overlay_rectangle(kind):
    """(u0,v0,u1,v1) of the face tile that brows or beards cover."""
    table = json.loads(pack(kind, f"{kind}.json").read_text())
    x0, y0, x1, y1 = (q / table["tile_size"] for q in table["rect_xyxy"])
    return x0, 1 - y1, x1, 1 - y0


class Worn:
    """Hair, a hat or glasses: a mesh that follows a head at rest."""

    def __init__(self, kind, name):
        table = np.load(pack(kind, f"{name}.npz"), allow_pickle=True)
        self.table = {k: table[k] for k in table.files}
        self.vertices = self.table["v"].astype(np.float32)
        faces = self.table["f"].astype(np.int32)
        if "part" in self.table:
            faces = faces[np.argsort(self.table["part"], kind="stable")]
            self.frame_count = int((self.table["part"] == 0).sum())
        self.corners = np.ascontiguousarray(faces)
        self.uv = self.table.get("uv", np.zeros((len(self.vertices), 2))).astype(np.float32)

    def fit(self, neutral, head):
        """Vertices on `head`, an identity without expression [26719,3]; `neutral` is the mean head."""
        if "anchor" in self.table:
            change = (head - neutral)[self.table["anchor"]]
            return self.vertices + np.einsum("nk,nkc->nc", self.table["anchor_w"].astype(np.float32), change)
        return np.float32(self.fit_rigid(neutral, head))

    def fit_rigid(self, neutral, head):
        """Glasses: scaled along the axes, carried by the bridge of the nose and the temples."""
        nose0, left0, right0 = (neutral[self.table[k]].mean(0) for k in ("anchor_nose", "anchor_left", "anchor_right"))
        nose1, left1, right1 = (head[self.table[k]].mean(0) for k in ("anchor_nose", "anchor_left", "anchor_right"))
        ear0, ear1 = (left0 + right0) / 2, (left1 + right1) / 2
        width = (left1[0] - right1[0]) / (left0[0] - right0[0])
        length = (nose1[2] - ear1[2]) / (nose0[2] - ear0[2])
        out = (self.vertices - nose0) * [width, (width + length) / 2, length]
        drop = ((ear1 - nose1) - (ear0 - nose0) * [1, 1, length])[1] / (nose1[2] - ear1[2])
        out[:, 1] += drop * np.clip(-out[:, 2], 0, None)
        return out + nose1


@functools.lru_cache
def worn(kind, name):
    return Worn(kind, name)
