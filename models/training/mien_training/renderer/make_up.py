"""Make-up: lips, eyelids and cheeks in colour, as opacities on the face tile, drawn around the landmarks of the rig."""
from dataclasses import dataclass

import cv2
import numpy as np

from mien_training.paths import cache

TILE = 512
REGIONS = ("lips", "lids", "liner", "cheeks")
# Corners of the rig's 68 landmarks (iBUG): both lips around the mouth, lids, and the skin above them.
OUTER_LIPS, INNER_LIPS = range(48, 60), range(60, 68)
EYES = (range(36, 42), range(42, 48))
BROWS = (range(17, 22), range(22, 27))
CHEEKS = ((2, 31, 41), (14, 35, 46))  # of the oval, the nose and the eye: a cheek is between them
PROBABILITY = {"female": 0.55, "male": 0.03}  # of wearing any


@dataclass
class MakeUp:
    region: str
    colour: np.ndarray   # linear [3]
    opacity: float


def sample(rng, sex):
    """Make-up of a person: none, some or all of it."""
    if rng.random() >= PROBABILITY[sex]:
        return []
    red = np.array([rng.uniform(0.15, 0.55), rng.uniform(0.01, 0.15), rng.uniform(0.02, 0.18)])
    any_colour = lambda high: rng.uniform(0.01, high) * np.exp(rng.normal(0, 0.5, 3))
    wanted = [("lips", red, rng.uniform(0.3, 0.95), 0.8), ("lids", any_colour(0.3), rng.uniform(0.1, 0.6), 0.5),
              ("liner", np.full(3, 0.01), rng.uniform(0.3, 0.9), 0.5), ("cheeks", red * [1, 1.5, 1.2],
                                                                        rng.uniform(0.05, 0.3), 0.5)]
    return [MakeUp(region, np.clip(colour, 0, 0.8), opacity) for region, colour, opacity, share in wanted
            if rng.random() < share]


def tile_points(rig):
    """Pixels of the 68 landmarks on the face tile, [68,2]."""
    a, b = rig.materials["M_Face"]
    first = np.full(len(rig.neutral), -1)
    first[rig.corner_position[a:b].ravel()] = rig.corner_uv[a:b].ravel()
    assert (first[rig.ibug68] >= 0).all(), "a landmark is not on the face tile"
    uv = rig.uv[first[rig.ibug68]]
    return np.stack([uv[:, 0], 1 - uv[:, 1]], 1) * TILE


def filled(*outlines):
    """The inside of outlines by the even-odd rule."""
    mask = np.zeros((TILE, TILE), np.uint8)
    cv2.fillPoly(mask, [np.int32(np.round(np.asarray(o) * 16)) for o in outlines], 255, cv2.LINE_AA, 4)
    return mask


def soft(mask, pixels):
    return cv2.GaussianBlur(mask, (0, 0), pixels)


def draw(points):
    """Opacities uint8 [TILE,TILE] of every region."""
    eye_width = np.linalg.norm(points[39] - points[36])
    lids, liner, cheeks = (np.zeros((TILE, TILE), np.uint8) for _ in range(3))
    for eye, brow in zip(EYES, BROWS):
        upper, lower = points[list(eye)[:4]], points[[eye[0], eye[5], eye[4], eye[3]]]
        above = upper + 0.55 * (np.linspace(points[brow[0]], points[brow[-1]], 4) - upper)
        lids |= filled(np.concatenate([upper, above[::-1]]))
        for line in (upper, lower):
            cv2.polylines(liner, [np.int32(np.round(line * 16))], False, 255, max(1, int(0.06 * eye_width)),
                          cv2.LINE_AA, 4)
    for corners in CHEEKS:
        centre = tuple(int(v) for v in points[list(corners)].mean(0))
        cv2.ellipse(cheeks, centre, (int(0.55 * eye_width), int(0.4 * eye_width)), 0, 0, 360, 255, -1)
    lips = filled(points[list(OUTER_LIPS)], points[list(INNER_LIPS)])
    return {"lips": soft(lips, 1.2), "lids": soft(lids, 0.1 * eye_width), "liner": soft(liner, 1),
            "cheeks": soft(cheeks, 0.3 * eye_width)}


def pictures(rig):
    """Files of the regions' opacities, drawn once and kept."""
    folder = cache() / f"make_up_{TILE}"
    if not all((folder / f"{region}.png").exists() for region in REGIONS):
        folder.mkdir(parents=True, exist_ok=True)
        for region, mask in draw(tile_points(rig)).items():
            cv2.imwrite(str(folder / f"{region}.png"), mask)
    return {region: folder / f"{region}.png" for region in REGIONS}
