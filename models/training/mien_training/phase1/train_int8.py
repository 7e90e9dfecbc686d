"""Trains an encoder to give the same output with pointwise layers in 8-bit integers (docs/results/int8.md).

usage: python3 -m mien_training.phase1.train_int8 basenet|hifinet --out CHECKPOINT [--models FOLDER] [--steps N]
Weights and inputs of the layers are rounded in the forward pass, and the gradient passes through the rounding (Jacob et
al. 2018). The targets are the features, landmarks and controls of the encoder as it is, so no labels are needed. The
checkpoint is for export.py with the decoders of the same file; int8_layers.py then chooses layers and input bounds.
"""
import argparse
import copy
import math
import sys
from pathlib import Path

import torch
import torch.nn.functional as F
from torch import nn

from mien_convert.atomic_files import whole
from mien_training.data import face_batches
from mien_training.data.framing import FRAMINGS
from mien_training.evaluate.int8_layers import CALIBRATION, Encoder, People, rounded_weights
from mien_training.networks.shipped_checkpoints import network_of, set_bias_only
from mien_training.networks.warm_start import in_order
from mien_training.networks.weight_reader import metadata
from mien_training.paths import ROOT

BATCH, RATE, REAL_SHARE, REPORT = 32, 1e-5, 0.7, 50


def through(value, rounded):
    """`rounded`, with the gradient of `value`."""
    return value + (rounded - value).detach()


class QuantizedPointwise(nn.Module):
    """A pointwise convolution with rounded weights and inputs. `layer`: one of int8_layers.py."""

    def __init__(self, layer):
        super().__init__()
        self.layer, self.convolution = layer, layer.convolution

    def forward(self, x):
        layer, weight = self.layer, self.convolution.weight
        inside = x.clamp(layer.low * layer.bound / layer.high, layer.bound)
        return F.conv2d(through(inside, layer.quantized(x, layer.bound)), through(weight, rounded_weights(weight)),
                        self.convolution.bias)


def quantized(module, layers):
    """A copy that shares the weights, with these layers in 8 bits."""
    if module in layers:
        return QuantizedPointwise(layers[module])
    out = copy.copy(module)
    out._modules = {name: quantized(child, layers) for name, child in module.named_children()}
    return out


class Lesson:
    """The distance of features and of what the heads make of them, relative to its variance."""

    def __init__(self, encoder):
        self.heads = [lambda features: features, encoder.network.landmarks, encoder.decoder]

    def __call__(self, got, wanted):
        return sum(((head(got) - head(wanted)).square().mean(0) / head(wanted).var(0).clamp_min(1e-4)).mean()
                   for head in self.heads)


@torch.no_grad()
def checkpoint(student, path, name):
    """The fields of a checkpoint of phase 1 that export.py needs."""
    network = network_of(path, name)
    convolutions = iter([module for module in student.modules() if isinstance(module, nn.Conv2d)])
    for conv_norm in in_order(network.encoder):
        convolution = next(convolutions)
        conv_norm[0].weight.copy_(convolution.weight)
        set_bias_only(conv_norm[1], convolution.bias)
    network.encoder.tail[2].load_state_dict(next(convolutions).state_dict())
    return {"average": network.state_dict(), "samples": metadata(path)["encoder_samples"]}


def train(student, teacher, lesson, mixture, steps):
    optimizer = torch.optim.Adam(student.parameters(), RATE)
    total = 0.0
    for step in range(1, steps + 1):
        optimizer.param_groups[0]["lr"] = RATE * (1 + math.cos(math.pi * step / steps)) / 2
        images = (mixture.batch(BATCH).images * 2 - 1).contiguous(memory_format=torch.channels_last)
        with torch.no_grad():
            wanted = teacher(images)
        loss = lesson(student(images), wanted)
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        total += loss.item()
        if step % REPORT == 0:
            print(f"step {step}: loss {total / REPORT:.5f}", file=sys.stderr)
            total = 0.0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("network", choices=FRAMINGS)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--models", type=Path, default=ROOT / "models")
    parser.add_argument("--steps", type=int, default=4000)
    args = parser.parse_args()
    torch.set_num_threads(1)
    torch.manual_seed(1)
    path, framing = args.models / f"{args.network}.mien", FRAMINGS[args.network]
    encoder = Encoder(path, args.network)
    with torch.no_grad():
        encoder.calibrate(People("train", framing, CALIBRATION).images)
    encoder.network.requires_grad_(False)
    teacher = copy.deepcopy(encoder.network.encoder)
    student = quantized(encoder.network.encoder, {layer.convolution: layer for layer in encoder.layers})
    student.requires_grad_(True)
    mixture = face_batches.Mixture(framing, face_batches.Portraits("train", framing),
                                   face_batches.Rendered("train_stills", framing=framing), None, 1, REAL_SHARE)
    train(student, teacher, Lesson(encoder), mixture, args.steps)
    with whole(args.out) as out:
        torch.save(checkpoint(student, path, args.network), out)


if __name__ == "__main__":
    main()
