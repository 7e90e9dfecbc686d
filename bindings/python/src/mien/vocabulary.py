"""Names of controls, ARKit's and those of other vocabularies."""

from __future__ import annotations

import enum
from ctypes import byref, c_int32
from types import MappingProxyType
from typing import Mapping

from ._library import CONTROL_COUNT, LANDMARK_COUNT, function, text

__all__ = ["CONTROL_NAMES", "Control", "LANDMARK_COUNT", "LANDMARK_NAMES", "LandmarkGroup", "VOCABULARIES", "vocabulary_names"]

class Control(enum.IntEnum):
    """Controls in the order of CONTROL_NAMES: mien_control of mien.h."""

    EYE_BLINK_LEFT = 0
    EYE_LOOK_DOWN_LEFT = 1
    EYE_LOOK_IN_LEFT = 2
    EYE_LOOK_OUT_LEFT = 3
    EYE_LOOK_UP_LEFT = 4
    EYE_SQUINT_LEFT = 5
    EYE_WIDE_LEFT = 6
    EYE_BLINK_RIGHT = 7
    EYE_LOOK_DOWN_RIGHT = 8
    EYE_LOOK_IN_RIGHT = 9
    EYE_LOOK_OUT_RIGHT = 10
    EYE_LOOK_UP_RIGHT = 11
    EYE_SQUINT_RIGHT = 12
    EYE_WIDE_RIGHT = 13
    JAW_FORWARD = 14
    JAW_LEFT = 15
    JAW_RIGHT = 16
    JAW_OPEN = 17
    MOUTH_CLOSE = 18
    MOUTH_FUNNEL = 19
    MOUTH_PUCKER = 20
    MOUTH_LEFT = 21
    MOUTH_RIGHT = 22
    MOUTH_SMILE_LEFT = 23
    MOUTH_SMILE_RIGHT = 24
    MOUTH_FROWN_LEFT = 25
    MOUTH_FROWN_RIGHT = 26
    MOUTH_DIMPLE_LEFT = 27
    MOUTH_DIMPLE_RIGHT = 28
    MOUTH_STRETCH_LEFT = 29
    MOUTH_STRETCH_RIGHT = 30
    MOUTH_ROLL_LOWER = 31
    MOUTH_ROLL_UPPER = 32
    MOUTH_SHRUG_LOWER = 33
    MOUTH_SHRUG_UPPER = 34
    MOUTH_PRESS_LEFT = 35
    MOUTH_PRESS_RIGHT = 36
    MOUTH_LOWER_DOWN_LEFT = 37
    MOUTH_LOWER_DOWN_RIGHT = 38
    MOUTH_UPPER_UP_LEFT = 39
    MOUTH_UPPER_UP_RIGHT = 40
    BROW_DOWN_LEFT = 41
    BROW_DOWN_RIGHT = 42
    BROW_INNER_UP = 43
    BROW_OUTER_UP_LEFT = 44
    BROW_OUTER_UP_RIGHT = 45
    CHEEK_PUFF = 46
    CHEEK_SQUINT_LEFT = 47
    CHEEK_SQUINT_RIGHT = 48
    NOSE_SNEER_LEFT = 49
    NOSE_SNEER_RIGHT = 50
    TONGUE_OUT = 51


class LandmarkGroup(enum.IntEnum):
    """Groups of landmarks: mien_landmark_group of mien.h, which describes them."""

    RIGHT_EYE_LOWER = 0
    LEFT_EYE_LOWER = 1
    RIGHT_EYE_UPPER = 2
    LEFT_EYE_UPPER = 3
    RIGHT_IRIS = 4
    LEFT_IRIS = 5
    RIGHT_BROW_UPPER = 6
    LEFT_BROW_UPPER = 7
    RIGHT_BROW_LOWER = 8
    LEFT_BROW_LOWER = 9
    RIGHT_NOSE_SIDE = 10
    LEFT_NOSE_SIDE = 11
    RIGHT_CHEEK = 12
    LEFT_CHEEK = 13
    NOSE_BRIDGE = 14
    MIDLINE = 15
    LIPS_OUTER_UPPER = 16
    LIPS_OUTER_LOWER = 17
    LIPS_INNER_UPPER = 18
    LIPS_INNER_LOWER = 19
    FACE_OVAL = 20

    @property
    def landmarks(self) -> range:
        """Indices of the group's landmarks."""
        first = c_int32()
        count = int(function("mien_landmark_group_range")(self, byref(first)))
        return range(first.value, first.value + count)


CONTROL_NAMES: tuple[str, ...] = tuple(text("mien_control_name", i) or "" for i in range(CONTROL_COUNT))
LANDMARK_NAMES: tuple[str, ...] = tuple(f"{group.name.lower()}_{i}" for group in LandmarkGroup for i in range(len(group.landmarks)))
CONTROL_NUMBERS: Mapping[str, int] = MappingProxyType({name: i for i, name in enumerate(CONTROL_NAMES)})

# In the order of mien_vocabulary.
VOCABULARIES: tuple[str, ...] = ("arkit", "mediapipe", "roblox", "vrm0", "vrm1", "visemes")


def number_of(vocabulary: str) -> int:
    if vocabulary not in VOCABULARIES:
        raise ValueError(f"vocabulary: unknown (got {vocabulary!r}, expected one of {', '.join(VOCABULARIES)})")
    return VOCABULARIES.index(vocabulary)


def vocabulary_names(vocabulary: str) -> tuple[str, ...]:
    """The names of a vocabulary, one of VOCABULARIES, in its order."""
    number = number_of(vocabulary)
    size = int(function("mien_vocabulary_size")(number))
    return tuple(text("mien_vocabulary_name", number, i) or "" for i in range(size))
