"""Runs the built program `mien` on videos, stills and rendered images."""
import functools
import json
import subprocess
import tempfile
from collections import namedtuple
from pathlib import Path

import cv2
import numpy as np

from mien_training.evaluate import curves

FPS = 30

Tracked = namedtuple("Tracked", "table landmarks stats")  # curves by column, [frames,175,2] pixels, --stats


class Program:
    def __init__(self, path, models):
        self.path, self.models = Path(path), Path(models)

    @property
    def has_hifinet(self):
        return (self.models / "hifinet.mien").exists()

    def track(self, video, lod, *options, mode="video"):
        """Runs `mien track` on the path of a video, or on the pieces of a Y4M stream."""
        path = "-" if not isinstance(video, Path) else str(video)
        with tempfile.TemporaryDirectory() as folder:
            outputs = [f"{folder}/{name}" for name in ("curves.csv", "landmarks.csv", "stats.json")]
            command = [self.path, "track", path, "-o", outputs[0], "--landmarks", outputs[1], "--stats", outputs[2],
                       "--lod", lod, "--mode", mode, "--models", self.models, "--quiet", *options]
            running = subprocess.Popen([str(c) for c in command], stdin=subprocess.PIPE if path == "-" else None)
            if path == "-":
                with running.stdin as stream:
                    for piece in video:
                        stream.write(piece)
            if running.wait():
                raise RuntimeError(f"{path} at level {lod}: mien ended with {running.returncode}")
            return Tracked(curves.read_table(outputs[0]), curves.read_landmarks(outputs[1]),
                           json.loads(Path(outputs[2]).read_text()))


def y4m(pictures, order=None):
    """Pieces of a 4:2:0 full-range video of images uint8 [n,h,w,3] RGB, shown in `order`; odd sizes lose a line."""
    height, width = (v // 2 * 2 for v in pictures[0].shape[:2])
    yield f"YUV4MPEG2 W{width} H{height} F{FPS}:1 Ip A1:1 C420jpeg XCOLORRANGE=FULL\n".encode()
    frame = functools.lru_cache(None)(lambda k: b"FRAME\n" + planes(pictures[k][:height, :width]))
    yield from map(frame, range(len(pictures)) if order is None else order)


def planes(picture):
    """Luma and chroma of an RGB image of even size, as bytes."""
    height = len(picture)
    yuv = cv2.cvtColor(np.ascontiguousarray(picture), cv2.COLOR_RGB2YUV_I420).astype(np.float32)
    # OpenCV's conversion is of limited range: stretch luma and chroma to the full one.
    luma = (yuv[:height] - 16) * (255 / 219)
    chroma = (yuv[height:] - 128) * (255 / 224) + 128
    return np.clip(np.concatenate([luma, chroma]) + 0.5, 0, 255).astype(np.uint8).tobytes()
