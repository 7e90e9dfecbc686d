"""Whether decoders are an improvement on validation people, amplitude included: streamed renders and portraits.

usage: python3 -m mien_training.phase2.compare_streamed --network basenet|hifinet BEFORE.pt DECODERS.pt...
The first line of each is the verdict of compare_runs.py. The second: error relative to the best constant's, mean
correlation, median relative deviation, the number of controls whose relative deviation is within 0.8 and 1.25, largest
mean of a control on rendered faces at rest; on portraits eyeBlink of closed eyes and mouthSmile where the teacher's is
at least 0.6.
"""
import argparse
from pathlib import Path

import numpy as np
import torch

from mien_training.data.expressions import CONTROLS, INDEX
from mien_training.data.eyelids import closures
from mien_training.networks.architectures import FACE_NETWORKS
from mien_training.paths import cache
from mien_training.phase1.losses import teacher_spread
from mien_training.phase2 import stream_features
from mien_training.phase2.compare_runs import People, compare, verdict
from mien_training.phase2.train_decoders import correlation_of, metrics, with_stride

AT_REST = 0.05   # a rendered face is at rest where no control is above it


def known_to_teacher(portraits):
    known = teacher_spread(portraits["controls"].flatten(0, 1).float())[1] > 0
    return {**portraits, "visible": portraits["visible"].float() * known}


def amplitude(people, portraits):
    """A line of how far faces move."""
    (curves, truth), (real, _) = people.parts
    target = truth["controls"].float().numpy()
    error = metrics.facs_error(curves, target) / metrics.constant_errors(target)["median"]
    correlation = np.nan_to_num(correlation_of(curves, truth))
    ratio = curves.reshape(-1, len(CONTROLS)).std(0) / target.reshape(-1, len(CONTROLS)).std(0)
    rest = curves[target.max(-1) < AT_REST]
    closed = closures(portraits["points"][:, -1].float()).numpy() > 0.9
    blinks = real[:, -1][:, [INDEX["eyeBlinkLeft"], INDEX["eyeBlinkRight"]]][closed]
    smiling = portraits["controls"][:, -1, INDEX["mouthSmileLeft"]].numpy() >= 0.6
    smiles = real[:, -1, INDEX["mouthSmileLeft"]][smiling]
    return (
        f"error {error:.3f}, correlation {correlation.mean():.3f}, {(correlation >= 0.5).sum()} of them 0.5; deviation "
        f"{np.median(ratio):.2f}, "
            f"{((ratio > 0.8) & (ratio < 1.25)).sum()} right; at rest "
            f"{rest.mean(0).max() if len(rest) else np.nan:.3f} ({len(rest)}); "
            f"closed eyes {blinks.mean():.2f} ({len(blinks)}); smiles {np.median(smiles):.2f} ({len(smiles)})")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--network", choices=FACE_NETWORKS, required=True)
    parser.add_argument("--stream", type=Path, default=cache() / "stream")
    parser.add_argument("--each", action="store_true", help="also prints every control")
    parser.add_argument("before", type=Path)
    parser.add_argument("decoders", type=Path, nargs="+")
    args = parser.parse_args()
    torch.set_num_threads(1)
    rendered = with_stride(stream_features.load(args.stream / "val", args.network), 1)
    portraits = known_to_teacher(stream_features.load(args.stream / "portraits_val", args.network))
    before = People(args.before, rendered, portraits)
    print(f"{'before'.rjust(20)}  {amplitude(before, portraits)}")
    for path in args.decoders:
        after = People(path, rendered, portraits, before.supported)
        differences, errors, error_of_mean = compare(before, after)
        print(
            f"{path.stem.rjust(20)}  "
            f"{verdict(differences, errors, error_of_mean, before.supported)}\n{' ' * 22}{amplitude(after, portraits)}")
        for i in np.argsort(differences) if args.each else ():
            print(
                f"{CONTROLS[i].rjust(40)} {differences[i]:+.3f} "
                f"({errors[i]:.3f}){'' if before.supported[i] else ' not supported before'}")


if __name__ == "__main__":
    main()
