"""Reads CSV of Live Link Face."""

import json
import math
import re

from .csv_table import MAX_BYTES, Table, quoted
from .frame import FaceDataError, Frame
from .live_link_units import UNITS_PER_RADIAN, AngleUnit, TimecodeRate
from .rotation import of_angles
from .vocabularies import ARKIT, ROTATIONS

_TIMECODE = re.compile(r"(\d{1,2}):(\d{1,2}):(\d{1,2})[:;](\d+(?:\.\d*)?)", re.ASCII)
_DAY_S = 86400.0


def timecode(text):
    """(seconds, frames) of HH:MM:SS:FF.mmm, None for other text."""
    found = _TIMECODE.fullmatch(text)
    if not found or int(found[2]) > 59 or int(found[3]) > 59:
        return None
    return int(found[1]) * 3600 + int(found[2]) * 60 + int(found[3]), float(found[4])


def _detected(text):
    """Rate and unit from all rows. Errors in rows are reported later, when they are read."""
    rate, angle, table = TimecodeRate(), AngleUnit(), Table(text)
    while table.next_row():
        time = timecode(table.text("Timecode"))
        if time:
            rate.add(*time)
        try:
            controls = {name: table.number(name) or 0.0 for name in ARKIT}
            angle.add([table.number(name) for name in ROTATIONS], controls)
        except FaceDataError:
            continue
    return rate.rate(), angle.unit()


def _from_json(path):
    """Unit and rate in FILE.json, which mien writes beside its files; nothing without such a file."""
    try:
        with open(path, "rb") as file:
            found = json.loads(file.read(MAX_BYTES))
    except (OSError, ValueError, RecursionError):
        return None, None
    found = found if isinstance(found, dict) else {}
    unit, fps = found.get("rotation"), found.get("timecode_fps")
    return (
        unit if isinstance(unit, str) and unit in UNITS_PER_RADIAN else None,
        fps if isinstance(fps, (int, float)) and 1 <= fps <= 100 else None,
    )


def units(text, options, json_path):
    """(unit, fps): from the options, from FILE.json, or detected."""
    unit, fps = _from_json(json_path)
    unit = options.llf_rotation if options.llf_rotation != "auto" else unit
    fps = options.llf_fps or fps
    if unit is None or fps is None:
        detected_fps, detected_unit = _detected(text)
        unit, fps = unit or detected_unit, fps or detected_fps
    return unit, fps


class _Reader:
    def __init__(self, table, unit, fps):
        self.table, self.unit, self.fps = table, unit, fps
        self.names = [name for name in ARKIT if table.has(name)]
        self.frames, self.clamped = [], 0
        if not table.has("BlendshapeCount") or not self.names:
            raise table.error("missing column BlendshapeCount" if self.names else "no column with a blend shape")

    def read(self):
        while self.table.next_row():
            self.frames.append(self.frame())
        if not self.frames:
            raise self.table.error("no frames")
        return self.frames

    def frame(self):
        count = self.table.text("BlendshapeCount")
        if not count.isascii() or not count.isdigit():
            raise self.table.error(f"BlendshapeCount: {quoted(count)} is not a count")
        time_s = self.time()
        if not count.strip("0"):
            return Frame(time_s, {"arkit": {}})
        self.table.check_width()
        values = {name: self.table.number(name) for name in self.names}
        return Frame(
            time_s, {"arkit": {name: self.in_range(v) for name, v in values.items() if v is not None}}, self.head()
        )

    def in_range(self, value):
        inside = min(1.0, max(0.0, value))
        self.clamped += inside != value
        return inside

    def time(self):
        """After midnight the hours restart: adds the days that bring the time nearest to the previous one."""
        text, time_s = self.table.text("Timecode"), len(self.frames) / self.fps
        if text:
            found = timecode(text)
            if not found:
                raise self.table.error(f"Timecode: {quoted(text)} is not HH:MM:SS:FF.mmm")
            if found[1] >= self.fps:
                raise self.table.error(f"Timecode: {quoted(text)} has more frames than a second of {self.fps:g}")
            time_s = found[0] + found[1] / self.fps
        if self.frames:
            last_s = self.frames[-1].time_s
            time_s += max(0.0, math.ceil((last_s - time_s) / _DAY_S - 0.5)) * _DAY_S
            if time_s < last_s:
                raise self.table.error("Timecode: decreasing time")
        return time_s

    def head(self):
        rotation = self.table.all_numbers(ROTATIONS[:3])
        if rotation is None:
            return None
        half_turn = math.pi * UNITS_PER_RADIAN[self.unit]
        for name, value in zip(ROTATIONS, rotation):
            if abs(value) > half_turn * (1.0 + 1e-6):
                raise self.table.error(
                    f"{name}: more than half a turn in {self.unit} "
                    f"(got {value:g}, expected {-half_turn:.2f} to {half_turn:.2f})"
                )
        yaw, pitch, roll = (value / UNITS_PER_RADIAN[self.unit] for value in rotation)
        return of_angles(-pitch, yaw, roll)


def read(table, unit, fps):
    """Frames, and notes."""
    reader = _Reader(table, unit, fps)
    notes = [f"timecode {fps:g} fps, rotations in {unit}"]
    frames = reader.read()
    if reader.clamped:
        notes.append(f"{reader.clamped} values outside 0..1 were clamped")
    return frames, notes
