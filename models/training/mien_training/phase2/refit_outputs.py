"""Restores the amplitude of a controls decoder by solving for its output layer, which needs few rendered people.

usage: python3 -m mien_training.phase2.refit_outputs --network basenet|hifinet --decoders DECODERS.pt --out OUT.pt
Run stream_features.py and portrait_stream.py before. Eyelids and smiles follow the portraits, where a closed eye is 1
for everyone (eyelids.py) and smiles are the teacher's; on renders their target is their previous output times a gain.
Gaze follows both: how far eyes turn is the same in both (rig.py).
Other controls that correlate with the truth and move less than it on rendered validation people get a gain around their
output at rest. Neutral portraits get at most NEUTRAL on average, rendered faces at rest at most RESTING. Eyelids get a
larger gain if winks of rendered validation people need it.
"""
import argparse
from dataclasses import dataclass
from pathlib import Path

import torch
from torch import nn

from mien_convert.atomic_files import whole
from mien_training.data.expressions import INDEX
from mien_training.data.eyelids import closures
from mien_training.networks.architectures import FACE_NETWORKS, ControlsDecoder
from mien_training.paths import cache
from mien_training.phase2 import stream_features
from mien_training.phase2.decoder_output import output_controls
from mien_training.phase2.decoder_scores import supported_now, with_stride

AIM, MOST = 0.9, 1.4      # deviation over the true one that gains aim at, and the largest gain
LEAST = 0.5               # correlation with the truth on renders, below which a gain would mostly magnify noise
FURTHEST = 1.1            # deviation over the true one that a control may reach on renders to fit portraits
NEUTRAL = 0.095           # largest mean output on neutral training portraits
RESTING = 0.03            # the same on rendered training faces at rest
WINK = (0.9, 0.1)         # of the truth: a wink has one eye above the first and the other below the second
WINKS = 10                # minimum number of frames with winks of an eye
CLOSED, OPEN = 0.9, 0.2   # mean outputs during winks: minimum of the closed eye, maximum of the open one
AT_REST = 0.08            # a face is at rest if no control exceeds this
STILL = 8                 # frames of a portrait
RIDGE = 1e-6
WINK_STEP = 0.02          # of the gains to try for winks
SMALLEST = 1e-3           # deviation of a control that hardly responds


@dataclass
class Weights:
    """Weights of the terms for the rows of the output layer."""
    portraits: float  # to agree with the portraits' labels
    renders: float    # to agree with the truth on renders
    keep: float       # of the target `gain` times the previous output
    gain: float


EYELIDS = Weights(portraits=1, renders=0, keep=0.7, gain=0.8)
SMILES = Weights(portraits=1, renders=0, keep=3, gain=1.25)
GAZE = Weights(portraits=1, renders=1, keep=0, gain=1)
KEPT_ON_PORTRAITS = 0.02  # share of `keep` there


class Parts:
    """Hidden states with a 1 behind them, [frames,97], and targets [frames,52] of tracks of renders or of portraits."""

    def __init__(self, decoder, data, still):
        features = data["features"].float()
        features = features[:, -1:].expand(-1, STILL, -1) if still else features
        hidden = torch.cat([decoder(part)[0] for part in features.split(64)])
        frames = slice(-1, None) if still else slice(None)
        self.hidden = torch.cat([hidden, torch.ones(*hidden.shape[:2], 1)], 2)[:, frames].flatten(0, 1)
        self.controls, self.seen = (data[k][:, frames].flatten(0, 1).float() for k in ("controls", "visible"))
        self.closed = closures(data["points"][:, frames].flatten(0, 1).float()) if still else None

    def square(self, control):
        """Second moments of the states [97,97] where a control can be seen."""
        return (self.hidden * self.seen[:, control:control + 1]).T @ self.hidden / self.seen[:, control].sum()

    def product(self, control, target):
        return (self.hidden * self.seen[:, control:control + 1]).T @ target / self.seen[:, control].sum()


@torch.no_grad()
def parts_of(state, stream, network):
    """(training renders, training portraits, validation renders) as the decoder's last layer sees them."""
    decoder = ControlsDecoder()
    decoder.load_state_dict(state)
    decoder.eval().output = nn.Identity()
    return (Parts(decoder, stream_features.load(stream / "train", network), False),
            Parts(decoder, stream_features.load(stream / "portraits_train", network), True),
            Parts(decoder, with_stride(stream_features.load(stream / "val", network), 1), False))


def solved(before, control, wanted, renders, portraits, weights):
    """A row [97] of the output layer in place of `before`; `wanted` [portraits] are the targets of the portraits."""
    on_renders, on_portraits = renders.square(control), portraits.square(control)
    kept = weights.keep * on_renders + KEPT_ON_PORTRAITS * weights.keep * on_portraits
    left = weights.renders * on_renders + weights.portraits * on_portraits + kept + RIDGE * torch.eye(len(before))
    right = (weights.renders * renders.product(control, renders.controls[:, control])
             + weights.portraits * portraits.product(control, wanted) + weights.gain * kept @ before)
    return torch.linalg.solve(left, right)


def neutral(portraits):
    """Portraits that are neutral according to the teacher."""
    watched = [INDEX[name] for name in ("jawOpen", "mouthSmileLeft", "mouthSmileRight", "mouthPucker")]
    return (portraits.controls[:, watched].amax(1) < AT_REST) & (portraits.closed.amax(1) < AT_REST)


def mean_answer(layer, parts, rows):
    return output_controls(parts.hidden[rows] @ layer.T).mean(0)


