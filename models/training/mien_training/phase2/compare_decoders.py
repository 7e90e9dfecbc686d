"""Whether decoders are an improvement on validation people, control by control and in amplitude.

usage: python3 -m mien_training.phase2.compare_decoders --network basenet|hifinet [--before-stream FOLDER] BEFORE.pt
       DECODERS.pt...
The validation people are the parts val and portraits_val of streams (stream_features.py, portrait_stream.py);
--before-stream is that of the previous encoder, if the encoder has changed. The figure of a control is the mean of its
correlations on renders and with the teacher on portraits, where the teacher has it. Decoders are accepted if most of
the previously supported controls rise and none falls by more than 0.02. Brackets: standard error from a bootstrap over
sequences and portraits (Efron 1979); a fall of less than two standard errors may be chance. The second line: error
relative to the best constant's, mean correlation, median relative deviation, the number of controls whose relative
deviation is within 0.8 and 1.25, largest mean of a control on rendered faces at rest; on portraits eyeBlink of closed
eyes and mouthSmile where the teacher's is at least 0.6.
"""
import argparse
from pathlib import Path

import numpy as np
import torch

from mien_training.data.expressions import CONTROLS, INDEX
from mien_training.data.eyelids import closures
from mien_training.evaluate import metrics
from mien_training.networks.architectures import FACE_NETWORKS, ControlsDecoder
from mien_training.paths import cache
from mien_training.phase2 import stream_features
from mien_training.phase2.decoder_output import output_controls
from mien_training.phase2.decoder_scores import correlation_of, decode, known_to_teacher, with_stride

WORSE = 0.02     # a control's figure may fall by this
DRAWS = 200      # of people
AT_REST = 0.05   # a rendered face is at rest where no control is above it


def figures(parts):
    """[52] of [(curves, truth)] of rendered people and of real ones: the mean of both correlations, where the teacher
    knows a control."""
    rendered, teacher = (correlation_of(curves, truth) for curves, truth in parts)
    return np.where(np.isfinite(teacher), (rendered + teacher) / 2, rendered)


class People:
    """Output of decoders on validation people: rendered ones and portraits."""

    def __init__(self, path, rendered, portraits, supported=None):
        """`supported` [52], where the checkpoint does not say."""
        known, decoder = torch.load(path), ControlsDecoder()
        decoder.load_state_dict(known["controls_decoder"])
        decoder.eval()
        self.supported = known["supported"].numpy() > 0 if supported is None else supported
        self.portraits, self.parts = portraits, []
        for data, frames in ((rendered, slice(None)), (portraits, slice(-1, None))):
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
    """A line about decoders."""
    changes = differences[supported]
    rising, fallen = (changes > 0).sum(), np.flatnonzero(supported & (differences < -WORSE))
    accepted = rising > len(changes) / 2 and not len(fallen)
    fallen = [f"{CONTROLS[i]} {differences[i]:+.3f} ({errors[i]:.3f})"
              for i in sorted(fallen, key=differences.__getitem__)]
    return (f"{'accepted' if accepted else 'not accepted'}: {rising} of {len(changes)} rise, mean "
            f"{np.nanmean(changes):+.4f} ({error_of_mean:.4f})"
            + (f"; fall by more than {WORSE}: {', '.join(fallen)}" if fallen else ""))


def amplitude(people):
    """A line about how far faces move."""
    (curves, truth), (real, labels) = people.parts
    target = truth["controls"].float().numpy()
    error = metrics.facs_error(curves, target) / metrics.constant_errors(target)["median"]
    correlation = np.nan_to_num(correlation_of(curves, truth))
    ratio = curves.reshape(-1, len(CONTROLS)).std(0) / target.reshape(-1, len(CONTROLS)).std(0)
    rest = curves[target.max(-1) < AT_REST]
    closed = closures(people.portraits["points"][:, -1].float()).numpy() > 0.9
    blinks = real[:, -1][:, [INDEX["eyeBlinkLeft"], INDEX["eyeBlinkRight"]]][closed]
    smiling = labels["controls"][:, -1, INDEX["mouthSmileLeft"]].numpy() >= 0.6
    smiles = real[:, -1, INDEX["mouthSmileLeft"]][smiling]
    return (f"error {error:.3f}, correlation {correlation.mean():.3f}, {(correlation >= 0.5).sum()} reach 0.5; "
            f"deviation {np.median(ratio):.2f}, {((ratio > 0.8) & (ratio < 1.25)).sum()} within range; at rest "
            f"{rest.mean(0).max() if len(rest) else np.nan:.3f} ({len(rest)}); "
            f"closed eyes {blinks.mean():.2f} ({len(blinks)}); smiles {np.median(smiles):.2f} ({len(smiles)})")


def validation_people(stream, network):
    return (with_stride(stream_features.load(stream / "val", network), 1),
            known_to_teacher(stream_features.load(stream / "portraits_val", network)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--network", choices=FACE_NETWORKS, required=True)
    parser.add_argument("--stream", type=Path, default=cache() / "stream")
    parser.add_argument("--before-stream", type=Path, help="of the encoder of BEFORE; default: the same")
    parser.add_argument("before", type=Path)
    parser.add_argument("decoders", type=Path, nargs="+")
    args = parser.parse_args()
    torch.set_num_threads(1)
    before = People(args.before, *validation_people(args.before_stream or args.stream, args.network))
    print(f"{'before'.rjust(20)}  {amplitude(before)}")
    parts = validation_people(args.stream, args.network)
    for path in args.decoders:
        after = People(path, *parts, before.supported)
        print(f"{path.stem.rjust(20)}  {verdict(*compare(before, after), before.supported)}\n"
              f"{' ' * 22}{amplitude(after)}", flush=True)


if __name__ == "__main__":
    main()
