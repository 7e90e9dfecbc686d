"""Whether a training run is an improvement, control by control, on validation people.

usage: python3 -m mien_training.phase2.compare_runs [--each] BEFORE_FEATURES BEFORE.pt FEATURES DECODERS.pt...
FEATURES are folders with val.pt, val2.pt and val3.pt (sequences.py --plain) and portraits_val.pt (portrait_features.py
--hold 3 --plain), of the encoder of the decoders. The figure of a control is the mean of its correlations on renders
and with the teacher on portraits, where the teacher has it. A run is accepted if most of the previously supported
controls rise and none falls by more than 0.02. Brackets: standard error from a bootstrap over sequences and portraits
(Efron 1979); a fall of less than two standard errors may be chance.
"""
import argparse
from pathlib import Path

import numpy as np
import torch

from mien_training.data.expressions import CONTROLS
from mien_training.networks.architectures import ControlsDecoder
from mien_training.phase1.losses import teacher_spread
from mien_training.phase2.decoder_output import output_controls
from mien_training.phase2.train_decoders import correlation_of, decode, load_joined, with_stride

WORSE = 0.02   # a control's figure may fall by this
DRAWS = 200    # of people


def rendered_people(folder):
    return with_stride(load_joined([folder / f"{name}.pt" for name in ("val", "val2", "val3")]), 1)


def real_people(folder):
    """Portraits as constant streams; those without labels of the teacher have no weight."""
    portraits = torch.load(folder / "portraits_val.pt")
    known = teacher_spread(portraits["controls"].flatten(0, 1).float())[1] > 0
    return {**portraits, "visible": portraits["visible"].float() * known}


def figures(parts):
    """[52] of [(curves, truth)] of rendered people and of real ones: the mean of both correlations, where the teacher
    knows a control."""
    rendered, teacher = (correlation_of(curves, truth) for curves, truth in parts)
    return np.where(np.isfinite(teacher), (rendered + teacher) / 2, rendered)


class People:
    """Output of decoders on validation people."""

    def __init__(self, path, rendered, real, supported=None):
        """`supported` [52], where the checkpoint does not say."""
        known, decoder = torch.load(path), ControlsDecoder()
        decoder.load_state_dict(known["controls_decoder"])
        decoder.eval()
        self.supported = known["supported"].numpy() > 0 if supported is None else supported
        self.parts = []
        for data, frames in ((rendered, slice(None)), (real, slice(-1, None))):
            curves = output_controls(decode(decoder, data["features"])).numpy()
            self.parts.append((curves[:, frames], {name: data[name][:, frames] for name in ("controls", "visible")}))

    def drawn(self, draws):
        """The figures [52] of the people drawn from each part."""
        return figures([(curves[rows], {name: values[rows] for name, values in truth.items()})
                        for (curves, truth), rows in zip(self.parts, draws)])


def compare(before, after, draws=DRAWS):
    """(differences [52], their standard errors [52], standard error of the mean of those supported before)."""
    counts = [len(curves) for curves, _ in before.parts]
    generator, change = np.random.default_rng(1), lambda rows: after.drawn(rows) - before.drawn(rows)
    again = [change([generator.integers(0, n, n) for n in counts]) for _ in range(draws)]
    means = [np.nanmean(each[before.supported]) for each in again]
    return change([slice(None)] * len(counts)), np.nanstd(again, 0), np.std(means)


def verdict(differences, errors, error_of_mean, supported):
    """A line for a run."""
    changes = differences[supported]
    rising, fallen = (changes > 0).sum(), np.flatnonzero(supported & (differences < -WORSE))
    accepted = rising > len(changes) / 2 and not len(fallen)
    fallen = [f"{CONTROLS[i]} {differences[i]:+.3f} ({errors[i]:.3f})"
              for i in sorted(fallen, key=differences.__getitem__)]
    return (
        f"{'accepted' if accepted else 'not accepted'}: {rising} of {len(changes)} rise, mean "
        f"{np.nanmean(changes):+.4f} ({error_of_mean:.4f})"
            + (f"; fall by more than {WORSE}: {', '.join(fallen)}" if fallen else ""))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("before_features", type=Path)
    parser.add_argument("before", type=Path)
    parser.add_argument("features", type=Path)
    parser.add_argument("decoders", type=Path, nargs="+")
    parser.add_argument("--each", action="store_true", help="also prints every control")
    args = parser.parse_args()
    torch.set_num_threads(1)
    before = People(args.before, rendered_people(args.before_features), real_people(args.before_features))
    parts = rendered_people(args.features), real_people(args.features)
    for path in args.decoders:
        differences, errors, error_of_mean = compare(before, People(path, *parts))
        print(f"{path.stem.rjust(24)}  {verdict(differences, errors, error_of_mean, before.supported)}", flush=True)
        for i in np.argsort(differences) if args.each else ():
            if before.supported[i]:
                print(f"{CONTROLS[i].rjust(48)} {differences[i]:+.3f} ({errors[i]:.3f})")


if __name__ == "__main__":
    main()
