"""Phase 2: the temporal decoders, on rendered sequences, with a fixed encoder.

Input are the features of sequences.py: faces tracked as in the tracker, with the encoder on every frame and on
alternate frames; decoders learn from both. A decoder of the same size without time is trained for comparison.
"""
import argparse
import copy
import json
import time
from pathlib import Path

import numpy as np
import torch
import torch.nn.functional as F
from torch import nn

from mien_convert.atomic_files import whole
from mien_training.data import head_pose
from mien_training.data.expressions import CONTROLS, MIRROR, PAIRED_LEFT, PAIRED_RIGHT
from mien_training.data.face_batches import rarity
from mien_training.evaluate import metrics
from mien_training.networks.architectures import FACE_NETWORKS, FEATURES, ControlsDecoder, PoseDecoder, TemporalDecoder
from mien_training.phase1 import losses
from mien_training.phase1.losses import censored, importance, soft_clamp, teacher_spread, unevenness
from mien_training.phase2.decoder_output import LEFT, RIGHT, output_controls

SUPPORTED_CORRELATION = 0.55  # a margin over 0.5: on other people it is a little lower
KEPT_CORRELATION = 0.5        # for controls that people rely on already
FOLLOWED_CORRELATION = 0.7    # with the teacher, on real faces, that will do alone
GAZE = np.array([name.startswith("eyeLook") for name in CONTROLS])
SPEED_BETA = 0.015  # frame differences beyond it cost linearly
LEARNED = ("features", "pose", "controls", "visible")


class FrameDecoder(nn.Module):
    """The controls decoder without time: the same widths, every frame by itself."""

    def __init__(self, features=FEATURES):
        super().__init__()
        widths = [features, 128, 128, 96, 96]
        layers = []
        for a, b in zip(widths, widths[1:]):
            layers += [nn.Linear(a, b), nn.LeakyReLU(0.1)]
        self.net = nn.Sequential(*layers, nn.Linear(96, len(CONTROLS)))

    def forward(self, x, state=None):
        return self.net(x), state


def steps(x):
    return x[:, 1:] - x[:, :-1]


def temporal_loss(predicted, target, weight, args, importance=1.0):
    """Weighted error of values and of frame differences, each squared up to a bound and linear beyond, and a small
    penalty of second differences. The bound of differences is small, because a squared penalty would reduce blinks and
    keep jitter. `importance` applies to values only, so important controls may move freely."""
    w = torch.minimum(weight[:, 1:], weight[:, :-1])
    value = 2 * args.beta * (importance * weight
                             * F.smooth_l1_loss(predicted, target, beta=args.beta, reduction="none")).mean()
    speed = (w * F.smooth_l1_loss(steps(predicted), steps(target), beta=SPEED_BETA, reduction="none")).mean()
    bend = (torch.minimum(w[:, 1:], w[:, :-1]) * steps(steps(predicted)) ** 2).mean()
    return value + args.velocity * speed + args.acceleration * bend


class ControlsTask:
    """Loss of the controls, and of the side of a pair that moves: rare controls have more weight, hidden eyes have
    none.

    The penalty of motion is `args.velocity` and `args.acceleration`. A decoder without time could reduce it only by
    smaller output, so it learns values only.
    """

    def __init__(self, data, args):
        self.args = args
        controls = data["controls"].flatten(0, 1).float()
        weight, of_sides = (1 / (values.std(0) + 0.05) for values in (controls, unevenness(controls)))
        self.weight, self.of_sides = weight / weight.mean(), self.args.sides * of_sides / weight.mean()
        self.importance = importance(args.frowns)

    def loss(self, output, batch, mask):
        target, seen = batch["controls"], batch["visible"]
        ours, both_seen = censored(output, target), torch.minimum(seen[..., PAIRED_LEFT], seen[..., PAIRED_RIGHT])
        return (temporal_loss(ours, target, self.weight * seen * mask, self.args, self.importance)
                + temporal_loss(unevenness(ours), unevenness(target), self.of_sides * both_seen * mask, self.args))


