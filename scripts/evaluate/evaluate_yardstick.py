"""How well a decoder that knows the true landmarks and head pose answers: what the controls decoder could do behind a perfect encoder.

train_yardstick.py trains it on a stream that never repeats; here it meets other people and performances.
"""
import json

import numpy as np
import torch

import landmark_stream
import metrics
import report as out
import train_decoders as phase2
from expressions import CONTROLS
from networks import ControlsDecoder
from paths import cache
from setting import Missing

SEQUENCES, FRAMES, SEED = 200, 90, 12345  # of the test


def trained():
    """The decoder, and after how many steps and sequences."""
    path = cache() / "runs/yardstick.pt"
    if not path.exists():
        raise Missing(f"{path.name} is absent: train_yardstick.py makes it (docs/training.md)")
    known, decoder = torch.load(path), ControlsDecoder(landmark_stream.KNOWN)
    decoder.load_state_dict(known["controls_decoder"])
    return decoder.eval(), known["step"], known["sequences"]


def ours(setting):
    """{level: {control: correlation}} of the part `synthetic`, where it was measured."""
    path = setting.out / "synthetic.json"
    results = json.loads(path.read_text())["results"] if path.exists() else {}
    return {level: r["program"]["correlation"] for level, r in results.items()}


def measure(setting):
    decoder, steps, sequences = trained()
    features, controls = landmark_stream.batch(landmark_stream.PointRig(), np.random.default_rng(SEED), SEQUENCES, FRAMES)
    curves, truth = phase2.shown(phase2.answers(decoder, features)).numpy(), controls.numpy()
    deviation = lambda values: values.reshape(-1, len(CONTROLS)).std(0)
    table = lambda values: dict(zip(CONTROLS, out.rounded(values)))
    return {"steps": steps, "trained_on": sequences, "sequences": SEQUENCES, "facs_error": metrics.facs_error(curves, truth),
            "constant_median": metrics.constant_errors(truth)["median"], "correlation": table(metrics.correlations(curves, truth)),
            "deviation_ratio": table(deviation(curves) / deviation(truth)), "ours": ours(setting)}


def markdown(report):
    levels, known, ratio = report["ours"], report["correlation"], report["deviation_ratio"]
    number = lambda value: out.number(np.nan if value is None else value)
    rows = [[c, number(known[c]), number(ratio[c]), *(number(of.get(c)) for of in levels.values())]
            for c in sorted(known, key=known.get, reverse=True)]
    enough = sum(v >= 0.5 for v in known.values())
    return "\n".join(["# A decoder that knows the true landmarks", ""] + out.prose(f"""The controls decoder, given the true 175 landmarks
        and the true head pose instead of features of a picture, trained for {report["steps"]} steps on {report["trained_on"]} sequences of
        landmarks without pictures (`train_yardstick.py`), and tested on {report["sequences"]} sequences of other people; beside it what the
        program answers to pictures of rendered test sequences ([synthetic](synthetic.md)). A dash: not supported. The error is
        {report["facs_error"] / report["constant_median"]:.2f} times the best constant's, the mean correlation of all 52 controls
        {np.mean(list(known.values())):.2f}; {enough} of them reach 0.5. The median ratio of the predicted to the true standard deviation is
        {np.median(list(ratio.values())):.2f}. Nearly all that the rig does is in the points and their motion: what the program does not tell
        is lost by the encoders, or by decoders that saw too few people.""")
        + out.table(["control", "from true landmarks", "standard deviation / the true one", *(f"{level}, from pictures" for level in levels)], rows))
