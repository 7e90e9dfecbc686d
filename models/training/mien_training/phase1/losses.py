"""Losses of phase 1: landmarks, their consistency, face probability, and controls and pose in training only.

Portraits have labels of a teacher (MediaPipe) for controls and pose, with a scale for each control and another frontal
direction. Linear maps and a rotation convert the network's output to them, so the network learns the differences
between faces from the teacher, and not its offsets.
"""
import torch
import torch.nn.functional as F

from mien_training.data import head_pose
from mien_training.data import landmark_points as lp
from mien_training.data.expressions import CONTROLS, PAIRED_LEFT, PAIRED_RIGHT
from mien_training.data.face_batches import to_crop
from mien_training.data.sequences import crop_to_image, fit_crop, template
from mien_training.phase1.within_people import Within, from_own_mean

# Lids, lips, irises and brows carry the expression.
POINT_WEIGHTS = {"eye": 2.0, "iris": 1.5, "lips": 2.0, "brow": 1.5}

# Pairs whose distance is an expression: lids, lips, brows above eyes (teacher indices).
OPENINGS = [(159, 145), (158, 153), (160, 144), (386, 374), (385, 380), (387, 373), (13, 14), (82, 87), (312, 317),
            (80, 88), (310, 318), (61, 291), (105, 159), (334, 386), (107, 336)]

IMPORTANCE = {"jawOpen": 10.0, "eyeBlinkLeft": 4.0, "eyeBlinkRight": 4.0}  # the most visible controls
RESPONDING = 0.03       # minimum spread of a teacher's control on portraits whose correlation is measured
# minimum spread to learn from; funnel, mouthClose and jawRight move little but correctly
HINTING = 0.015
NOT_FOLLOWED = ("eyeSquintLeft", "eyeSquintRight")  # they rest at 0.4, and rise with a smile
TEACHER_WEIGHT = 2.0
SMALLEST_SPREAD = 0.08  # of a control, so that one that hardly moves does not dominate the sum
SMALLEST_KEPT = 0.01    # the same in `kept`
AT_END = 0.01           # targets as close as this to 0 or 1 count as 0 or 1


def point_weights():
    found = [next((w for key, w in POINT_WEIGHTS.items() if key in name.split("_")[:2]), 1.0)
             for name, _ in lp.named_points()]
    weights = torch.tensor(found)
    return weights / weights.mean()


def importance():
    """How much every control counts, [52]."""
    return torch.tensor([IMPORTANCE.get(name, 1.0) for name in CONTROLS])


def lids_of_controls():
    """[175,52]: which landmarks must be seen for an eye's controls to be seen, as shares of one."""
    out = torch.zeros(len(lp.TEACHER), len(CONTROLS))
    for side in ("Left", "Right"):
        lids = [i for i, (name, _) in enumerate(lp.named_points()) if name.startswith(side.lower() + "_eye_")]
        for i, name in enumerate(CONTROLS):
            if name.startswith("eye") and name.endswith(side):
                out[lids, i] = 1 / len(lids)
    return out


def soft_clamp(x):
    """Clamp to 0..1 that keeps a little gradient outside."""
    inside = x.clamp(0, 1)
    return inside + 0.05 * (x - inside)


def censored(x, target):
    """Controls x for comparison with their targets. Where a target is 0, all values below 0 are correct and keep a
    small gradient; the same holds above 1 for targets of 1 (Tobin 1958). Elsewhere values outside 0..1 are errors: with
    clamping, controls of people whose rest the decoder estimates below 0 would hardly learn and stay at 0."""
    at_end = ((x < 0) & (target <= AT_END)) | ((x > 1) & (target >= 1 - AT_END))
    return torch.where(at_end, soft_clamp(x), x)


def unevenness(controls):
    """Left minus right control of each pair: [...,52] -> [...,pairs]."""
    return controls[..., PAIRED_LEFT] - controls[..., PAIRED_RIGHT]


def of_portraits(batch):
    """Rows of portraits that show a face well, bool [n]."""
    return batch.has_landmarks & ~batch.has_controls


