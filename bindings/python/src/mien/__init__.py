"""Facial animation from a camera and a microphone, on the CPU.

    with mien.Tracker() as tracker:
        result = tracker.track(frame, time_s)          # a BGR image, as in OpenCV
        print(result.controls.jawOpen, result.pose.yaw)
"""

from ._library import version
from .draw import draw
from .errors import MienError
from .media import columns, track_file, track_image
from .network import Network, Shape, run
from .result import Controls, FaceStatus, Pose, Result
from .rows import Row
from .tracker import Tracker
from .vocabulary import CONTROL_NAMES, LANDMARK_COUNT, LANDMARK_NAMES, VOCABULARIES, Control, LandmarkGroup, vocabulary_names
from .weights import Weights

__all__ = [
    "CONTROL_NAMES",
    "Control",
    "Controls",
    "FaceStatus",
    "LANDMARK_COUNT",
    "LANDMARK_NAMES",
    "LandmarkGroup",
    "MienError",
    "Network",
    "Pose",
    "Result",
    "Row",
    "Shape",
    "Tracker",
    "VOCABULARIES",
    "Weights",
    "columns",
    "draw",
    "errors",
    "run",
    "track_file",
    "track_image",
    "vocabulary_names",
]
__version__ = version()
