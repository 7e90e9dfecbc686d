#!/usr/bin/env python3
"""Writes mini.mien and PyTorch's outputs for the same fp16 weights, for tests/engine/golden_test.cpp.

usage: make_golden.py
Small networks with random weights use every kind of layer, built by the functions that export the trained ones; a
second "file" with the same interface evaluates them in PyTorch.
"""
from pathlib import Path

import numpy as np
import torch
import torch.nn.functional as F

from mien_convert.weight_file import MienFile
from mien_training.networks import architectures, export

HERE = Path(__file__).resolve().parent

STEPS = 6  # steps of the temporal network


def rounded(values):
    return torch.as_tensor(np.asarray(values, np.float32)).half().float()


class EagerNetwork:
    """Evaluates layers directly, with the interface of mien_file's networks. Values are tensors [1,c,h,w]."""

    def __init__(self, x):
        self.input, self.outputs, self.state = x, [], {}

    def activated(self, y, activation, alpha=0.0, slopes=None):
        functions = {"none": lambda v: v, "relu6": F.relu6, "sigmoid": torch.sigmoid,
                     "clamp01": lambda v: v.clamp(0, 1),
                     "leaky_relu": lambda v: F.leaky_relu(v, alpha), "tanh": torch.tanh, "relu": F.relu,
                     "prelu": lambda v: F.prelu(v, rounded(slopes))}
        return functions[activation](y)

    def slide(self, x, weight, bias, stride, padding, groups, activation, slopes):
        top, left, bottom, right = padding
        x = F.pad(x, (left, right, top, bottom))
        return self.activated(F.conv2d(x, rounded(weight), rounded(bias), stride, groups=groups), activation,
                              slopes=slopes)

    def conv2d(self, x, weight, bias, stride=1, padding=(0, 0, 0, 0), activation="none", slopes=None):
        return self.slide(x, weight, bias, stride, padding, 1, activation, slopes)

    def depthwise(self, x, weight, bias, stride=1, padding=(0, 0, 0, 0), activation="none"):
        return self.slide(x, weight, bias, stride, padding, x.shape[1], activation, None)

    def pointwise(self, x, weight, bias, activation="none"):
        weight = np.asarray(weight).reshape(len(bias), -1, 1, 1)
        return self.slide(x, weight, bias, 1, (0, 0, 0, 0), 1, activation, None)

    def fully_connected(self, x, weight, bias, activation="none", slopes=None):
        y = F.linear(x.flatten(1), rounded(weight), rounded(bias))
        return self.activated(y, activation, slopes=slopes)[..., None, None]

    def causal_conv(self, x, weight, bias, activation="none", alpha=0.0):
        before = self.state.get(id(weight), torch.zeros_like(x))
        both = torch.cat([before.flatten(2), x.flatten(2)], 2)
        self.next_state[id(weight)] = x
        return self.activated(F.conv1d(both, rounded(weight), rounded(bias)), activation, alpha)[..., None]

    def lstm(self, x, weight_ih, weight_hh, bias):
        hidden = np.shape(weight_hh)[1]
        h, c = self.state.get(id(weight_ih), (torch.zeros(1, hidden), torch.zeros(1, hidden)))
        gates = F.linear(x.flatten(1), rounded(weight_ih)) + F.linear(h, rounded(weight_hh)) + rounded(bias)
        i, f, g, o = gates.chunk(4, 1)
        c = torch.sigmoid(f) * c + torch.sigmoid(i) * torch.tanh(g)
        h = torch.sigmoid(o) * torch.tanh(c)
        self.next_state[id(weight_ih)] = (h, c)
        return h[..., None, None]

    def max_pool(self, x, kernel, stride, ceil_mode=False):
        return F.max_pool2d(x, kernel, stride, ceil_mode=ceil_mode)

    def add(self, a, b):
        top, left = (b.shape[2] - a.shape[2]) // 2, (b.shape[3] - a.shape[3]) // 2
        return a + b[..., top:top + a.shape[2], left:left + a.shape[3]]

    def output(self, x):
        self.outputs.append(x)


