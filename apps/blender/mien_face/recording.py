"""Collects received frames with continuous times."""

from array import array

from .frame import Frame
from .vocabularies import ARKIT

MAX_FRAMES = 216_000  # an hour at 60 frames per second
_MAX_AHEAD_S = 1.0
_NONE = float("nan")


class Recording:
    """Times come from the sender: its steps are even, late packets or not. If they go back, or further ahead than a
    second beyond the time of arrival, as from a new sender, they continue at the time of arrival."""

    def __init__(self, start_s):
        self._start_s = start_s
        self._offset_s = None
        self._sent_s = self._arrived_s = self._last_s = 0.0
        self._rows = []

    def __len__(self):
        return len(self._rows)

    @property
    def full(self):
        return len(self._rows) >= MAX_FRAMES

    def add(self, frame, arrival_s):
        arrived_s = arrival_s - self._start_s
        step_s = frame.time_s - self._sent_s
        if self._offset_s is None or step_s < 0.0 or step_s > arrived_s - self._arrived_s + _MAX_AHEAD_S:
            self._offset_s = arrived_s - frame.time_s
        self._sent_s, self._arrived_s = frame.time_s, arrived_s
        self._last_s = max(self._last_s, frame.time_s + self._offset_s)
        if not self.full:
            self._rows.append((self._last_s, _packed(frame.values), frame.head))

    def frames(self):
        return [Frame(time_s, _unpacked(values), head) for time_s, values, head in self._rows]


def _packed(values):
    """Controls, the usual case, as 8 bytes each instead of an entry of a dict."""
    if set(values) != {"arkit"} or not values["arkit"].keys() <= set(ARKIT):
        return values
    return array("d", [values["arkit"].get(name, _NONE) for name in ARKIT])


def _unpacked(values):
    if isinstance(values, dict):
        return values
    return {"arkit": {name: value for name, value in zip(ARKIT, values) if value == value}}
