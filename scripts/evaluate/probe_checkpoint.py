#!/usr/bin/env python3
"""Range, cross-talk and winks of networks in PyTorch on the rendered probes: a quick look at checkpoints that are not exported.

The product is judged by evaluate.py response.
"""
import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "train"))
import numpy as np  # noqa: E402
import torch  # noqa: E402

import evaluate_response  # noqa: E402
import sequences as seq  # noqa: E402
from evaluate_synthetic import load_decoders  # noqa: E402
from shown import shown  # noqa: E402


def network_answers(view, decoder, supported):
    """A function (images, labels, order) -> controls [frames,52], NaN where they are not supported."""
    @torch.no_grad()
    def answers(images, labels, order):
        sequence = seq.Sequences([images], {k: torch.from_numpy(v)[None] for k, v in labels.items()})
        features = seq.track(view, sequence, torch.arange(1), seq.untouched, torch.Generator().manual_seed(0))[0]
        controls = shown(decoder(features[:, order])[0][0]).numpy()
        controls[:, ~supported] = np.nan
        return controls
    return answers


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--basenet", type=Path, required=True, help="checkpoint of the encoder")
    parser.add_argument("--hifinet", type=Path, help="checkpoint of the encoder, when it is HiFiNet's decoders that are looked at")
    parser.add_argument("--decoders", type=Path, required=True)
    parser.add_argument("--identities", type=int, default=6)
    args = parser.parse_args()
    torch.set_num_threads(1)
    view = seq.BaseNetView(args.basenet)
    if args.hifinet:
        view = seq.HiFiNetView(view, args.hifinet)
    decoders, supported = load_decoders(args.decoders)
    found = evaluate_response.collect({"networks": network_answers(view, decoders["controls"], supported)}, args.identities)
    print(evaluate_response.tables(evaluate_response.scores(found["networks"])))


if __name__ == "__main__":
    main()
