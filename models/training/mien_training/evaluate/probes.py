"""Probes: controls that move alone, and neutral faces that turn.

A Plan lists the images of each person and their order in a video, with pauses, so smoothing and temporal decoders
settle before the response is read.
"""
import numpy as np

from mien_training.data.expressions import CONTROLS, INDEX

STEPS = (0.2, 0.4, 0.6, 0.8, 1.0)
# frames: before a control moves, on each step upwards, at 1, on each step downwards
REST, RISE, HOLD, FALL = 10, 3, 12, 2
READ = 4                               # frames at the end of a pause whose mean is the answer
MOUTH_OPEN = 0.6                       # jawOpen of a wink with the mouth open
YAW, PITCH, ANGLE_STEP, TURN = 40, 25, 5, 4  # degrees; frames on each step of a turn


def companions():
    """{control: controls that accompany it on a real face}: eyes turn together, the tongue and mouthClose need an open
    jaw."""
    out = {"tongueOut": {"jawOpen": 0.6}, "mouthClose": {"jawOpen": 1.0}}
    for side, other in (("Left", "Right"), ("Right", "Left")):
        out["eyeLookIn" + side] = {"eyeLookOut" + other: 1.0}
        out["eyeLookOut" + side] = {"eyeLookIn" + other: 1.0}
        for way in ("eyeLookUp", "eyeLookDown"):
            out[way + side] = {way + other: 1.0}
    return out


def control_targets():
    """{(control, kind): other controls that move with it}; kind: alone, with companions, mouth open."""
    out = {(c, "alone"): {} for c in CONTROLS}
    out.update({(c, "with companions"): others for c, others in companions().items()})
    out.update({("eyeBlink" + side, "mouth open"): {"jawOpen": MOUTH_OPEN} for side in ("Left", "Right")})
    return out


class Plan:
    """controls [p,52] and angles [p,3] (yaw, pitch, roll in degrees) of the images; `order` of the video; `marks`:
    the frames at which an answer is read."""

    def __init__(self):
        self.controls, self.angles, self.order, self.marks = [], [], [], {}

    def picture(self, controls=None, angles=(0, 0, 0)):
        """Number of a new image."""
        values = np.zeros(len(CONTROLS), np.float32)
        for name, value in (controls or {}).items():
            values[INDEX[name]] = value
        self.controls.append(values)
        self.angles.append(angles)
        return len(self.controls) - 1

    def show(self, number, frames, mark=None):
        self.order += [number] * frames
        if mark is not None:
            self.marks[mark] = slice(len(self.order) - READ, len(self.order))


def control_plan():
    """Every control goes 0 -> 1 -> 0; marks (control, kind) and, before it, (control, kind, "rest")."""
    plan = Plan()
    neutral = plan.picture()
    for (control, kind), others in control_targets().items():
        target = {control: 1.0, **others}
        steps = [plan.picture({c: s * v for c, v in target.items()}) for s in STEPS]
        plan.show(neutral, REST, (control, kind, "rest"))
        for k in steps[:-1]:
            plan.show(k, RISE)
        plan.show(steps[-1], HOLD, (control, kind))
        for k in steps[-2::-1]:
            plan.show(k, FALL)
    return plan


def pose_plan():
    """A neutral face turns both ways; marks ("yaw" or "pitch", degrees), and ("front", k) before every turn."""
    plan = Plan()
    front = plan.picture()
    plan.show(front, 2 * REST)
    for axis, (name, most) in enumerate((("yaw", YAW), ("pitch", PITCH))):
        for sign in (1, -1):
            plan.show(front, REST, ("front", f"{name} {sign}"))
            angles = [sign * a for a in range(ANGLE_STEP, most + 1, ANGLE_STEP)]
            pictures = [plan.picture(angles=tuple(a * (axis == k) for k in range(3))) for a in angles]
            for angle, k in zip(angles, pictures):
                plan.show(k, TURN + READ, (name, angle))
            for k in pictures[-2::-1] + [front]:
                plan.show(k, TURN)
    return plan


PLANS = {"controls": control_plan, "pose": pose_plan}
