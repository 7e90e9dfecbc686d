"""The result of a tracker for one face on one frame."""

from __future__ import annotations

import enum
import math
from functools import lru_cache
from typing import Any, Iterable, Iterator, Mapping, NamedTuple, Union

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


@lru_cache(maxsize=16)
def _names(supported: int) -> tuple[str, ...]:
    return tuple(name for i, name in enumerate(CONTROL_NAMES) if supported >> i & 1)


@lru_cache(maxsize=16)
def _others(supported: int) -> list[int]:
    return [i for i in range(CONTROL_COUNT) if not supported >> i & 1]


class Controls(Mapping[str, float]):
    """Weights of animation, 0..1, by ARKit name, Control or attribute: controls["jawOpen"] is controls.jawOpen.

    The mapping has the controls that the level of detail predicts. `array` has all 52 in the order of CONTROL_NAMES; others are NaN.
    """

    __slots__ = ("_weights", "_supported")

    def __init__(self, weights: Floats, supported: int) -> None:
        self._weights = weights
        self._supported = supported

    def __getitem__(self, name: Union[str, Control]) -> float:
        number = int(name) if isinstance(name, Control) else CONTROL_NUMBERS[name]
        if not self._supported >> number & 1:
            raise KeyError(f"{CONTROL_NAMES[number]}: not predicted at this level of detail")
        return float(self._weights[number])

    def __getattr__(self, name: str) -> float:
        if name not in CONTROL_NUMBERS:
            raise AttributeError(f"{name}: no such control")
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(*error.args) from None

    def __dir__(self) -> Iterable[str]:
        return [*super().__dir__(), *self]

    def __iter__(self) -> Iterator[str]:
        return iter(_names(self._supported))

    def __len__(self) -> int:
        return len(_names(self._supported))

    def __repr__(self) -> str:
        return "Controls(" + ", ".join(f"{name}={value:.2f}" for name, value in self.items() if value >= 0.005) + ")"

    @property
    def array(self) -> Floats:
        array = self._weights.copy()
        array[_others(self._supported)] = np.nan
        return array

    @property
    def supported(self) -> frozenset[str]:
        """The controls that this level of detail predicts."""
        return frozenset(self)

    def to(self, vocabulary: str) -> dict[str, float]:
        """The controls in another vocabulary, one of VOCABULARIES: the names that the predicted controls determine."""
        number, names = number_of(vocabulary), vocabulary_names(vocabulary)
        values = np.empty(len(names), np.float32)
        check(function("mien_vocabulary_values")(number, self._weights.ctypes.data, values.ctypes.data, len(names)))
        supported = int(function("mien_vocabulary_supported")(number, self._supported))
        return {name: value for i, (name, value) in enumerate(zip(names, values.tolist())) if supported >> i & 1}


class Pose(NamedTuple):
    """The head in camera space: x to the right, y up, z towards the viewer."""

    rotation: Floats  #: unit quaternion x, y, z, w
    translation: Floats  #: metres
    pitch: float  #: radians, positive: looks down
    yaw: float  #: radians, positive: turns to the subject's left
    roll: float  #: radians, about z by the right-hand rule

    @property
    def matrix(self) -> npt.NDArray[np.float64]:
        """[4, 4]: head space to camera space, metres."""
        x, y, z, w = self.rotation.tolist()
        matrix = np.eye(4)
        matrix[:3, :3] = [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
        matrix[:3, 3] = self.translation
        return matrix

    def project(self, points: npt.ArrayLike, width: float, height: float, focal_length_px: float = 0.0) -> npt.NDArray[np.float64]:
        """Points [n, 3] of head space in metres, as pixels [n, 2] of the upright, unmirrored image.

        width, height: of that image, pixels. focal_length_px: pixels; 0: a horizontal field of view of 60 degrees.
        """
        focal = focal_length_px or width * math.sqrt(0.75)
        x, y, z = (np.asarray(points) @ self.matrix[:3, :3].T + self.translation).T
        return np.stack([width / 2 - focal * x / z, height / 2 + focal * y / z], 1)


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
        """Whether the face is tracked on this frame."""
        return bool(self._raw.status == FaceStatus.TRACKING)

    @property
    def time_s(self) -> float:
        """Timestamp of the frame, seconds."""
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
        """0..1, of the latest crop."""
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
        """The 52 animation weights, 0..1."""
        return Controls(self._floats("controls", CONTROL_COUNT), int(self._raw.supported_controls))

    @property
    def landmarks(self) -> Floats:
        """[175, 2]: x, y in pixels of the upright image."""
        return self._floats("landmarks", 2 * LANDMARK_COUNT).reshape(LANDMARK_COUNT, 2)

    def landmarks_of(self, group: LandmarkGroup) -> Floats:
        """[n, 2]: the landmarks of a group, for example LandmarkGroup.LEFT_IRIS; x, y in pixels of the upright image."""
        indices = LandmarkGroup(group).landmarks
        return self.landmarks[indices.start : indices.stop]

    @property
    def pose(self) -> Pose:
        """The head in camera space: metres and radians."""
        raw = self._raw
        return Pose(self._floats("rotation", 4), self._floats("translation", 3), raw.pitch, raw.yaw, raw.roll)

    def __repr__(self) -> str:
        return f"Result({self.status.name}, time_s={self.time_s:.3f}, face_id={self.face_id}, {self.controls!r})"
