"""The videos that are measured on: clips of real people with what MediaPipe answers for them, and the demo clip that ships."""
from paths import ROOT, data
from setting import Missing

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
