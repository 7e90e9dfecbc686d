"""Detects the frame rate and the unit of angles of a Live Link Face file, as `mien convert` does."""

import math
from statistics import median_low

UNITS_PER_RADIAN = {"rad": 1.0, "norm180": 1.0 / math.pi, "deg": 180.0 / math.pi}

_RATES = (24.0, 25.0, 30.0, 48.0, 50.0, 60.0)
_DEFAULT_RATE = 60.0
_MIN_STEPS = 5

_MAX_ANGLE_RAD = 2.1  # beyond it a head no longer shows its face
_MAX_STEP_RAD = 0.35  # largest typical step between rows
_MIN_HEAD_STEPS = 10

_EYE_TURN_RAD = 0.485  # rotation of an eye while eyeLook... goes from 0 to 1
_MIN_LOOK = 0.1
_MIN_CORRELATION = 0.9

# Column of a rotation, and the controls that increase and decrease it.
_EYES = (
    (3, "eyeLookOutLeft", "eyeLookInLeft"),
    (4, "eyeLookUpLeft", "eyeLookDownLeft"),
    (6, "eyeLookInRight", "eyeLookOutRight"),
    (7, "eyeLookUpRight", "eyeLookDownRight"),
)


class TimecodeRate:
    """Processes all timecodes of a file in order."""

    def __init__(self):
        self._last, self._largest = None, 0.0
        self._steps, self._before = [], []

    def add(self, second, frame):
        self._largest = max(self._largest, frame)
        if self._last:
            last_second, last_frame = self._last
            if second == last_second and frame > last_frame:
                self._steps.append(frame - last_frame)
            if second == last_second + 1 and frame < last_frame:
                self._before.append(last_frame - frame)
        self._last = (second, frame)

    def rate(self):
        """The possible rate that is closest to the typical last frame number of a second plus the typical step."""
        possible = [rate for rate in _RATES if rate > self._largest]
        if not possible or len(self._steps) < _MIN_STEPS or not self._before:
            return _DEFAULT_RATE
        shown = median_low(self._before) + median_low(self._steps)
        return min(possible, key=lambda rate: abs(rate - shown))


class _Line:
    """A line through 0, as sums over its points."""

    def __init__(self):
        self.xx = self.xy = self.yy = self.largest = 0.0

    def add(self, x, y):
        self.xx, self.xy, self.yy = self.xx + x * x, self.xy + x * y, self.yy + y * y
        self.largest = max(self.largest, abs(x))

    def correlation(self):
        product = self.xx * self.yy
        return abs(self.xy) / math.sqrt(product) if self.largest >= _MIN_LOOK and product > 0.0 else 0.0


class AngleUnit:
    """Processes rotations and controls of all rows."""

    def __init__(self):
        self._lines = [_Line() for _ in _EYES]
        self._last = [None] * 3
        self._largest = self._largest_roll = 0.0
        self._steps = []

    def add(self, rotations, controls):
        for i, value in enumerate(rotations):
            if i % 3 == 2:
                self._largest_roll = max(self._largest_roll, abs(value or 0.0))
            else:
                self._largest = max(self._largest, abs(value or 0.0))
        for value, last in zip(rotations, self._last):
            if value is not None and last is not None and value != last:
                self._steps.append(abs(value - last))
        self._last = rotations[:3]
        for line, (column, more, less) in zip(self._lines, _EYES):
            if rotations[column] is not None:
                line.add(controls[more] - controls[less], rotations[column])

    def unit(self):
        """Degrees if angles or steps are too large for radians. Otherwise the eyes decide: their rotation is known."""
        too_far = self._largest > _MAX_ANGLE_RAD or self._largest_roll > math.pi * (1.0 + 1e-6)
        too_fast = len(self._steps) >= _MIN_HEAD_STEPS and median_low(self._steps) > _MAX_STEP_RAD
        if too_far or too_fast:
            return "deg"
        line = max(self._lines, key=_Line.correlation)
        if line.correlation() < _MIN_CORRELATION:
            return "rad"
        possible = ["rad", "deg"] + ["norm180"] * (max(self._largest, self._largest_roll) <= 1.0)
        turn = abs(line.xy) / line.xx
        return min(possible, key=lambda unit: abs(math.log(turn / (_EYE_TURN_RAD * UNITS_PER_RADIAN[unit]))))
