"""Skin tone of a face in an image: the individual typology angle of its cheeks (Chardon, Cretois, Hourseau 1991).

ITA = arctan((L* - 50) / b*), degrees, of CIE L*a*b*. It is defined for skin under a known light; in images it depends
on light and camera, so groups are groups of images, not of people. Black and white images have none.
"""
import cv2
import numpy as np

from mien_training.data import landmark_points as lp

# Lower bounds, degrees; the names are those of Chardon et al., "dark" below the last as by Del Bino and Bernerd (2013).
GROUPS = {"very light": 55, "light": 41, "intermediate": 28, "tan": 10, "brown": -30, "dark": -90}
NO_TONE = "black and white"
GREY = 5.0  # of chroma, below which an image counts as without colour


def cheeks(picture, points):
    """Median colour f32 [2,3] (RGB 0..1) of each cheek of an image uint8 [h,w,3]; points [175,2] in pixels."""
    colours = []
    for side in lp.CHEEK:
        mask = np.zeros(picture.shape[:2], np.uint8)
        corners = np.round(points[[lp.POSITION[k] for k in side]]).astype(np.int32)
        cv2.fillConvexPoly(mask, cv2.convexHull(corners), 1)
        if mask.any():
            colours.append(np.median(picture[mask > 0], 0))
    return np.float32(colours) / 255


def angle(colours):
    """Mean ITA of colours f32 [n,3]; NaN without colour."""
    if not len(colours):
        return float("nan")
    lightness, a, b = cv2.cvtColor(np.float32(colours)[None], cv2.COLOR_RGB2LAB)[0].mean(0)
    return float(np.degrees(np.arctan2(lightness - 50, b))) if b > 0 and np.hypot(a, b) >= GREY else float("nan")


def group(ita):
    return NO_TONE if not np.isfinite(ita) else next(name for name, least in GROUPS.items() if ita >= least)
