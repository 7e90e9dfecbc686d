"""Outputs of the networks of an audionet.mien for 60 steps of features: golden files of tests/audio/audio_net_test.cpp.

usage: python3 -m mien_training.audio.golden_outputs [--model FILE.mien] [--out FOLDER]
"""
import argparse
from pathlib import Path

import numpy as np
import torch
import torch.nn.functional as F

from mien_training.audio import jaw
from mien_training.audio.audio_net import JAW
from mien_training.audio.features import RATE, features
from mien_training.networks import weight_reader
from mien_training.networks.architectures import LEAK
from mien_training.networks.weight_reader import set_lstm, split_causal
from mien_training.paths import ROOT

STEPS = 60


def some_sound(steps=STEPS):
    """Noise of varying level with the harmonics of a vowel."""
    t = np.arange(steps * 256) / RATE
    noise = np.random.default_rng(1).standard_normal(len(t))
    vowel = sum(np.sin(2 * np.pi * 120 * k * t) / k for k in range(1, 20))
    return np.float32(0.1 * np.sin(4 * t) ** 2 * (vowel + 0.2 * noise))


def some_features(steps=STEPS):
    return torch.from_numpy(np.float32(features(some_sound(steps))))[None]


def some_energies(steps=STEPS):
    return torch.from_numpy(jaw.energies(some_sound(steps)))[None]


def causal_conv(layer, x):
    weight = split_causal(layer, x.shape[-1])
    return F.leaky_relu(F.conv1d(F.pad(x.transpose(1, 2), (1, 0)), weight, layer.bias), LEAK).transpose(1, 2)


def lstm(layer, x):
    module = torch.nn.LSTM(x.shape[-1], layer.channels, batch_first=True)
    set_lstm(module, layer)
    return module(x)[0]


def fully_connected(layer, x):
    return F.linear(x, layer.weight[:, :x.shape[-1]], layer.bias)


OPS = {"causal_conv": causal_conv, "lstm": lstm, "fully_connected": fully_connected, "softmax": lambda layer,
       x: x.softmax(-1)}


def run(layers, x):
    for layer in layers:
        x = OPS[layer.op](layer, x)
    return x


def jaw_open(layers, embedding, energies):
    """jawOpen of the jaw decoder for log-mel energies [n,t,26]."""
    relative = torch.from_numpy(np.stack([jaw.relative(rows) for rows in energies.numpy()]))
    return run(layers, torch.cat([embedding, relative], -1)).clamp(0, 1)[..., 0]


def outputs(path, x, energies=None):
    """[n,t,130] -> embedding, controls and voice activity of the networks of a file. With log-mel energies [n,t,26],
    jawOpen is that of the jaw decoder, if there is one."""
    return outputs_of(weight_reader.networks(path), x, energies)


@torch.no_grad()
def outputs_of(networks, x, energies=None):
    embedding = run(networks["encoder"], x)
    controls = run(networks["controls_decoder"], embedding).clamp(0, 1)
    if energies is not None and "jaw_decoder" in networks:
        controls[..., JAW] = jaw_open(networks["jaw_decoder"], embedding, energies)
    return embedding, controls, run(networks["activity_decoder"], embedding)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--model", type=Path, default=ROOT / "models/audionet.mien")
    parser.add_argument("--out", type=Path, default=ROOT / "tests/golden/audio", help="folder")
    options = parser.parse_args()
    x, energies = some_features(), some_energies()
    _, controls, activity = outputs(options.model, x, energies)
    named = {"input": x, "log_mel": energies, "controls": controls, "activity": activity}
    for name, values in named.items():
        values[0].contiguous().numpy().tofile(options.out / f"audionet_{name}.f32")


if __name__ == "__main__":
    main()
