#!/usr/bin/env python3
"""Decoders side by side on people that they were not trained on, to choose between them: never on the test's.

usage: compare_decoders.py --val F/val.pt --portraits-val F/portraits_val.pt --apart F/val_apart.pt [--each] DECODERS.pt...
--apart are features of validation stills in which units move apart (make_synthetic.py --split val --kind stills --apart 1, sequences.py
--hold 8): how far a control answers that is nearly at 1, and how far the other side of a pair, which is at 0, answers with it.
"""
import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "evaluate"))
import numpy as np  # noqa: E402
import torch  # noqa: E402

import metrics  # noqa: E402
from expressions import CONTROLS, MIRROR  # noqa: E402
from networks import ControlsDecoder  # noqa: E402
from shown import shown  # noqa: E402
from train_decoders import agreement_with_teacher, answers, evaluate  # noqa: E402

AT_ONE, STRONG, AT_ZERO = 0.8, 0.7, 0.01  # of a control
STREAMS = 16                               # of portraits one after the other
FEW = 3                                    # pictures, by fewer of which nothing is judged


def mean_where(values, chosen):
    """Means [52] of values [n,52] where chosen."""
    count = chosen.sum(0)
    return np.where(count >= FEW, (values * chosen).sum(0) / np.maximum(count, 1), np.nan)


def alone(decoder, apart):
    """Of units that move apart: correlation, answer at 1 as a share of the truth, answer while the other side moves; each [52]."""
    told = shown(answers(decoder, apart["features"])).numpy()[:, -1]
    truth, seen = (apart[name][:, -1].float().numpy() for name in ("controls", "visible"))
    up = (truth > AT_ONE) & (seen > 0.5)
    reached = mean_where(told, up) / mean_where(truth, up)
    sided = np.arange(len(CONTROLS)) != MIRROR
    other = mean_where(told, (truth[:, MIRROR] > STRONG) & (truth < AT_ZERO) & (seen > 0.5) & sided)
    return metrics.correlations(told[:, None], truth[:, None], seen[:, None]), reached, other


def at_once(decoder, portraits):
    """As agreement_with_teacher, [52], one frame after a face has taken the place of another, which decoders that answer late get wrong."""
    count = len(portraits["features"]) // STREAMS * STREAMS
    features = portraits["features"][:count]
    told = shown(answers(decoder, features.unflatten(0, (STREAMS, -1)).flatten(1, 2))).numpy()
    told = told.reshape(*features.shape[:2], -1)[:, 1:2]
    truth, seen = (portraits[name][:count, -1:].float().numpy() for name in ("controls", "visible"))
    return metrics.correlations(told, truth, seen)


def judge(path, val, portraits, apart):
    """(scores {name: value}, columns {name: [52]}) of a checkpoint of decoders."""
    known, decoder = torch.load(path), ControlsDecoder()
    decoder.load_state_dict(known["controls_decoder"])
    decoder.eval()
    report, supported = evaluate({"controls": decoder}, val, gaze=True, portraits=portraits, before=known["supported"].numpy())
    scores = report["every frame"]["controls"]
    rendered, teacher = np.array(list(scores["correlation"].values()), float), agreement_with_teacher(decoder, portraits)
    moving = np.where(np.isfinite(teacher), at_once(decoder, portraits), np.nan)
    followed, reached, other = alone(decoder, apart)
    return ({"rendered": np.nanmean(rendered), "teacher": np.nanmean(teacher), "at once": np.nanmean(moving), "supported": supported.sum(),
             "of them": rendered[supported].mean(), "error": scores["facs_error_supported"] / scores["constant_median_supported"],
             "jitter": scores["jitter_supported"] / scores["truth_jitter_supported"], "asymmetry": 1e3 * scores["asymmetry"],
             "apart": np.nanmean(followed), "reach 0.6": (reached[supported] > 0.6).mean(), "other side": np.nanmean(other[supported])},
            {"rendered": rendered, "teacher": teacher, "at once": moving, "apart": followed, "reached": reached, "other side": other})


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("decoders", type=Path, nargs="+")
    for name in ("val", "portraits-val", "apart"):
        parser.add_argument(f"--{name}", type=Path, required=True)
    parser.add_argument("--each", action="store_true", help="every control, too")
    args = parser.parse_args()
    torch.set_num_threads(1)
    known = [torch.load(path) for path in (args.val, args.portraits_val, args.apart)]
    judged = {path: judge(path, *known) for path in args.decoders}
    for k, path in enumerate(args.decoders):
        scores, columns = judged[path]
        if k == 0:
            print("".rjust(34) + "".join(name.rjust(12) for name in scores))
        print("/".join(path.parts[-2:])[-34:].rjust(34) + "".join(f"{value:12.3f}" for value in scores.values()), flush=True)
    for path in args.decoders if args.each else ():
        columns = judged[path][1]
        print(f"\n{path}\n" + "".rjust(22) + "".join(name.rjust(12) for name in columns))
        for i, control in enumerate(CONTROLS):
            print(control.ljust(22) + "".join(f"{values[i]:12.2f}" for values in columns.values()))


if __name__ == "__main__":
    main()
