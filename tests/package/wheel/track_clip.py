"""Tracks a clip with the installed package: its images with the library, and the file with the program.

usage: track_clip.py CLIP.y4m      4:2:0, with a face
"""
import sys
import time

import mien
import numpy as np


def images(path):
    with open(path, "rb") as file:
        header = {field[0]: field[1:] for field in file.readline().decode().split()[1:]}
        width, height = int(header["W"]), int(header["H"])
        while file.readline().startswith(b"FRAME"):
            yield np.frombuffer(file.read(width * height * 3 // 2), np.uint8).reshape(height * 3 // 2, width)


def main():
    path, count = sys.argv[1], 0
    began = time.perf_counter()
    with mien.Tracker(lod=4) as tracker:
        created = time.perf_counter()
        for count, image in enumerate(images(path), start=1):
            result = tracker.track(image, count / 30, color="i420")
            assert result.has_face, f"image {count}: no face"
    assert count > 0, "no images"
    assert np.isfinite(result.landmarks).all() and 0.0 <= result.controls.jawOpen <= 1.0, "wrong values"
    rows = list(mien.track_file(path))
    assert len(rows) == count and all("jawOpen" in row for row in rows), f"other rows (got {len(rows)}, expected {count})"
    print(f"Python {sys.version.split()[0]} on {sys.platform}: {count} images; the tracker was created in {1000 * (created - began):.0f} ms")


main()
