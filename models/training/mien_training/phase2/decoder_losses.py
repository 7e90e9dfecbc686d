"""Losses of the temporal decoders, on tracks of rendered people and on portraits that hold still."""
import torch
import torch.nn.functional as F

from mien_training.data import head_pose
from mien_training.data.expressions import CONTROLS, INDEX
from mien_training.phase1.losses import (
    HINTING,
    Line,
    Turn,
    censored,
    importance,
    soft_clamp,
    teacher_spread,
    unevenness,
)
from mien_training.phase2.amplitude_losses import discordance, discordance_within

JOINED = 2          # tracks of a stream of renders
VELOCITY, ACCELERATION = 0.1, 0.02  # weights of differences and of second differences
CONCORDANCE = 0.05  # weight of the loss that keeps the amplitude
TEACHER = 0.5       # weight of the teacher's labels of portraits, and of the absolute values
BETA = 0.15         # larger errors count linearly
SPEED_BETA = 0.015  # the same for differences between frames
ABSOLUTE = [INDEX[name] for name in ("jawOpen", "mouthSmileLeft", "mouthSmileRight")]  # on the teacher's own scale
BLINKS = [INDEX["eyeBlinkLeft"], INDEX["eyeBlinkRight"]]


def steps(x):
    return x[:, 1:] - x[:, :-1]


def temporal_loss(predicted, target, weight, velocity=VELOCITY, acceleration=ACCELERATION, importance=1.0):
    """Weighted error of values and of frame differences, each squared up to a bound and linear beyond, and a small
    penalty of second differences. The bound of differences is small, because a squared penalty would reduce blinks and
    keep jitter. `importance` applies to values only, so important controls may move freely."""
    w = torch.minimum(weight[:, 1:], weight[:, :-1])
    value = 2 * BETA * (importance * weight * F.smooth_l1_loss(predicted, target, beta=BETA, reduction="none")).mean()
    speed = (w * F.smooth_l1_loss(steps(predicted), steps(target), beta=SPEED_BETA, reduction="none")).mean()
    bend = (torch.minimum(w[:, 1:], w[:, :-1]) * steps(steps(predicted)) ** 2).mean()
    return value + velocity * speed + acceleration * bend


class RenderTask:
    """Controls of renders: error of values and of differences, every control relative to its spread, and discordance
    within tracks and over all."""

    def __init__(self, data):
        controls = data["controls"].flatten(0, 1).float()
        weight, sides = (1 / (values.std(0) + 0.05) for values in (controls, unevenness(controls)))
        self.weight, self.sides = weight / weight.mean(), sides / weight.mean()
        self.importance = importance()

    def loss(self, output, batch, mask):
        target, seen = batch["controls"], batch["visible"] * mask
        ours = censored(output, target)
        apart = lambda x: x.unflatten(1, (JOINED, -1)).flatten(0, 1)
        within = discordance_within(apart(ours), apart(target), apart(seen))
        concordance = (within + discordance(ours, target, seen)).mean() / 2
        values = temporal_loss(ours, target, self.weight * seen, importance=self.importance)
        sides = temporal_loss(unevenness(ours), unevenness(target), self.sides * mask)
        return values + sides + CONCORDANCE * concordance


class PortraitTask:
    """Controls of portraits: the teacher's on a scale of its own each, and absolute values for smiles, jaw and
    eyelids, whose target is the aperture."""

    def __init__(self, data):
        spread, followed = teacher_spread(data["controls"].flatten(0, 1).float(), HINTING)
        weight = followed * importance() / (spread + 0.05)
        self.weight, self.line = weight / weight.mean(), Line(len(CONTROLS), weight.device)

    def loss(self, output, batch, mask):
        absolute = self.absolute(censored(output, batch["controls"]), batch, mask)
        return TEACHER * (self.relative(output, batch["controls"], mask) + absolute)

    def relative(self, output, target, mask):
        slope, offset = self.line.fit(soft_clamp(output).detach().flatten(0, 1), target.flatten(0, 1))
        ours = slope * censored(output, (target - offset) / slope) + offset
        error = F.smooth_l1_loss(ours, target, beta=BETA, reduction="none")
        return 2 * BETA * (self.weight * mask * error).mean()

    def absolute(self, ours, batch, mask):
        wanted = torch.cat([batch["controls"][..., ABSOLUTE], batch["closed"]], -1)
        told = ours[..., ABSOLUTE + BLINKS]
        weight = mask.expand(*wanted.shape).contiguous()
        error = (weight * F.smooth_l1_loss(told, wanted, beta=BETA, reduction="none")).mean()
        return error + CONCORDANCE * discordance(told, wanted, weight).mean()


class PoseTask:
    """The head pose of renders; rotations are compared as matrices."""

    def __init__(self, _):
        pass

    @staticmethod
    def expand(pose):
        return torch.cat([head_pose.orthonormalise(pose[..., :6]).flatten(-2), 2 * pose[..., 6:]], -1)

    def loss(self, output, batch, mask):
        target = batch["pose"]
        weight = mask.expand(*target.shape[:2], 12)
        drift = (output[..., :6] - target[..., :6]).square().mean()  # keeps the columns near unit length
        return temporal_loss(self.expand(output), self.expand(target), weight) + 0.05 * drift


class PortraitPoseTask:
    """Agreement with the teacher on how the heads of portraits are turned, after one rotation for all."""

    def __init__(self, data):
        self.turn = Turn(data["pose"].device)

    def loss(self, output, batch, mask):
        error = F.smooth_l1_loss(*self.turn.bring(output, batch["pose"]), beta=BETA, reduction="none")
        return TEACHER * 2 * BETA * (mask * error.flatten(-2)).mean()
