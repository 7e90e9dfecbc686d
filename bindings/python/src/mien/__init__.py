"""Facial animation from a camera and a microphone, on the CPU.

    with mien.Tracker() as tracker:
        result = tracker.track(frame, time_s)          # a BGR image, as in OpenCV
        print(result.controls["jawOpen"], result.pose.yaw)
"""

from ._library import version
from .errors import MienError
from .media import Row, columns, track_file
from .network import Network, Shape, run
from .result import Controls, FaceStatus, Pose, Result
from .tracker import Tracker
from .vocabulary import CONTROL_NAMES, LANDMARK_COUNT, VOCABULARIES, Control, LandmarkGroup, vocabulary_names
from .weights import Weights

__all__ = [
    "CONTROL_NAMES",
    "Control",
    "Controls",
    "FaceStatus",
    "LANDMARK_COUNT",
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
    "errors",
    "run",
    "track_file",
    "vocabulary_names",
]
__version__ = version()