class Line:
    """For every control the linear map from our output to the teacher's, by running means."""

    def __init__(self, n, device, decay=0.98):
        # of x, y, x x, x y
        self.decay, self.means = decay, torch.tensor([0.0, 0.0, 1.0, 1.0], device=device).repeat(n, 1)

    @torch.no_grad()
    def fit(self, x, y):
        """x, y [rows,n]; (slope [n], offset [n])"""
        now = torch.stack([x.mean(0), y.mean(0), (x * x).mean(0), (x * y).mean(0)], 1)
        self.means.lerp_(now, 1 - self.decay)
        mx, my, xx, xy = self.means.T
        slope = ((xy - mx * my) / (xx - mx * mx).clamp(min=1e-4)).clamp(0.3, 3.0)
        return slope, my - slope * mx


class Turn:
    """The rotation from our definition of a head that looks ahead to the teacher's, by a running mean."""

    def __init__(self, device, decay=0.98):
        self.decay, self.mean = decay, torch.eye(3, device=device)

    @torch.no_grad()
    def fit(self, ours, theirs):
        """Rotations [rows,3,3]; the rotation [3,3] that brings ours to theirs (Kabsch 1976)."""
        self.mean.lerp_((ours.transpose(1, 2) @ theirs).mean(0), 1 - self.decay)
        u, _, vt = torch.linalg.svd(self.mean)
        return u @ torch.diag(torch.stack([self.mean.new_ones(()), self.mean.new_ones(()), torch.det(u @ vt)])) @ vt

    def bring(self, ours, theirs):
        """Poses [...,9] -> our rotations [...,3,3], brought to the teacher's, and the teacher's."""
        ours, theirs = (head_pose.orthonormalise(pose[..., :6]) for pose in (ours, theirs))
        return ours @ self.fit(ours.detach().flatten(0, -3), theirs.flatten(0, -3)), theirs


def teacher_spread(controls, least=RESPONDING):
    """Standard deviation [52] of each of the teacher's controls [n,52] on portraits, at least `least`, and whether it
    exceeds `least` and the control is reliable [52]."""
    spread = controls.std(0)
    trusted = torch.tensor([name not in NOT_FOLLOWED for name in CONTROLS], device=controls.device)
    return spread.clamp(min=least), (spread > least) & trusted


