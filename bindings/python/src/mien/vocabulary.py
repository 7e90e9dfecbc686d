"""Names of controls, ARKit's and those of other vocabularies."""

from __future__ import annotations

from types import MappingProxyType
from typing import Mapping

from ._library import CONTROL_COUNT, LANDMARK_COUNT, function, text

__all__ = ["CONTROL_NAMES", "LANDMARK_COUNT", "VOCABULARIES", "vocabulary_names"]

CONTROL_NAMES: tuple[str, ...] = tuple(text("mien_control_name", i) or "" for i in range(CONTROL_COUNT))
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