class TeacherTask:
    """Agreement with the teacher's controls on portraits, each on a scale of its own; values alone."""

    def __init__(self, data, args):
        self.args = args
        spread, follow = teacher_spread(data["controls"].flatten(0, 1).float(), losses.HINTING)
        weight = follow * importance(args.frowns) / (spread + 0.05)
        self.weight, self.line = weight / weight.mean(), losses.Line(len(CONTROLS), weight.device)

    def loss(self, output, batch, mask):
        target = batch["controls"]
        slope, offset = self.line.fit(soft_clamp(output).detach().flatten(0, 1), target.flatten(0, 1))
        ours = slope * censored(output, (target - offset) / slope) + offset
        error = F.smooth_l1_loss(ours, target, beta=self.args.beta, reduction="none")
        return self.args.teacher * 2 * self.args.beta * (self.weight * mask * error).mean()


class PoseTask:
    """Loss of the head pose; rotations are compared as matrices."""

    def __init__(self, _, args):
        self.args = args

    @staticmethod
    def expand(pose):
        return torch.cat([head_pose.orthonormalise(pose[..., :6]).flatten(-2), 2 * pose[..., 6:]], -1)

    def loss(self, output, batch, mask):
        target = batch["pose"]
        weight = mask.expand(*target.shape[:2], 12)
        drift = (output[..., :6] - target[..., :6]).square().mean()  # keeps the columns near unit length
        return temporal_loss(self.expand(output), self.expand(target), weight, self.args) + 0.05 * drift


class TeacherPoseTask:
    """Agreement with the teacher how the heads of portraits are turned, after one rotation for all."""

    def __init__(self, _, args):
        self.args, self.turn = args, losses.Turn("cpu")

    def loss(self, output, batch, mask):
        error = F.smooth_l1_loss(*self.turn.bring(output, batch["pose"]), beta=self.args.beta, reduction="none")
        return self.args.teacher * 2 * self.args.beta * (mask * error.flatten(-2)).mean()


class Moving:
    """Batches of streams of two tracks each, so that states outlive a track."""

    def __init__(self, data, args):
        self.data, self.size = {k: data[k] for k in LEARNED}, args.batch

    def batch(self):
        """(tensors [b,2*frames,c], weights [1,2*frames,1]): no weight where one face cuts to another."""
        rows = torch.randint(len(self.data["features"]), (self.size, 2))
        frames = self.data["features"].shape[1]
        mask = torch.ones(1, 2 * frames, 1)
        mask[:, 0], mask[:, frames] = 0.5, 0
        return {k: stream(v, rows) for k, v in self.data.items()}, mask


class Held:
    """Batches of faces that hold still: streams of frames drawn from a short track; many more faces than `Moving`."""

    FRAMES, ADAPTING = 10, 2

    def __init__(self, data, args, odds=None, cuts=0.0):
        """`odds` [tracks]: how often to draw each. `cuts`: how often another face takes a face's place from one frame
        to the next."""
        self.data, self.size, self.cuts = {k: data[k] for k in LEARNED}, 2 * args.batch, cuts
        self.odds = torch.ones(len(data["features"])) if odds is None else torch.as_tensor(odds, dtype=torch.float32)
        self.mask = torch.ones(1, self.FRAMES, 1)
        if cuts:
            self.mask[:, 0] = 0.5
        else:
            self.mask[:, :self.ADAPTING] = 0.25

    def batch(self):
        shape = self.size, self.FRAMES
        drawn = torch.multinomial(self.odds, self.size * self.FRAMES, replacement=True).view(shape)
        begins = torch.rand(shape) < self.cuts
        begins[:, 0] = True
        rows = drawn.gather(1, torch.where(begins, torch.arange(self.FRAMES), 0).cummax(1)[0])
        at = torch.randint(self.data["features"].shape[1], shape)
        return {k: v[rows, at].float() for k, v in self.data.items()}, self.mask


def portrait_stills(data, args, cuts=0.0):
    """Rare expressions are drawn more often, as in phase 1."""
    return Held(data, args, rarity(data["controls"][:, 0].float().cpu().numpy()), cuts)


def stream(table, rows):
    """Joins tracks rows [b,k] of a table [m,frames,c] to streams [b,k*frames,c], f32."""
    return table[rows].flatten(1, 2).float()


def mean_and_deviation(features):
    """(mean, deviation) [256] of each feature; the deviation has a lower limit."""
    flat = features[::7].flatten(0, 1).float()
    spread = flat.std(0)
    return flat.mean(0), spread + 0.1 * spread.mean()


