#!/usr/bin/env python3
"""Writes the networks as ONNX for other engines.

usage: export_onnx.py OUT_DIR
Writes NAME.onnx, and NAME.npz with the inputs by name, in order, and the first output, `answer`.
Networks over time run one step, with their state as inputs and outputs.
"""
import sys
from pathlib import Path

import numpy as np
import torch
from torch import nn

from mien_training.audio import audio_net
from mien_training.networks.architectures import BaseNetEncoder, HiFiNetEncoder, folded


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


def clamp_once(network):
    """ReLU6 would be exported as two operators, and engines fuse only one of them."""
    for parent in list(network.modules()):
        for name, child in parent.named_children():
            if isinstance(child, nn.ReLU6):
                setattr(parent, name, nn.Hardtanh(0, 6))
    return network


def networks():
    """name -> (network, shapes of its inputs by name)"""
    decoder_inputs = {"embedding": (1, 1, audio_net.EMBEDDING), "hidden": (1, 1, audio_net.HIDDEN),
                      "cell": (1, 1, audio_net.HIDDEN)}
    remembered = zip(("first", "second", "third"), [audio_net.FEATURES] + audio_net.WIDTHS)
    state = {"hidden": (1, 1, audio_net.WIDTHS[-1]), "cell": (1, 1, audio_net.WIDTHS[-1])}
    encoder_inputs = {"features": (1, 1, audio_net.FEATURES), **{name: (1, width, 1) for name, width in remembered},
                      **state}
    return {
        "basenet_encoder": (clamp_once(folded(BaseNetEncoder())), {"image": (1, 3, 65, 65)}),
        "hifinet_encoder": (clamp_once(folded(HiFiNetEncoder())), {"image": (1, 3, 129, 109)}),
        "audionet_encoder": (EncoderStep(), encoder_inputs),
        "audionet_controls_decoder": (DecoderStep(audio_net.controls_decoder(), nn.Hardtanh(0, 1)), decoder_inputs),
        "audionet_activity_decoder": (DecoderStep(audio_net.activity_decoder(), nn.Softmax(-1)), decoder_inputs),
    }


def main():
    out = Path(sys.argv[1])
    torch.manual_seed(1)
    for name, (network, shapes) in networks().items():
        network, inputs = network.eval(), tuple(torch.rand(shape) * 2 - 1 for shape in shapes.values())
        torch.onnx.export(network, inputs, out / f"{name}.onnx", opset_version=13, input_names=list(shapes))
        with torch.no_grad():
            answers = network(*inputs)
        first = answers[0] if isinstance(answers, tuple) else answers
        np.savez(out / f"{name}.npz", **{k: x.numpy() for k, x in zip(shapes, inputs)}, answer=first.numpy())


if __name__ == "__main__":
    main()
