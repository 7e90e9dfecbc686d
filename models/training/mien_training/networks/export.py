"""Writes models/basenet.mien, hifinet.mien and proposal.mien from checkpoints.

usage: python3 -m mien_training.networks.export basenet|hifinet ENCODER.pt DECODERS.pt [--out FOLDER]
       python3 -m mien_training.networks.export proposal PNET.pt RNET.pt [--out FOLDER]
Batch norm is folded into the convolution before it; linear layers after a map use the blocked order of the map. Weights
are rounded (round_weights.py).
"""
import argparse
import json
from pathlib import Path

import torch
from torch import nn

from mien_convert.atomic_files import write_whole
from mien_convert.weight_file import MienFile
from mien_training.data import landmark_points as lp
from mien_training.data.sequences import template
from mien_training.networks import architectures
from mien_training.networks.round_weights import rounded
from mien_training.paths import ROOT

LICENCE = "Apache-2.0; trained on the data that models/README.md names"


def plain(tensor):
    return tensor.detach().float().contiguous().numpy()


def add_conv_norm(net, x, sequence):
    weight, bias = map(plain, architectures.fold(sequence))
    convolution = sequence[0]
    activation = "relu6" if sequence[1].activation else "none"
    stride, p = convolution.stride[0], convolution.padding[0]
    padding = (p, p, p, p)
    if convolution.groups > 1:
        return net.depthwise(x, weight, bias, stride=stride, padding=padding, activation=activation)
    if convolution.kernel_size == (1, 1):
        return net.pointwise(x, weight, bias, activation=activation)
    return net.conv2d(x, weight, bias, stride=stride, padding=padding, activation=activation)


def add_residual_block(net, x, block):
    y = x if isinstance(block.expand, nn.Identity) else add_conv_norm(net, x, block.expand)
    y = add_conv_norm(net, add_conv_norm(net, y, block.depthwise), block.project)
    return net.add(y, x) if block.residual else y


def add_encoder(file, encoder, framing):
    net = file.network("encoder", input=(framing.height, framing.width, 3))
    x = add_conv_norm(net, net.input, encoder.body[0])
    for block in encoder.body[1:]:
        x = add_residual_block(net, x, block)
    expand, depthwise, project = encoder.tail
    x = add_conv_norm(net, add_conv_norm(net, x, expand), depthwise)
    net.output(net.pointwise(x, plain(project.weight), plain(project.bias), activation="none"))


def add_head(file, name, linear, activation="none"):
    net = file.network(name, input=(1, 1, architectures.FEATURES))
    net.output(net.fully_connected(net.input, plain(linear.weight), plain(linear.bias), activation=activation))


def add_decoder(file, name, decoder, activation):
    net = file.network(name, input=(1, 1, architectures.FEATURES))
    x = net.input
    for convolution in decoder.convolutions:
        x = net.causal_conv(x, plain(convolution.weight), plain(convolution.bias), activation="leaky_relu",
                            alpha=architectures.LEAK)
    lstm = decoder.lstm
    x = net.lstm(x, plain(lstm.weight_ih_l0), plain(lstm.weight_hh_l0), plain(lstm.bias_ih_l0 + lstm.bias_hh_l0))
    net.output(net.fully_connected(x, plain(decoder.output.weight), plain(decoder.output.bias), activation=activation))


def loaded(module, state):
    module.load_state_dict(state)
    return module


def start(name, encoder_path, decoders):
    """A file with the common parts of BaseNet and HiFiNet, and the network."""
    state = torch.load(encoder_path, map_location="cpu")
    net = loaded(architectures.FACE_NETWORKS[name](), state["average"])
    file = MienFile()
    add_encoder(file, net.encoder, net.framing)
    add_decoder(file, "controls_decoder", loaded(architectures.ControlsDecoder(), decoders["controls_decoder"]),
                "clamp01")
    file.constant("control_supported", plain(torch.as_tensor(decoders["supported"]).float()))
    file.metadata["name"] = name
    file.metadata["licence"] = LICENCE
    file.metadata["encoder_samples"] = str(state["samples"])
    return file, net


def basenet(encoder_path, decoders_path):
    decoders = torch.load(decoders_path, map_location="cpu")
    file, net = start("basenet", encoder_path, decoders)
    add_head(file, "landmarks", net.landmarks)
    add_head(file, "face_probability", net.face, "sigmoid")
    add_decoder(file, "pose_decoder", loaded(architectures.PoseDecoder(), decoders["pose_decoder"]), "none")
    file.constant("landmark_template", plain(template()))
    file.constant("head_points", plain(torch.tensor(lp.head())))
    return file


def hifinet(encoder_path, decoders_path):
    file, net = start("hifinet", encoder_path, torch.load(decoders_path, map_location="cpu"))
    add_head(file, "landmarks", net.landmarks)
    return file


def add_small_conv(net, x, convolution, prelu):
    return net.conv2d(x, plain(convolution.weight), plain(convolution.bias), activation="prelu",
                      slopes=plain(prelu.weight))


def add_pnet(file, pnet):
    net = file.network("pnet", input=(12, 12, 3), any_size=True)
    x = add_small_conv(net, net.input, pnet.body[0], pnet.body[1])
    x = net.max_pool(x, kernel=2, stride=2, ceil_mode=True)
    x = add_small_conv(net, x, pnet.body[3], pnet.body[4])
    x = add_small_conv(net, x, pnet.body[5], pnet.body[6])
    net.output(net.pointwise(x, plain(pnet.face.weight), plain(pnet.face.bias), activation="sigmoid"))
    net.output(net.pointwise(x, plain(pnet.box.weight), plain(pnet.box.bias), activation="none"))


def add_rnet(file, rnet):
    net = file.network("rnet", input=(24, 24, 3))
    x = add_small_conv(net, net.input, rnet.body[0], rnet.body[1])
    x = net.max_pool(x, kernel=3, stride=2, ceil_mode=True)
    x = add_small_conv(net, x, rnet.body[3], rnet.body[4])
    x = net.max_pool(x, kernel=3, stride=2, ceil_mode=True)
    x = add_small_conv(net, x, rnet.body[6], rnet.body[7])
    hidden = rnet.hidden[0]
    x = net.fully_connected(x, plain(hidden.weight), plain(hidden.bias), activation="prelu",
                            slopes=plain(rnet.hidden[1].weight))
    net.output(net.fully_connected(x, plain(rnet.face.weight), plain(rnet.face.bias), activation="sigmoid"))
    net.output(net.fully_connected(x, plain(rnet.box.weight), plain(rnet.box.bias), activation="none"))


def proposal(pnet_path, rnet_path):
    pnet, rnet = architectures.PNet(), architectures.RNet()
    pnet.load_state_dict(torch.load(pnet_path, map_location="cpu"))
    rnet.load_state_dict(torch.load(rnet_path, map_location="cpu"))
    file = MienFile()
    add_pnet(file, pnet)
    add_rnet(file, rnet)
    file.metadata["name"] = "proposal"
    file.metadata["licence"] = LICENCE
    return file


FILES = {"basenet": basenet, "hifinet": hifinet, "proposal": proposal}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=FILES)
    parser.add_argument("checkpoints", type=Path, nargs=2)
    parser.add_argument("--out", type=Path, default=ROOT / "models", help="folder")
    options = parser.parse_args()
    path = options.out / f"{options.what}.mien"
    write_whole(path, rounded(FILES[options.what](*options.checkpoints).to_bytes()))
    print(json.dumps({"file": path.name, "bytes": path.stat().st_size}))


if __name__ == "__main__":
    main()
