"""Frames of a clip, decoded by ffmpeg."""
import subprocess

import numpy as np

WIDTH, HEIGHT, FPS = 640, 480, 30


def frames(clip):
    """RGB uint8 [n,HEIGHT,WIDTH,3]."""
    command = ["ffmpeg", "-nostdin", "-v", "error", "-i", clip, "-s", f"{WIDTH}x{HEIGHT}", "-pix_fmt", "rgb24", "-f",
               "rawvideo", "-"]
    data = subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout
    return np.frombuffer(data, np.uint8).reshape(-1, HEIGHT, WIDTH, 3)
