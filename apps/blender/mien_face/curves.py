"""Animation curves from frames."""

from array import array
from dataclasses import dataclass, field

from .conversion import values_in
from .rotation import IDENTITY, nearer


@dataclass
class Curve:
    """Keys of a property at times in Blender's frames. `holds` says for each key whether its value stays until the next
    one, because frames between them have no value."""

    times: list = field(default_factory=list)
    values: list = field(default_factory=list)
    holds: list = field(default_factory=list)

    def add(self, time, value):
        """Keys that coincide in single precision, as Blender stores them, are one."""
        time = array("f", [time])[0]
        if not self.times or time > self.times[-1]:
            self.times.append(time)
            self.values.append(value)
            self.holds.append(False)

    def gap(self):
        if self.holds:
            self.holds[-1] = True


def control_curves(frames, time_of, controls):
    """{control: Curve} for a set of (vocabulary, name). Controls that no frame has are absent."""
    curves = {control: Curve() for control in controls}
    vocabularies = {vocabulary for vocabulary, _ in controls}
    for frame in frames:
        time = time_of(frame.time_s)
        values = {vocabulary: values_in(vocabulary, frame) for vocabulary in vocabularies}
        for (vocabulary, name), curve in curves.items():
            value = values[vocabulary].get(name)
            if value is None:
                curve.gap()
            else:
                curve.add(time, value)
    return {control: curve for control, curve in curves.items() if curve.times}


def head_curve(frames, time_of):
    """The head's rotations, each with the sign nearest to the previous one."""
    curve, previous = Curve(), IDENTITY
    for frame in frames:
        if frame.head is None:
            curve.gap()
        else:
            previous = nearer(frame.head, previous)
            curve.add(time_of(frame.time_s), previous)
    return curve