@torch.no_grad()
def normalise_input(layer, mean, spread):
    """Scales a fresh first layer (weight [out, 256, ...]) as if every feature had mean 0 and deviation 1."""
    shape = (1, -1) + (1,) * (layer.weight.dim() - 2)
    layer.weight /= spread.view(shape)
    layer.bias -= (layer.weight * mean.view(shape)).flatten(1).sum(1)


@torch.no_grad()
def init_current_frame_bias(decoder):
    """Initializes a temporal decoder to use mainly the current frame; it learns to use earlier ones."""
    for convolution in decoder.convolutions:
        convolution.weight *= torch.tensor([0.1, 1.4])  # of the frame before, of this one
    take_in, forget, _, let_out = decoder.lstm.bias_ih_l0.chunk(4)
    take_in.fill_(1.0)
    forget.fill_(-1.0)
    let_out.fill_(1.0)


def first_layer(decoder):
    return next(m for m in decoder.modules() if isinstance(m, (nn.Linear, nn.Conv1d)))


def noisy(x, spread):
    """Features with noise of their own for every stream and for every frame."""
    return x + spread * (0.5 * torch.randn_like(x) + torch.randn(len(x), 1, x.shape[2]))


def minimise(loss_of_step, decoder, args, name, weight_decay=1e-2):
    """Fits a decoder with `args.steps` of AdamW to the results of `loss_of_step`."""
    optimiser = torch.optim.AdamW(decoder.parameters(), lr=args.rate, weight_decay=weight_decay)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, args.rate, total_steps=args.steps, pct_start=0.1)
    decoder.train()
    total, began = 0.0, time.time()
    for step in range(1, args.steps + 1):
        loss = loss_of_step()
        optimiser.zero_grad()
        loss.backward()
        nn.utils.clip_grad_norm_(decoder.parameters(), 1.0)
        optimiser.step()
        schedule.step()
        total += loss.item()
        if step % 100 == 0:
            print(f"{name} step {step} loss {total / 100:.5f} {time.time() - began:.0f} s", flush=True)
            total = 0.0
    decoder.eval()


def train(decoder, lessons, args, name):
    """Fits a decoder to (source, task) pairs, one batch of each per step."""
    torch.manual_seed(args.seed)
    mean, spread = mean_and_deviation(lessons[0][0].data["features"])
    state = f"{name}_decoder"
    known = torch.load(args.start_from).get(state) if args.start_from else None
    if known:
        decoder.load_state_dict(known)
    else:
        if isinstance(decoder, TemporalDecoder):
            init_current_frame_bias(decoder)
        normalise_input(first_layer(decoder), mean, spread)
    noise = args.noise * spread

    def lesson(source, task):
        batch, mask = source.batch()
        return task.loss(decoder(noisy(batch["features"], noise))[0], batch, mask)

    minimise(lambda: sum(lesson(*pair) for pair in lessons), decoder, args, name)
    if known:
        average_with(decoder, known, args.average_with_start)
    return decoder


@torch.no_grad()
def average_with(decoder, start, share):
    """Weighted mean with the weights at the start, which is often better than both (Wortsman et al. 2022, Robust
    fine-tuning of zero-shot models)."""
    for name, value in decoder.state_dict().items():
        value.lerp_(start[name].to(value), share)


@torch.no_grad()
def decode(decoder, features, batch=64):
    return torch.cat([decoder(f.float())[0] for f in features.split(batch)])


def symmetric_pairs(chosen):
    """(left, right) indices of the paired controls that mirror each other and are chosen."""
    return [(a, b) for a, b in zip(LEFT, RIGHT) if chosen[a] and chosen[b]]


