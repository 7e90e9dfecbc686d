"""Decodes datagrams: JSON of mien and Live Link Face, version 6."""

import json
import math
import struct

from .frame import FaceDataError, Frame
from .live_link_units import UNITS_PER_RADIAN
from .rotation import of_angles
from .vocabularies import ARKIT

_VERSION = 6
_KEYS = {"arkit": "controls", "roblox": "facs", "visemes": "visemes"}
_ANGLES = ("pitch_rad", "yaw_rad", "roll_rad")


def _no_constant(name):
    raise ValueError(f"{name} is not a number")


def _number(value, name, low, high):
    if not isinstance(value, (int, float)) or isinstance(value, bool) or not low <= value <= high:
        raise FaceDataError(f"{name}: expected a number in {low:g}..{high:g}")
    return float(value)


def _object(parent, key):
    found = parent.get(key, {})
    if not isinstance(found, dict):
        raise FaceDataError(f"{key}: expected an object")
    return found


def _json_frame(data):
    try:
        found = json.loads(data, parse_constant=_no_constant)
    except (ValueError, RecursionError) as error:
        raise FaceDataError(f"JSON: {error}") from None
    time_ns = found.get("t_ns") if isinstance(found, dict) else None
    if not isinstance(time_ns, int) or isinstance(time_ns, bool) or abs(time_ns) >= 1 << 63:
        raise FaceDataError("t_ns: missing, or not an integer")
    values = {
        vocabulary: {name: _number(value, name, 0.0, 1.0) for name, value in _object(found, key).items()}
        for vocabulary, key in _KEYS.items()
        if key in found
    }
    head = _object(found, "head")
    angles = [_number(head.get(name), name, -2.0 * math.pi, 2.0 * math.pi) for name in _ANGLES] if head else None
    return Frame(time_ns * 1e-9, values, of_angles(*angles) if angles else None)


class _Bytes:
    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, layout):
        size = struct.calcsize(layout)
        if self.at + size > len(self.data):
            raise FaceDataError(f"Live Link Face: truncated packet ({len(self.data)} bytes)")
        values = struct.unpack_from(layout, self.data, self.at)
        self.at += size
        return values

    def skip_text(self):
        (length,) = self.take(">I")
        self.take(f">{min(length, len(self.data) + 1)}x")


def _live_link_frame(data, units_per_radian):
    packet = _Bytes(data)
    (version,) = packet.take(">B")
    if version != _VERSION:
        raise FaceDataError(f"Live Link Face: unknown version (got {version}, expected {_VERSION})")
    packet.skip_text()
    packet.skip_text()
    number, part, numerator, denominator = packet.take(">IfII")
    count = packet.take(">B")[0] if packet.at < len(data) else 0
    values = packet.take(f">{count}f")
    if not numerator or not all(map(math.isfinite, (part, *values))):
        raise FaceDataError("Live Link Face: a value is not a finite number, or the frame rate is 0")
    frame = Frame((number + part) * denominator / numerator, {"arkit": {}})
    frame.values["arkit"] = {name: min(1.0, max(0.0, value)) for name, value in zip(ARKIT, values)}
    if count >= len(ARKIT) + 3:
        yaw, pitch, roll = (value / units_per_radian for value in values[len(ARKIT) : len(ARKIT) + 3])
        frame.head = of_angles(-pitch, yaw, roll)
    return frame


def decode(data, llf_rotation="rad"):
    """The frame of a datagram. Raises FaceDataError for all other bytes."""
    if data[:1] == b"{":
        return _json_frame(data)
    if data[:1] and data[0] <= _VERSION:
        return _live_link_frame(data, UNITS_PER_RADIAN[llf_rotation])
    raise FaceDataError(f"unknown packet ({len(data)} bytes): expected JSON of mien or Live Link Face")
