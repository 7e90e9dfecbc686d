"""Scores of controls decoders on stored features, and the controls that they support."""
import numpy as np
import torch

from mien_training.data.expressions import CONTROLS, MIRROR
from mien_training.evaluate import metrics
from mien_training.networks.architectures import ControlsDecoder
from mien_training.phase1.losses import teacher_spread
from mien_training.phase2 import stream_features
from mien_training.phase2.decoder_output import LEFT, RIGHT, output_controls

SUPPORTED_CORRELATION = 0.55  # a margin over 0.5: on other people it is a little lower
KEPT_CORRELATION = 0.5        # for controls that people rely on already
FOLLOWED_CORRELATION = 0.7    # with the teacher, on real faces, that will do alone


@torch.no_grad()
def decode(decoder, features, batch=64):
    return torch.cat([decoder(f.float())[0] for f in features.split(batch)])


def with_stride(data, stride):
    """The tracks with the encoder on every `stride`-th frame."""
    chosen = data["stride"] == stride
    return {k: v[chosen] for k, v in data.items()}


def correlation_of(curves, data):
    """Correlation of every control where it can be seen, [52]."""
    return metrics.correlations(curves, data["controls"].float().numpy(), data["visible"].float().numpy())


def control_scores(curves, data, chosen):
    """Scores of controls [m,frames,52] that are already clamped; `chosen` [52] are the supported ones."""
    truth = data["controls"].float().numpy()
    constant, constant_chosen = metrics.constant_errors(truth), metrics.constant_errors(truth[..., chosen])
    pairs = [(a, b) for a, b in zip(LEFT, RIGHT) if chosen[a] and chosen[b]]
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


def known_to_teacher(portraits):
    """Portraits with a weight only for the controls that the teacher knows."""
    known = teacher_spread(portraits["controls"].flatten(0, 1).float())[1] > 0
    return {**portraits, "visible": portraits["visible"].float() * known}


def supported_now(args, state, before):
    """{"supported": f32 [52]} of the decoder of a checkpoint, if the stream has validation people."""
    parts = [args.stream / "val", args.stream / "portraits_val"]
    if not all(part.is_dir() for part in parts):
        return {}
    decoder = ControlsDecoder()
    decoder.load_state_dict(state)
    people = (stream_features.load(part, args.network) for part in parts)
    chosen = supported_controls(decoder.eval(), *people, before.numpy() > 0)
    print(f"supported controls: {(before > 0).sum()} before, {chosen.sum()} now")
    return {"supported": torch.from_numpy(chosen.astype(np.float32))}


def supported_controls(decoder, rendered, portraits, before):
    """Which controls [52] a decoder supports, by validation people. `before` [52]: those supported so far, whose
    threshold is lower, so none is lost by chance.

    A control needs a sufficient correlation on renders with the encoder on every and on alternate frames, or in the
    mean of this and of the correlation with the teacher on portraits, or a high one on portraits; on both sides of the
    face.
    """
    output = lambda data: output_controls(decode(decoder, data["features"])).numpy()
    lowest = np.min([correlation_of(output(part), part) for part in (with_stride(rendered, s) for s in (1, 2))], 0)
    known = known_to_teacher(portraits)
    last = {name: known[name][:, -1:] for name in ("controls", "visible")}
    followed_by = correlation_of(output(known)[:, -1:], last)
    lowest = np.fmax(lowest, (lowest + followed_by) / 2)
    lowest[np.nan_to_num(followed_by) >= FOLLOWED_CORRELATION] = 1
    chosen = np.nan_to_num(lowest, nan=-1) >= np.where(before, KEPT_CORRELATION, SUPPORTED_CORRELATION)
    return chosen & chosen[MIRROR]