class Losses:
    def __init__(self, framing, eye_distance, device):
        self.framing, self.unit = framing, eye_distance  # in crop coordinates
        self.points = point_weights().to(device)
        self.pairs = torch.tensor([[lp.POSITION[a], lp.POSITION[b]] for a, b in OPENINGS], device=device)
        self.lids, self.template = lids_of_controls().to(device), template().to(device)
        self.of_eye = self.lids.sum(0) > 0
        self.spread = torch.ones(len(CONTROLS), device=device)
        self.side_spread = torch.ones(len(PAIRED_LEFT), device=device)
        self.importance = importance().to(device)
        self.line, self.turn, self.differences = Line(len(CONTROLS), device), Turn(device), Within()
        self.teacher_spread, self.followed = torch.ones(len(CONTROLS)), torch.zeros(len(CONTROLS))

    def learn_spread(self, rendered):
        """Controls count relative to their spread, so that rare ones are worth learning."""
        if len(rendered):
            controls = torch.cat([torch.from_numpy(labels["controls"]) for _, labels in rendered.shards]).float()
            self.spread = controls.std(0).clamp(min=SMALLEST_SPREAD).to(self.spread)
            self.side_spread = unevenness(controls).std(0).clamp(min=SMALLEST_SPREAD).to(self.spread)

    def learn_teacher(self, portraits):
        self.teacher_spread, followed = (v.to(self.spread.device)
                                         for v in teacher_spread(portraits.controls, HINTING))
        self.followed = followed & portraits.learned.to(followed)

    def distance(self, predicted, truth):
        """A rounded absolute value, in eye distances: like a squared error near zero, not ruled by outliers."""
        d = (predicted - truth) / self.unit
        return torch.sqrt(d.square().sum(-1) + 1e-4) - 1e-2

    def landmarks(self, out, batch):
        weights = self.points * (0.3 + 0.7 * batch.visible) * batch.has_landmarks[:, None]
        positional = (self.distance(out, batch.landmarks) * weights).sum() / weights.sum()
        gap = lambda p: p[:, self.pairs[:, 0]] - p[:, self.pairs[:, 1]]
        openings = self.distance(gap(out), gap(batch.landmarks))[batch.has_landmarks]
        return positional + 0.7 * openings.mean()

    def consistency(self, first, second, crop):
        """Landmarks must move with the image (Honari et al. 2018): `second` belongs to `crop` of the first's image."""
        return self.distance(second, to_crop(crop, self.framing.to_pixels(first))).mean()

    def alignment(self, out, batch):
        """The tracker fits the next crop to the landmarks, so errors of their position, size and roll add up."""
        rows = batch.has_landmarks
        weights = 0.3 + 0.7 * batch.visible[rows].mean(1)
        crops = (fit_crop(self.template, points[rows]) for points in (out, batch.landmarks))
        error = self.distance(*(crop_to_image(crop, self.template.expand(len(crop), -1, -1)) for crop in crops))
        return (error.mean(1) * weights).sum() / weights.sum()

    def told(self, batch):
        """Controls that are visible and labelled, bool [n,52]; those of an eye only if the eye is visible."""
        return (~self.of_eye | (batch.visible @ self.lids > 0.5)) & batch.has_controls[:, None]

    def controls(self, out, batch):
        """Squared where it is small, in spreads."""
        weights = self.told(batch) * self.importance
        ours = censored(out, batch.controls)
        error = F.smooth_l1_loss(ours / self.spread, batch.controls / self.spread, beta=2.0, reduction="none")
        return (error * weights).sum() / weights.sum().clamp(min=1)

    def within(self, out, batch):
        """Discordance of the differences between faces of one person, on renders."""
        weights = self.told(batch).float()
        ours, truth = (from_own_mean(values, weights, batch.person)
                       for values in (censored(out, batch.controls), batch.controls))
        return (self.differences.loss(ours, truth, weights) * self.importance).sum() / self.importance.sum()

    def sides(self, out, batch):
        """Which side moves. Most faces are symmetric, so the loss of controls alone hardly requires it."""
        told = self.told(batch)
        weights = told[:, PAIRED_LEFT] & told[:, PAIRED_RIGHT]
        error = F.smooth_l1_loss(out / self.side_spread, unevenness(batch.controls) / self.side_spread, beta=2.0,
                                 reduction="none")
        return (error * weights).sum() / weights.sum().clamp(min=1)

    def teacher(self, out, batch):
        """Agreement with the teacher on portraits, in its spreads."""
        rows = of_portraits(batch)
        weights = self.importance * self.followed
        if not rows.any() or not weights.any():
            return out.sum() * 0
        target = batch.controls[rows]
        slope, offset = self.line.fit(soft_clamp(out[rows]).detach(), target)
        error = (slope * censored(out[rows], (target - offset) / slope) + offset - target) / self.teacher_spread
        loss = F.smooth_l1_loss(error, torch.zeros_like(error), reduction="none") * batch.trust[rows]
        return (loss.mean(0) * weights).sum() / weights.sum()

    def pose(self, out, batch):
        weights = batch.has_controls[:, None].float()
        error = F.smooth_l1_loss(out, batch.pose, beta=0.1, reduction="none")
        return (error * weights).sum() / (9 * weights.sum()).clamp(min=1)

    def teacher_pose(self, out, batch):
        """Agreement with the teacher's head rotation on portraits."""
        rows = of_portraits(batch)
        if not rows.any():
            return out.sum() * 0
        return F.smooth_l1_loss(*self.turn.bring(out[rows], batch.pose[rows]), beta=0.1)

    def kept(self, controls, before):
        """Agreement of the controls of portraits [n,52] with those that the initial weights predict, in the spreads of
        these (learning without forgetting, Li and Hoiem 2016)."""
        error = (controls - before) / before.std(0).clamp(min=SMALLEST_KEPT)
        return F.smooth_l1_loss(error, torch.zeros_like(error))

    def total(self, out, batch):
        return (2 * self.landmarks(out["landmarks"], batch) + 3 * self.alignment(out["landmarks"], batch) + 0.5
                * F.binary_cross_entropy_with_logits(out["face"], batch.face)
                + 8 * self.controls(out["controls"], batch) + 4 * self.within(out["controls"], batch)
                + 4 * self.sides(out["sides"], batch)
                + 2 * self.sides(unevenness(censored(out["controls"], batch.controls)), batch)
                + TEACHER_WEIGHT * self.teacher(out["controls"], batch)
                + 2 * self.pose(out["pose"], batch) + 2 * self.teacher_pose(out["pose"], batch))