def control_scores(curves, data, chosen):
    """Scores of controls [m,frames,52] that are already clamped; `chosen` [52] are the supported ones."""
    truth = data["controls"].float().numpy()
    constant, constant_chosen = metrics.constant_errors(truth), metrics.constant_errors(truth[..., chosen])
    pairs = symmetric_pairs(chosen)
    return {"facs_error": metrics.facs_error(curves, truth),
            "constant_mean": constant["mean"], "constant_median": constant["median"],
            "jitter": metrics.jitter(curves), "truth_jitter": metrics.jitter(truth),
            "supported": int(chosen.sum()),
            "facs_error_supported": metrics.facs_error(curves[..., chosen], truth[..., chosen]),
            "constant_mean_supported": constant_chosen["mean"],
            "constant_median_supported": constant_chosen["median"],
            "jitter_supported": metrics.jitter(curves[..., chosen]),
            "truth_jitter_supported": metrics.jitter(truth[..., chosen]),
            "asymmetry": metrics.asymmetry(curves, truth, pairs) if pairs else float("nan"),
            "correlation": dict(zip(CONTROLS, correlation_of(curves, data).round(3).tolist()))}


def correlation_of(curves, data):
    """Correlation of every control where it can be seen, [52]."""
    return metrics.correlations(curves, data["controls"].float().numpy(), data["visible"].float().numpy())


def pose_scores(output, target):
    """Errors of poses [m,frames,9] relative to the crop."""
    turn = head_pose.angle_between(head_pose.orthonormalise(output[..., :6]), head_pose.orthonormalise(target[..., :6]))
    return {"rotation_deg": turn.rad2deg().mean().item(), "rotation_p95_deg": turn.rad2deg().quantile(0.95).item(),
            "offset_of_side": (output[..., 6:8] - target[..., 6:8]).norm(dim=-1).mean().item(),
            "distance_share": (output[..., 8] - target[..., 8]).abs().mean().item()}


def check_streaming(decoder, features):
    """Frame by frame must equal the whole."""
    decoder, x = copy.deepcopy(decoder).double(), features[:4].double()
    with torch.no_grad():
        whole, state, parts = decoder(x)[0], None, []
        for t in range(x.shape[1]):
            y, state = decoder(x[:, t:t + 1], state)
            parts.append(y)
    difference = (torch.cat(parts, 1) - whole).abs().max().item()
    assert difference < 1e-9, f"streaming differs from whole by {difference}"


def with_stride(data, stride):
    chosen = data["stride"] == stride
    return {k: v[chosen] for k, v in data.items() if torch.is_tensor(v)}


def agreement_with_teacher(decoder, portraits):
    """Correlation of the controls with the teacher's on faces that hold still, [52]; nan where the teacher knows
    nothing."""
    known = teacher_spread(portraits["controls"].flatten(0, 1).float())[1].numpy() > 0
    curves = output_controls(decode(decoder, portraits["features"])).numpy()
    last = {name: portraits[name][:, -1:] for name in ("controls", "visible")}
    return np.where(known, correlation_of(curves[:, -1:], last), np.nan)


def evaluate(decoders, data, supported=None, gaze=False, portraits=None, before=None):
    """(scores, supported): scores with the encoder on every frame and on alternate frames. `gaze`: may be supported.

    Without `supported` this chooses the controls with sufficient correlation on this data, in both modes and on both
    sides of the face. With `portraits` the mean of this data and of the correlation with the teacher may suffice, or a
    high correlation with the teacher. Controls supported `before` [52] have a lower threshold, so none is lost by
    chance.
    """
    parts = {"every frame": with_stride(data, 1), "alternate frames": with_stride(data, 2)}
    kinds = [k for k in ("controls", "frame") if k in decoders]
    curves = {(m, k): output_controls(decode(decoders[k], part["features"])).numpy() for m, part in parts.items()
              for k in kinds}
    if supported is None:
        lowest = np.min([correlation_of(curves[m, "controls"], part) for m, part in parts.items()], 0)
        if portraits is not None:
            followed_by = agreement_with_teacher(decoders["controls"], portraits)
            lowest = np.fmax(lowest, (lowest + followed_by) / 2)
            lowest[np.nan_to_num(followed_by) >= FOLLOWED_CORRELATION] = 1
        asked = np.where(np.zeros(len(CONTROLS)) if before is None else before, KEPT_CORRELATION, SUPPORTED_CORRELATION)
        supported = (np.nan_to_num(lowest, nan=-1) >= asked) & (~GAZE | gaze)
        supported &= supported[MIRROR]
    report = {}
    for mode, part in parts.items():
        report[mode] = {k: control_scores(curves[mode, k], part, supported) for k in kinds}
        if "pose" in decoders:
            report[mode]["pose"] = pose_scores(decode(decoders["pose"], part["features"]), part["pose"])
    return report, supported


