"""Videos of the evaluation: clips of real people with MediaPipe's output, and the demo clip."""
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
