#!/usr/bin/env python3
"""Writes the networks as ONNX for other engines.

usage: export_onnx.py OUT_DIR
Writes NAME.onnx, and NAME.npz with the inputs by name, in order, and the first output, `answer`, of one or several
samples. Encoders of images have the published weights and see faces, because the accuracy of 8 bits depends on both;
NAME.npy has more faces, for calibration. Networks over time run one step, with their state as inputs and outputs.
"""
import sys
from pathlib import Path

import numpy as np
import torch
from demo_crops import crops
from torch import nn

from mien_training.audio import audio_net
from mien_training.data.framing import FRAMINGS
from mien_training.networks.architectures import folded
from mien_training.networks.shipped_checkpoints import network_of
from mien_training.paths import ROOT

SAMPLES = 4  # faces that are compared


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
        "audionet_encoder": (EncoderStep(), encoder_inputs),
        "audionet_controls_decoder": (DecoderStep(audio_net.controls_decoder(), nn.Hardtanh(0, 1)), decoder_inputs),
        "audionet_activity_decoder": (DecoderStep(audio_net.activity_decoder(), nn.Softmax(-1)), decoder_inputs),
    }


def export(network, inputs, path):
    first = [x[:1] for x in inputs.values()]
    torch.onnx.export(network, tuple(first), path, opset_version=13, input_names=list(inputs))
    with torch.no_grad():
        answers = network(*inputs.values())
    answer = answers[0] if isinstance(answers, tuple) else answers
    np.savez(path.with_suffix(".npz"), **{name: x.numpy() for name, x in inputs.items()}, answer=answer.numpy())


def main():
    out = Path(sys.argv[1])
    torch.manual_seed(1)
    for name, framing in FRAMINGS.items():
        encoder = clamp_once(folded(network_of(ROOT / f"models/{name}.mien", name).encoder)).eval()
        faces = crops(framing)
        compared = torch.linspace(0, len(faces) - 1, SAMPLES).long()
        export(encoder, {"image": faces[compared]}, out / f"{name}_encoder.onnx")
        others = torch.ones(len(faces), dtype=torch.bool).index_fill_(0, compared, False)
        np.save(out / f"{name}_encoder.npy", faces[others].numpy())
    for name, (network, shapes) in networks().items():
        export(network.eval(), {key: torch.rand(shape) * 2 - 1 for key, shape in shapes.items()}, out / f"{name}.onnx")


if __name__ == "__main__":
    main()