class EagerFile:
    def __init__(self, x):
        self.x = x

    def network(self, name, input, any_size=False):
        self.made = EagerNetwork(self.x)
        return self.made


def mini_encoder():
    """Every kind of block: t = 1 and larger, with and without stride, padding and residual."""
    torch.manual_seed(1)
    encoder = architectures.Encoder([(1, 1, False, 16), (2, 2, False, 8), (3, 1, True, 8), (2, 1, True, 8)], 5)
    for module in encoder.modules():
        if isinstance(module, torch.nn.BatchNorm2d):
            module.running_mean.normal_(0, 0.2)
            module.running_var.uniform_(0.5, 2)
            module.weight.data.uniform_(0.5, 1.5)
            module.bias.data.normal_(0, 0.3)
    return encoder


def add_encoder(file, encoder, side):
    net = file.network("encoder", input=(side, side, 3))
    x = export.add_conv_norm(net, net.input, encoder.body[0])
    for block in encoder.body[1:]:
        x = export.add_residual_block(net, x, block)
    expand, depthwise, project = encoder.tail
    x = export.add_conv_norm(net, export.add_conv_norm(net, x, expand), depthwise)
    net.output(net.pointwise(x, export.plain(project.weight), export.plain(project.bias), activation="none"))


def temporal_layers(rng):
    make = lambda *shape: (rng.normal(0, 0.4, shape)).astype(np.float32)
    return {"conv": make(16, 12, 2), "conv_bias": make(16), "ih": make(64, 16), "hh": make(64, 16), "gates": make(64),
            "out": make(10, 16), "out_bias": make(10)}


def add_temporal(net, layers):
    x = net.causal_conv(net.input, layers["conv"], layers["conv_bias"], activation="leaky_relu",
                        alpha=architectures.LEAK)
    x = net.lstm(x, layers["ih"], layers["hh"], layers["gates"])
    net.output(net.fully_connected(x, layers["out"], layers["out_bias"], activation="clamp01"))


def save(name, values):
    np.ascontiguousarray(values, "<f4").tofile(HERE / f"{name}.f32")


def image(rng, side):
    x = rng.uniform(-1, 1, (1, 3, side, side)).astype(np.float32)
    return x, torch.from_numpy(x)


def main():
    rng = np.random.default_rng(1)
    torch.manual_seed(2)
    encoder, pnet, _, layers = mini_encoder(), architectures.PNet(), architectures.RNet(), temporal_layers(rng)
    file = MienFile()
    side = 27
    with torch.no_grad():
        add_encoder(file, encoder, side)
        x, tensor = image(rng, side)
        eager = EagerFile(tensor)
        add_encoder(eager, encoder, side)
        save("encoder_input", x[0].transpose(1, 2, 0))
        save("encoder_output", eager.made.outputs[0])

        export.add_pnet(file, pnet)
        x, tensor = image(rng, 31)
        eager = EagerFile(tensor)
        export.add_pnet(eager, pnet)
        save("pnet_input", x[0].transpose(1, 2, 0))
        for i, y in enumerate(eager.made.outputs):
            save(f"pnet_output{i}", y[0].permute(1, 2, 0))

        temporal = file.network("temporal", input=(1, 1, 12))
        add_temporal(temporal, layers)
        eager, answers = EagerNetwork(None), []
        inputs = rng.normal(0, 1, (STEPS, 12)).astype(np.float32)
        for step in inputs:
            eager.input, eager.next_state = torch.from_numpy(step)[None, :, None, None], {}
            add_temporal(eager, layers)
            eager.state = eager.next_state
            answers.append(eager.outputs[-1].flatten())
        save("temporal_input", inputs)
        save("temporal_output", torch.stack(answers))
    file.metadata["name"] = "mini"
    file.write(HERE / "mini.mien")


if __name__ == "__main__":
    main()
