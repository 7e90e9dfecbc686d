#!/usr/bin/env python3
"""Skin tone of a face in a picture: the individual typology angle of its cheeks (Chardon, Cretois, Hourseau 1991).

ITA = arctan((L* - 50) / b*), degrees, of CIE L*a*b*. It was made for skin under a known light; in pictures the light and the camera's
colours move it, so groups are of pictures, not of people. A black and white picture has none.
"""
import cv2
import numpy as np

import landmark_points as lp

# Lower bounds, degrees; the names are those of Chardon et al., "dark" below the last as by Del Bino and Bernerd (2013).
GROUPS = {"very light": 55, "light": 41, "intermediate": 28, "tan": 10, "brown": -30, "dark": -90}
NO_TONE = "black and white"
GREY = 5.0  # of chroma, below which a picture counts as without colour


def cheeks(picture, points):
    """Median colour f32 [2,3] (RGB 0..1) of each cheek of a picture uint8 [h,w,3]; points [175,2] in pixels."""
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


def self_test():
    of = lambda *rgb: group(angle(np.float32([rgb]) / 255))
    assert of(128, 128, 128) == NO_TONE and group(angle([])) == NO_TONE
    assert of(245, 220, 200) == "very light" and of(200, 160, 130) in ("light", "intermediate") and of(90, 60, 45) == "dark"
    lab = cv2.cvtColor(np.float32([[[0.8, 0.6, 0.5]]]), cv2.COLOR_RGB2LAB)[0, 0]
    assert abs(angle(np.float32([[0.8, 0.6, 0.5]])) - np.degrees(np.arctan((lab[0] - 50) / lab[2]))) < 1e-3
    picture = np.zeros((100, 100, 3), np.uint8)
    picture[:, :50], picture[:, 50:] = (200, 0, 0), (0, 200, 0)
    points = np.zeros((175, 2))
    for x, side in zip((20, 70), lp.CHEEK):
        points[[lp.POSITION[k] for k in side]] = np.array([[0, 0], [10, 0], [10, 10], [0, 10], [5, 5]]) + [x, 40]
    assert np.allclose(cheeks(picture, points) * 255, [[200, 0, 0], [0, 200, 0]], atol=1e-3)
    print("skin_tone: ok")


if __name__ == "__main__":
    self_test()
