"""The decoder without time, with time, and with one frame of look-ahead (Navarro et al. 2023, table 5).

Each decoder is trained on the same features with several seeds, for fewer steps than the shipped one.
"""
import numpy as np
import torch
from torch import nn

from mien_training.data.framing import FRAMINGS
from mien_training.evaluate import features, metrics
from mien_training.evaluate import report as out
from mien_training.evaluate.inputs import NETWORKS, Missing
from mien_training.networks.architectures import ControlsDecoder
from mien_training.phase2 import train_decoders as phase2

SEEDS = (0, 1, 2)
STEPS, BATCH = 400, 16
# FACS error, jitter x 1e-4, as our sources quote them
PUBLISHED = {"without time": (None, 46), "with time, causal": (0.092, 7.2)}


class LookAhead(nn.Module):
    """A temporal decoder that answers for a frame after seeing the next one; after the last, the last one again."""

    def __init__(self):
        super().__init__()
        self.decoder = ControlsDecoder()

    def forward(self, features, state=None):
        return self.decoder(torch.cat([features, features[:, -1:]], 1), state)[0][:, 1:], None


# What each costs motion: a decoder without time could only pay it by answering less (see train_decoders.py).
DECODERS = {"without time": (phase2.FrameDecoder, 0, 0), "with time, causal": (ControlsDecoder, 0.35, 0.1),
            "with one frame of look-ahead": (LookAhead, 0.35, 0.1)}


def learning_data(setting, network):
    """(moving, held) tensors that phase 2 learns from."""
    folder = setting.features.with_name(FRAMINGS[network].folder(setting.features.name))
    moving = [*sorted(folder.glob("train*.pt")), *sorted(folder.glob("plain*.pt"))]
    held = sorted(folder.glob("held*.pt"))
    if not moving:
        raise Missing(
            f"no train*.pt in the folder {folder.name} of features: make them with sequences.py (continue_training.sh)")
    return [phase2.load_joined(paths) for paths in (moving, held) if paths]


def arguments(seed, velocity, acceleration):
    return phase2.arguments(steps=STEPS, batch=BATCH, velocity=velocity, acceleration=acceleration, noise=0.2,
                            seed=seed)


def train(name, seed, learned):
    kind, velocity, acceleration = DECODERS[name]
    args = arguments(seed, velocity, acceleration)
    torch.manual_seed(seed)
    sources = [source(part, args) for source, part in zip((phase2.Moving, phase2.Held), learned)]
    task = phase2.ControlsTask(sources[0].data, args)
    return phase2.train(kind(), [(source, task) for source in sources], args, f"{name}, seed {seed}")


def measure_network(setting, network):
    """{decoder: {metric: [of every seed]}} with the encoder on every frame."""
    learned, data = learning_data(setting, network), phase2.with_stride(features.of(setting, network, plain=True), 1)
    chosen = torch.load(setting.checkpoint(network)[1], map_location="cpu")["supported"].numpy() > 0.5
    truth, report = data["controls"].float().numpy(), {}
    for name in DECODERS:
        rows = []
        for seed in SEEDS:
            curves = phase2.output_controls(phase2.decode(train(name, seed, learned), data["features"])).numpy()
            correlation = phase2.correlation_of(curves, data)[chosen]
            rows.append({"facs_error": metrics.facs_error(curves, truth), "jitter": metrics.jitter(curves),
                         "facs_error_supported": metrics.facs_error(curves[..., chosen], truth[..., chosen]),
                         "jitter_supported": metrics.jitter(curves[..., chosen]),
                         "correlation": float(np.nanmean(correlation))})
        report[name] = {key: [r[key] for r in rows] for key in rows[0]}
    return {"decoders": report, "truth_jitter": metrics.jitter(truth), "supported": int(chosen.sum()), "steps": STEPS}


def measure(setting):
    torch.set_num_threads(1)
    report = {}
    for name in setting.levels("ablation"):
        try:
            report[name] = measure_network(setting, NETWORKS[name])
        except Missing as missing:
            setting.skip(f"ablation, {NETWORKS[name]}", missing)
    if not report:
        raise Missing("neither network's features and checkpoints are here")
    return report


def share_of(key):
    """A figure of the causal decoder relative to that without state, mean over networks."""
    mean = lambda r, kind: np.mean(r["decoders"][kind][key])
    return lambda report: np.mean([mean(r, "with time, causal") / mean(r, "without time") for r in report.values()])


jitter_share, error_share = share_of("jitter"), share_of("facs_error")


def spread(values, scale=1, digits=4):
    """Mean and standard deviation over the seeds."""
    return f"{scale * np.mean(values):.{digits}f} ± {scale * np.std(values, ddof=1):.{digits}f}"


def markdown(report):
    published = PUBLISHED["with time, causal"]
    lines = ["# Decoders with and without state", "", "For trainers.", ""] + out.prose(f"""A causal decoder has
        {jitter_share(report):.2f} of the jitter of a decoder without state, and {error_share(report):.2f} of its error.
        The data are rendered test sequences, with the encoder on every frame and {len(SEEDS)} seeds each (mean ±
        standard deviation); decoders were trained for {STEPS} steps. Navarro et al. (2023, table 5) report, on other
        data, an error of {published[0]} and a jitter of {published[1]}e-4 with the causal decoder, and a jitter of
        {PUBLISHED["without time"][1]}e-4 without state.""")
    for name, r in report.items():
        rows = [[kind, spread(v["facs_error"]), spread(v["jitter"], 1e4, 1), spread(v["facs_error_supported"]),
                 spread(v["jitter_supported"], 1e4, 1), spread(v["correlation"], 1, 3)]
                for kind, v in r["decoders"].items()]
        lines += [f"## {NETWORKS[name]}", "",
                  *out.prose(f"The truth has a jitter of {1e4 * r['truth_jitter']:.1f}e-4.")]
        lines += out.table(["decoder", "error, all 52", "jitter x 1e-4, all 52", f"error, {r['supported']} supported",
                            "jitter x 1e-4, supported", "mean correlation, supported"], rows)
    return "\n".join(lines)
