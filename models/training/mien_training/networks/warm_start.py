"""A checkpoint of phase 1 from models/basenet.mien or hifinet.mien, to continue training.

usage: python3 -m mien_training.networks.warm_start --network basenet|hifinet --out CHECKPOINT
The file has neither batch norm nor the heads that exist only in training. New norms are measured layer by layer on
training faces, so they change nothing at first; the heads are solved for on rendered faces (ridge regression).
"""
import argparse
from pathlib import Path

import torch

from mien_convert.atomic_files import whole
from mien_training.data import face_batches
from mien_training.networks import weight_reader
from mien_training.networks.architectures import FACE_NETWORKS, ControlsDecoder, ConvNorm, InvertedResidual, PoseDecoder
from mien_training.networks.weight_reader import set_linear, set_lstm, split_causal
from mien_training.paths import ROOT
from mien_training.phase1.losses import unevenness

PICTURES = 384      # that norms are measured on
LESSONS = 4000      # rendered faces that the heads are solved for on
RIDGE = 1e-2        # of the features' variance


def in_order(encoder):
    """The ConvNorms in the order in which export.py writes them."""
    for part in (*encoder.body, *encoder.tail):
        if isinstance(part, InvertedResidual):
            yield from (p for p in (part.expand, part.depthwise, part.project) if isinstance(p, ConvNorm))
        elif isinstance(part, ConvNorm):
            yield part


def weight_of(layer, convolution):
    out, channels, kh, kw = convolution.weight.shape
    if layer.op == "depthwise":
        return layer.weight.view(-1, kh, kw, 8).permute(0, 3, 1, 2).reshape(-1, 1, kh, kw)[:out]
    if layer.op == "pointwise":
        return layer.weight[:, :channels].reshape(out, channels, 1, 1)
    return layer.weight[:, :kh * kw * channels].reshape(out, kh, kw, channels).permute(0, 3, 1, 2)


def read_weights(network, layers, place):
    """Copies the weights of a file to a network; `place` puts those of a layer into a ConvNorm."""
    encoder = iter([layer for layer in layers["encoder"] if layer.weight is not None])
    for conv_norm, layer in zip(in_order(network.encoder), encoder):
        conv_norm[0].weight.copy_(weight_of(layer, conv_norm[0]))
        place(conv_norm, layer)
    last, project = next(encoder), network.encoder.tail[2]
    project.weight.copy_(weight_of(last, project))
    project.bias.copy_(last.bias)
    set_linear(network.landmarks, layers["landmarks"][0])
    if "face_probability" in layers:
        set_linear(network.face, layers["face_probability"][0])


class Measure:
    """Sets the norm behind a convolution from the first images, so its output has the bias of the file."""

    def __init__(self, conv_norm, layer):
        self.bias = layer.bias
        self.hook = conv_norm[1].register_forward_pre_hook(self.see)

    def see(self, norm, inputs):
        norm.running_mean.copy_(inputs[0].mean((0, 2, 3)))
        norm.running_var.copy_(inputs[0].var((0, 2, 3)))
        norm.weight.copy_(torch.sqrt(norm.running_var + norm.eps))
        norm.bias.copy_(self.bias + norm.running_mean)
        self.hook.remove()


def rendered_faces(mixture, count, size=250):
    return [mixture.part(mixture.rendered, size, 0.0) for _ in range(0, count, size)]


def solve(linear, features, targets):
    """Ridge regression of targets [n,m] on features [n,256]."""
    x, mean = features - features.mean(0), targets.mean(0)
    square = x.T @ x
    weight = torch.linalg.solve(square + RIDGE * square.diagonal().mean() * torch.eye(len(square)),
                                x.T @ (targets - mean)).T
    linear.weight.copy_(weight)
    linear.bias.copy_(mean - weight @ features.mean(0))


@torch.no_grad()
def network_of(path, name):
    torch.manual_seed(1)
    network, layers = FACE_NETWORKS[name](), weight_reader.networks(path)
    framing = network.framing
    mixture = face_batches.Mixture(framing, face_batches.Portraits("train", framing),
                                   face_batches.Rendered("train_stills", framing=framing), None, 1)
    network.eval()
    read_weights(network, layers, Measure)
    network.encoder(mixture.batch(PICTURES).images * 2 - 1)
    lessons = rendered_faces(mixture, LESSONS)
    features = torch.cat([network.encoder(part.images * 2 - 1) for part in lessons])
    solve(network.controls, features, torch.cat([part.controls for part in lessons]))
    solve(network.pose, features, torch.cat([part.pose for part in lessons]))
    solve(network.sides, features, unevenness(torch.cat([part.controls for part in lessons])))
    return network


@torch.no_grad()
def decoder_of(decoder, layers):
    for convolution, layer in zip(decoder.convolutions, layers):
        convolution.weight.copy_(split_causal(layer, convolution.in_channels))
        convolution.bias.copy_(layer.bias)
    set_lstm(decoder.lstm, layers[-2])
    set_linear(decoder.output, layers[-1])
    return decoder.state_dict()


def decoders_of(path):
    """A checkpoint like that of train_decoders.py, with the fields that export.py needs."""
    layers, kinds = weight_reader.networks(path), {"controls_decoder": ControlsDecoder, "pose_decoder": PoseDecoder}
    return {**{name: decoder_of(kind(), layers[name]) for name, kind in kinds.items() if name in layers},
            "supported": weight_reader.constant(path, "control_supported")}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--network", choices=FACE_NETWORKS, required=True)
    parser.add_argument("--out", type=Path, required=True)
    options = parser.parse_args()
    torch.set_num_threads(1)
    state = network_of(ROOT / f"models/{options.network}.mien", options.network).state_dict()
    options.out.parent.mkdir(parents=True, exist_ok=True)
    with whole(options.out) as out:
        torch.save({"network": state, "average": state, "samples": 0}, out)


if __name__ == "__main__":
    main()
