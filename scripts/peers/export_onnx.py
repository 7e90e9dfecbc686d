#!/usr/bin/env python3
"""Writes the encoders as ONNX files for other engines to time.  usage: export_onnx.py OUT_DIR"""
import sys
from pathlib import Path

import torch

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "train"))
from networks import BaseNetEncoder  # noqa: E402

ENCODERS = {"basenet_encoder": (BaseNetEncoder, (1, 3, 65, 65))}


def main():
    out = Path(sys.argv[1])
    for name, (network, shape) in ENCODERS.items():
        path = out / f"{name}.onnx"
        torch.manual_seed(1)
        # In evaluation mode the exporter folds batch norm into the convolution before it.
        torch.onnx.export(network().eval(), torch.zeros(shape), path, opset_version=13,
                          input_names=["image"], output_names=["features"])


if __name__ == "__main__":
    main()
