"""Finds the controls that move shape keys, by the names of the keys.

Names match in any case, with `_L`, `.R` and the like for left and right, and with the prefix and suffix that most keys
share.
"""

import functools
import re
from collections import Counter

from .conversion import VOCABULARIES
from .vocabularies import ARKIT, READY_PLAYER_ME, ROBLOX, VISEMES, VRM0, VRM1

# VRoid Studio's shape keys, which have a prefix for each part of the face.
_VROID = {
    "Fcl_ALL_Joy": "Joy",
    "Fcl_ALL_Angry": "Angry",
    "Fcl_ALL_Sorrow": "Sorrow",
    "Fcl_ALL_Fun": "Fun",
    "Fcl_MTH_A": "A",
    "Fcl_MTH_I": "I",
    "Fcl_MTH_U": "U",
    "Fcl_MTH_E": "E",
    "Fcl_MTH_O": "O",
    "Fcl_EYE_Close_L": "Blink_L",
    "Fcl_EYE_Close_R": "Blink_R",
}

_MIN_WITH_AFFIXES = 3  # names that confirm a prefix or suffix
_OF_THE_MOUTH = ("mouth", "jaw", "tongue")


def plain(name):
    """The letters and digits of a name in lower case, with sides spelled out."""
    name = re.sub(r"\.\d{3}$", "", name)  # Blender numbers duplicates
    name = re.sub(r"(?:[^A-Za-z0-9]+[Ll]|(?<=[a-z])L)$", "left", name)
    name = re.sub(r"(?:[^A-Za-z0-9]+[Rr]|(?<=[a-z])R)$", "right", name)
    return re.sub(r"[^a-z0-9]", "", name.lower())


def _table(*pairs):
    return {plain(spelled): name for spelled, name in pairs}


TABLES = {
    "arkit": _table(*zip(ARKIT, ARKIT)),
    "roblox": _table(*zip(ROBLOX, ROBLOX)),
    "visemes": _table(*zip(VISEMES, VISEMES), *zip(READY_PLAYER_ME, VISEMES)),
    "vrm1": _table(*zip(VRM1, VRM1)),
    "vrm0": _table(*zip(VRM0, VRM0), *_VROID.items()),
}


def _with_affixes(keys, table, prefix, suffix):
    """{key: name}; a name that several keys claim moves all of them."""
    matches = {}
    for key in keys:
        text = plain(key)
        inner = text[len(prefix) : len(text) - len(suffix)]
        if (
            text.startswith(prefix)
            and text.endswith(suffix)
            and inner in table
            and len(prefix) + len(suffix) < len(text)
        ):
            matches[key] = table[inner]
    return matches


def _shared_affixes(keys, table):
    """The prefix and suffix with which most different names occur in the keys; none below three."""
    count = Counter()
    for text in {plain(key) for key in keys}:
        for name in table:
            at = text.find(name)
            while at >= 0:
                count[text[:at], text[at + len(name) :]] += 1
                at = text.find(name, at + 1)
    best = max(count, key=lambda pair: (count[pair], -len(pair[0] + pair[1])), default=("", ""))
    return best if count[best] >= _MIN_WITH_AFFIXES else ("", "")


def _in_table(keys, table, prefix, suffix):
    if prefix or suffix:
        return _with_affixes(keys, table, plain(prefix), plain(suffix))
    return {**_with_affixes(keys, table, *_shared_affixes(keys, table)), **_with_affixes(keys, table, "", "")}


@functools.lru_cache(maxsize=256)
def match(keys, vocabulary="auto", prefix="", suffix=""):
    """{key: (vocabulary, name)} for a tuple of names of keys.

    `auto` takes the vocabulary with most matches; if it is that of visemes, which move the mouth only, ARKit's names
    move the rest. An empty prefix and suffix are detected.
    """
    chosen = VOCABULARIES if vocabulary == "auto" else (vocabulary,)
    found = {name: _in_table(keys, TABLES[name], prefix, suffix) for name in chosen}
    best = max(chosen, key=lambda name: len(found[name]))
    matches = {key: (best, name) for key, name in found[best].items()}
    if vocabulary == "auto" and best == "visemes":
        rest = {key: ("arkit", name) for key, name in found["arkit"].items() if not name.startswith(_OF_THE_MOUTH)}
        matches = {**rest, **matches}
    return matches