def options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--network", choices=FACE_NETWORKS, default="basenet",
                        help="whose features: HiFiNet's tell of gaze, and "
                        "nobody asks them for the head pose")
    parser.add_argument("--train", type=Path, nargs="+", required=True, help="features to learn from")
    parser.add_argument("--held", type=Path, nargs="*", default=[], help="features of stills (sequences.py --hold)")
    parser.add_argument("--portraits", type=Path, nargs="*", default=[],
                        help="features of real faces (portrait_features.py)")
    parser.add_argument("--start-from", type=Path, help="decoders to go on from")
    parser.add_argument("--average-with-start", type=float, default=0.0, metavar="SHARE",
                        help="of the way back to those in the end")
    parser.add_argument("--teacher", type=float, default=0.5, help="weight of what the teacher says of them")
    parser.add_argument("--val", type=Path, nargs="+", required=True,
                        help="features that choose the supported controls")
    parser.add_argument("--portraits-val", type=Path, help="features of real faces that help to choose them")
    parser.add_argument("--out", type=Path, required=True, help="checkpoint; scores go beside it as .json")
    parser.add_argument("--steps", type=int, default=1600)
    parser.add_argument("--batch", type=int, default=24)
    parser.add_argument("--rate", type=float, default=3e-3)
    parser.add_argument("--velocity", type=float, default=0.1)
    parser.add_argument("--acceleration", type=float, default=0.03)
    parser.add_argument("--frowns", type=float, default=1.0,
                        help="weight of frowns, which decoders that go on give up for what moves more often")
    parser.add_argument("--sides", type=float, default=1.0, help="weight of the loss for the side of a pair that moves")
    parser.add_argument("--beta", type=float, default=0.15, help="larger errors count linearly")
    parser.add_argument("--noise", type=float, default=0.3, help="feature noise, in deviations")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--seed", type=int, default=0)
    return parser


def arguments(**changed):
    """Default options, with changes, for callers other than the command line."""
    return argparse.Namespace(**{action.dest: action.default for action in options()._actions} | changed)


def main():
    args = options().parse_args()
    torch.set_num_threads(args.threads)
    sources = [kind(load_joined(paths), args) for kind, paths in ((Moving, args.train), (Held, args.held)) if paths]
    portraits = portrait_stills(load_joined(args.portraits), args) if args.portraits else None
    decoders = {"controls": ControlsDecoder(), "frame": FrameDecoder()}
    if args.network == "basenet":
        decoders["pose"] = PoseDecoder()
    for name, decoder in decoders.items():
        own = argparse.Namespace(**{**vars(args), "velocity": 0, "acceleration": 0}) if name == "frame" else args
        task = (PoseTask if name == "pose" else ControlsTask)(sources[0].data, own)
        lessons = [(source, task) for source in sources]
        if portraits:
            lessons.append((portraits, (TeacherPoseTask if name == "pose" else TeacherTask)(portraits.data, own)))
        train(decoder, lessons, own, name)
        check_streaming(decoder, sources[0].data["features"])
    real = torch.load(args.portraits_val) if args.portraits_val else None
    before = torch.load(args.start_from)["supported"].numpy() if args.start_from else None
    report, supported = evaluate(decoders, load_joined(args.val), gaze=args.network == "hifinet", portraits=real,
                                 before=before)
    save(args.out, {f"{name}_decoder": decoder.state_dict() for name, decoder in decoders.items()}, supported, report)


def load_joined(paths):
    """Features of several files as if they were one's."""
    parts = [torch.load(path) for path in paths]
    return {k: torch.cat([p[k] for p in parts]) for k in parts[0]}


def save(path, known, supported, report):
    """Writes a checkpoint {name: state}, and the scores beside it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with whole(path) as out:
        torch.save({**known, "supported": torch.from_numpy(supported.astype(np.float32))}, out)
    path.with_suffix(".json").write_text(json.dumps(report, indent=1) + "\n")
    for mode, scores in report.items():
        for name, values in scores.items():
            print(mode, name, json.dumps({k: v for k, v in values.items() if k != "correlation"}))


if __name__ == "__main__":
    main()
