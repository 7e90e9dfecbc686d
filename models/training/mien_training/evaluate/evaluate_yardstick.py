"""The decoder of true landmarks and head poses: an upper bound for the controls decoder behind a perfect encoder.

train_yardstick.py trains it on a stream that never repeats; the evaluation uses other people and sequences.
"""
import numpy as np
import torch

from mien_training.data.expressions import CONTROLS
from mien_training.evaluate import metrics
from mien_training.evaluate import report as out
from mien_training.evaluate.inputs import Missing
from mien_training.networks.architectures import ControlsDecoder
from mien_training.paths import cache
from mien_training.phase2 import landmark_stream
from mien_training.phase2.decoder_output import output_controls
from mien_training.phase2.decoder_scores import decode

SEQUENCES, FRAMES, SEED = 200, 90, 12345  # of the test


def trained():
    """The trained decoder, with the numbers of its steps and training sequences."""
    path = cache() / "runs/yardstick.pt"
    if not path.exists():
        raise Missing(f"{path.name} is absent: train_yardstick.py makes it (docs/training.md)")
    known, decoder = torch.load(path), ControlsDecoder(landmark_stream.KNOWN)
    decoder.load_state_dict(known["controls_decoder"])
    return decoder.eval(), known["step"], known["sequences"]


def measure(_):
    decoder, steps, sequences = trained()
    features, controls = landmark_stream.batch(landmark_stream.PointRig(), np.random.default_rng(SEED), SEQUENCES,
                                               FRAMES)
    curves, truth = output_controls(decode(decoder, features)).numpy(), controls.numpy()
    deviation = lambda values: values.reshape(-1, len(CONTROLS)).std(0)
    table = lambda values: dict(zip(CONTROLS, out.rounded(values)))
    return {"steps": steps, "trained_on": sequences, "sequences": SEQUENCES,
            "facs_error": metrics.facs_error(curves, truth),
            "constant_median": metrics.constant_errors(truth)["median"],
            "correlation": table(metrics.correlations(curves, truth)),
            "deviation_ratio": table(deviation(curves) / deviation(truth))}