def resting(renders):
    return renders.controls.amax(1) < AT_REST


def at_rest(layer, renders, portraits):
    """The larger mean of rendered faces at rest and of neutral portraits, [52]."""
    return torch.maximum(mean_answer(layer, renders, resting(renders)),
                         mean_answer(layer, portraits, neutral(portraits)))


def quieted(layer, parts, rows, limit):
    """The layer with lower biases where the mean output of `rows` exceeds `limit`."""
    out = layer.clone()
    for _ in range(4):  # outputs are at least 0, so that their mean falls by less than the bias
        out[:, -1] -= (mean_answer(out, parts, rows) - limit).clamp(min=0)
    return out


def deviation_of(layer, parts):
    """Standard deviation of the predictions, [52]."""
    return output_controls(parts.hidden @ layer.T).std(0).clamp(min=SMALLEST)


def correlation(layer, renders):
    """Correlation of the predictions with the truth on renders, [52]."""
    ours, truth = (x - x.mean(0) for x in (output_controls(renders.hidden @ layer.T), renders.controls))
    return (ours * truth).mean(0) / (ours.square().mean(0) * truth.square().mean(0)).sqrt().clamp(min=SMALLEST ** 2)


def gains(layer, renders, rest):
    """Gains that bring the deviation of each control near its true deviation on renders, [52], from 1 to MOST. 1 if
    it does not correlate with the truth, or if faces at rest, `rest` [52], would exceed the limit."""
    wanted = (AIM * renders.controls.std(0) / deviation_of(layer, renders)).clamp(1, MOST)
    return torch.where((correlation(layer, renders) < LEAST) | (rest > NEUTRAL), 1, wanted)


def portrait_gain(layer, control, wanted, renders, portraits):
    """The gain that brings a control to the target deviation of portraits, limited by the renders."""
    on_portraits = wanted.std() / deviation_of(layer, portraits)[control]
    on_renders = FURTHEST * renders.controls[:, control].std() / deviation_of(layer, renders)[control]
    return torch.minimum(on_portraits, on_renders).clamp(1, MOST)


def winks(parts, closed, opened):
    """Frames with one eye closed and the other open, [frames]."""
    least, most = WINK
    seen = (parts.seen[:, closed] > 0) & (parts.seen[:, opened] > 0)
    return seen & (parts.controls[:, closed] >= least) & (parts.controls[:, opened] <= most)


def wink_gain(layer, control, other, rest, renders):
    """The gain of an eyelid that brings the closed eye of winks to CLOSED, limited by MOST and by the open eye of winks
    of the `other` side, which must stay below OPEN. 1 if there are too few winks."""
    closed, opened = winks(renders, control, other), winks(renders, other, control)
    if closed.sum() < WINKS or opened.sum() < WINKS:
        return 1.0
    answers = renders.hidden @ layer[control]
    mean = lambda rows, gain: float((rest[control] + gain * (answers[rows] - rest[control])).clamp(0, 1).mean())
    for step in range(round((MOST - 1) / WINK_STEP) + 1):
        gain = 1 + WINK_STEP * step
        if mean(opened, gain) > OPEN:
            return max(gain - WINK_STEP, 1.0)
        if mean(closed, gain) >= CLOSED:
            return gain
    return MOST


def followers(portraits):
    """(control, targets of the portraits [portraits], Weights) of controls that follow the portraits."""
    for number, side in enumerate(("Left", "Right")):
        smile = INDEX[f"mouthSmile{side}"]
        yield INDEX[f"eyeBlink{side}"], portraits.closed[:, number], EYELIDS
        yield smile, portraits.controls[:, smile], SMILES
        for direction in ("Down", "In", "Out", "Up"):
            gaze = INDEX[f"eyeLook{direction}{side}"]
            yield gaze, portraits.controls[:, gaze], GAZE


def refitted(layer, renders, portraits, others=None):
    """The output layer [52,97], bias last, in place of `layer`. `others`: renders of people that nothing was learned
    from, whose deviations the gains bring near to the true ones."""
    others = others or renders
    out, gain = layer.clone(), gains(layer, others, at_rest(layer, renders, portraits))
    for control, wanted, weights in followers(portraits):
        out[control] = solved(layer[control], control, wanted, renders, portraits, weights)
        gain[control] = portrait_gain(out, control, wanted, others, portraits)
    rest = at_rest(out, renders, portraits)
    left, right = INDEX["eyeBlinkLeft"], INDEX["eyeBlinkRight"]
    for control, other in ((left, right), (right, left)):
        gain[control] = gain[control].clamp(min=wink_gain(out, control, other, rest, others))
    out *= gain[:, None]
    out[:, -1] -= (gain - 1) * rest
    return quieted(quieted(out, renders, resting(renders), RESTING), portraits, neutral(portraits), NEUTRAL)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--network", choices=FACE_NETWORKS, required=True)
    parser.add_argument("--decoders", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--stream", type=Path, default=cache() / "stream")
    args = parser.parse_args()
    torch.set_num_threads(1)
    known = torch.load(args.decoders)
    state = known["controls_decoder"]
    parts = parts_of(state, args.stream, args.network)
    layer = refitted(torch.cat([state["output.weight"], state["output.bias"][:, None]], 1), *parts)
    known["controls_decoder"] = {**state, "output.weight": layer[:, :-1].contiguous(),
                                 "output.bias": layer[:, -1].contiguous()}
    known |= supported_now(args, known["controls_decoder"], known["supported"])
    with whole(args.out) as out:
        torch.save(known, out)


if __name__ == "__main__":
    main()
