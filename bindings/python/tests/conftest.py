"""Images of a face, from the clip in the repository. Tests the installed package."""
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

REPOSITORY = Path(__file__).resolve().parents[3]
CLIP = REPOSITORY / "tests/data/demo.mp4"
SECONDS = 2
WIDTH, HEIGHT, RATE = 640, 480, 30


@pytest.fixture(scope="session")
def clip():
    assert shutil.which("ffmpeg"), "the tests need ffmpeg"
    return CLIP


@pytest.fixture(scope="session")
def frames(clip):
    """[n, height, width, 3] BGR."""
    command = ["ffmpeg", "-v", "error", "-i", str(clip), "-t", str(SECONDS), "-vf", f"scale={WIDTH}:{HEIGHT},fps={RATE}",
               "-f", "rawvideo", "-pix_fmt", "bgr24", "-"]
    data = subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout
    return np.frombuffer(data, np.uint8).reshape(-1, HEIGHT, WIDTH, 3)
