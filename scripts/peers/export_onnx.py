#!/usr/bin/env python3
"""Writes networks as ONNX files for other engines to time, and shapes.json: the inputs of each.  usage: export_onnx.py OUT_DIR

Networks over time take one step: what they remember comes in and goes out with it.
"""
import json
import sys
from pathlib import Path

import torch
from torch import nn

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "train"))
from networks import BaseNetEncoder, HiFiNetEncoder  # noqa: E402
from voice import audio_net  # noqa: E402


class EncoderStep(nn.Module):
    def __init__(self):
        super().__init__()
        self.encoder = audio_net.Encoder()

    def forward(self, features, first, second, third, hidden, cell):
        embedding, (following, state) = self.encoder(features, ([first, second, third], (hidden, cell)))
        return (embedding, *following, *state)


class DecoderStep(nn.Module):
    def __init__(self, decoder, head):
        super().__init__()
        self.decoder, self.head = decoder, head

    def forward(self, embedding, hidden, cell):
        outputs, state = self.decoder(embedding, (hidden, cell))
        return (self.head(outputs), *state)


def networks():
    """name -> (network, shapes of its inputs by name)"""
    decoder_inputs = {"embedding": (1, 1, audio_net.EMBEDDING), "hidden": (1, 1, audio_net.HIDDEN), "cell": (1, 1, audio_net.HIDDEN)}
    remembered = zip(("first", "second", "third"), [audio_net.FEATURES] + audio_net.WIDTHS)
    state = {"hidden": (1, 1, audio_net.WIDTHS[-1]), "cell": (1, 1, audio_net.WIDTHS[-1])}
    encoder_inputs = {"features": (1, 1, audio_net.FEATURES), **{name: (1, width, 1) for name, width in remembered}, **state}
    return {
        "basenet_encoder": (BaseNetEncoder(), {"image": (1, 3, 65, 65)}),
        "hifinet_encoder": (HiFiNetEncoder(), {"image": (1, 3, 129, 109)}),
        "audionet_encoder": (EncoderStep(), encoder_inputs),
        "audionet_controls_decoder": (DecoderStep(audio_net.controls_decoder(), nn.Hardtanh(0, 1)), decoder_inputs),
        "audionet_activity_decoder": (DecoderStep(audio_net.activity_decoder(), nn.Softmax(-1)), decoder_inputs),
    }


def main():
    out = Path(sys.argv[1])
    torch.manual_seed(1)
    shapes = {}
    for name, (network, inputs) in networks().items():
        # In evaluation mode the exporter folds batch norm into the convolution before it.
        torch.onnx.export(network.eval(), tuple(torch.zeros(shape) for shape in inputs.values()), out / f"{name}.onnx",
                          opset_version=13, input_names=list(inputs))
        shapes[name] = inputs
    (out / "shapes.json").write_text(json.dumps(shapes) + "\n")


if __name__ == "__main__":
    main()
