"""Videos of the evaluation: clips of real people with MediaPipe's output, and the demo clip."""
import subprocess

import numpy as np

from mien_training.evaluate.inputs import Missing
from mien_training.paths import ROOT, data

SUFFIXES = (".mp4", ".mkv", ".mpg")
DEMO = ROOT / "tests/data/demo.mp4"


def clips():
    """Paths of the clips of real people."""
    found = sorted(p for p in (data() / "clips").glob("*") if p.suffix in SUFFIXES)
    if not found:
        raise Missing("the clips of real people are absent: MIEN_DATA must name the folder of the data packs")
    return found


def labels_of(clip):
    return clip.with_suffix(".mediapipe.npz")


def size(path):
    """(width, height) in pixels."""
    command = ["ffprobe", "-v", "error", "-select_streams", "v:0", "-show_entries", "stream=width,height", "-of",
               "csv=p=0", str(path)]
    return [int(v) for v in subprocess.check_output(command, text=True).strip().strip(",").split(",")[:2]]


def frames(path):
    """uint8 [n,h,w,3]"""
    command = ["ffmpeg", "-v", "error", "-i", str(path), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    width, height = size(path)
    return np.frombuffer(subprocess.check_output(command), np.uint8).reshape(-1, height, width, 3)
