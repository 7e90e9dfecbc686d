"""The result of a tracker for one face on one frame."""

from __future__ import annotations

import enum
from typing import Any, Iterator, Mapping, NamedTuple, Union

import numpy as np
import numpy.typing as npt

from ._library import CONTROL_COUNT, LANDMARK_COUNT, TrackerResult, function
from .errors import check
from .vocabulary import CONTROL_NAMES, CONTROL_NUMBERS, Control, LandmarkGroup, number_of, vocabulary_names

Floats = npt.NDArray[np.float32]


class FaceStatus(enum.IntEnum):
    SEARCHING = 0  #: no face since the start or reset
    TRACKING = 1
    LOST = 2  #: the face is lost: it keeps its last position, and its controls fade


class Controls(Mapping[str, float]):
    """52 animation weights, 0..1, by ARKit name or Control; `array` has them in the order of CONTROL_NAMES."""

    __slots__ = ("array", "_supported")

    def __init__(self, array: Floats, supported: int) -> None:
        self.array = array
        self._supported = supported

    def __getitem__(self, name: Union[str, Control]) -> float:
        return float(self.array[name if isinstance(name, Control) else CONTROL_NUMBERS[name]])

    def __iter__(self) -> Iterator[str]:
        return iter(CONTROL_NAMES)

    def __len__(self) -> int:
        return CONTROL_COUNT

    def __repr__(self) -> str:
        return "Controls(" + ", ".join(f"{name}={value:.2f}" for name, value in self.items() if value >= 0.005) + ")"

    @property
    def supported(self) -> frozenset[str]:
        """The controls that this level of detail predicts; the others are 0."""
        return frozenset(name for name, i in CONTROL_NUMBERS.items() if self._supported >> i & 1)

    def to(self, vocabulary: str) -> dict[str, float]:
        """The controls in another vocabulary, one of VOCABULARIES."""
        names = vocabulary_names(vocabulary)
        controls = np.ascontiguousarray(self.array, np.float32)
        if controls.shape != (CONTROL_COUNT,):
            raise ValueError(f"array: wrong shape (got {controls.shape}, expected ({CONTROL_COUNT},))")
        values = np.empty(len(names), np.float32)
        check(function("mien_vocabulary_values")(number_of(vocabulary), controls.ctypes.data, values.ctypes.data, len(names)))
        return dict(zip(names, values.tolist()))


class Pose(NamedTuple):
    """The head in camera space: x to the right, y up, z towards the viewer."""

    rotation: Floats  #: unit quaternion x, y, z, w
    translation: Floats  #: metres
    pitch: float  #: radians, positive: looks down
    yaw: float  #: radians, positive: turns to the subject's left
    roll: float  #: radians, about z by the right-hand rule


class Result:
    """One face on one frame. Owns its memory; arrays are views of it."""

    __slots__ = ("_raw",)

    def __init__(self, raw: TrackerResult) -> None:
        self._raw = raw

    def _floats(self, field: str, count: int) -> Floats:
        memory: Any = self._raw  # which has the buffer protocol, unknown to the type checker
        array: Floats = np.frombuffer(memory, np.float32, count, getattr(TrackerResult, field).offset)
        return array

    @property
    def status(self) -> FaceStatus:
        return FaceStatus(self._raw.status)

    @property
    def has_face(self) -> bool:
        return bool(self._raw.status == FaceStatus.TRACKING)

    @property
    def time_s(self) -> float:
        return float(self._raw.pts_ns) / 1e9

    @property
    def face_id(self) -> int:
        """Number of the face, from 1 in the order of detection; 0 before the first."""
        return int(self._raw.face_id)

    @property
    def lod(self) -> int:
        """The level of detail, 1..4, of this frame."""
        return int(self._raw.lod)

    @property
    def face_probability(self) -> float:
        return float(self._raw.face_probability)

    @property
    def voice_activity(self) -> float:
        """0..1: voice activity; 0 without audio."""
        return float(self._raw.voice_activity)

    @property
    def is_capturing_neutral(self) -> bool:
        """Whether this frame contributes to Tracker.calibrate."""
        return bool(self._raw.flags & 0x10)

    @property
    def box(self) -> Floats:
        """x, y, width, height in pixels of the upright image."""
        return self._floats("box", 4)

    @property
    def controls(self) -> Controls:
        return Controls(self._floats("controls", CONTROL_COUNT), int(self._raw.supported_controls))

    @property
    def landmarks(self) -> Floats:
        """[175, 2]: x, y in pixels of the upright image."""
        return self._floats("landmarks", 2 * LANDMARK_COUNT).reshape(LANDMARK_COUNT, 2)

    def landmarks_of(self, group: LandmarkGroup) -> Floats:
        """[n, 2]: the landmarks of a group, for example LandmarkGroup.LEFT_IRIS."""
        indices = LandmarkGroup(group).landmarks
        return self.landmarks[indices.start : indices.stop]

    @property
    def pose(self) -> Pose:
        raw = self._raw
        return Pose(self._floats("rotation", 4), self._floats("translation", 3), raw.pitch, raw.yaw, raw.roll)

    def __repr__(self) -> str:
        return f"Result({self.status.name}, time_s={self.time_s:.3f}, face_id={self.face_id}, {self.controls!r})"
