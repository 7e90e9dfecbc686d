"""Checkpoints of the committed encoders for inference: exactly the weights of the files, with identity norms.

usage: python3 -m mien_training.networks.shipped_checkpoints FOLDER
Writes FOLDER/{basenet,hifinet}.pt and {basenet,hifinet}_decoders.pt for stream_features.py, train_decoders.py and
export.py. To continue the training of an encoder, warm_start.py creates norms that normalize.
"""
import argparse
import math
from pathlib import Path

import torch

from mien_convert.atomic_files import whole
from mien_training.networks import weight_reader
from mien_training.networks.architectures import FACE_NETWORKS
from mien_training.networks.warm_start import decoders_of, read_weights
from mien_training.paths import ROOT


def set_bias_only(norm, bias):
    """Makes a norm add a bias and do nothing else."""
    norm.running_mean.zero_()
    norm.running_var.fill_(1)
    norm.weight.fill_(math.sqrt(1 + norm.eps))
    norm.bias.copy_(bias)


@torch.no_grad()
def network_of(path, name):
    network, layers = FACE_NETWORKS[name]().eval(), weight_reader.networks(path)
    read_weights(network, layers, lambda conv_norm, layer: set_bias_only(conv_norm[1], layer.bias))
    return network


def checkpoint(path, name):
    """The fields of a checkpoint of phase 1 that stream_features.py and export.py need."""
    return {"average": network_of(path, name).state_dict(), "samples": weight_reader.metadata(path)["encoder_samples"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    args = parser.parse_args()
    args.folder.mkdir(parents=True, exist_ok=True)
    for name in FACE_NETWORKS:
        path = ROOT / f"models/{name}.mien"
        for suffix, content in (("", checkpoint(path, name)), ("_decoders", decoders_of(path))):
            with whole(args.folder / f"{name}{suffix}.pt") as out:
                torch.save(content, out)


if __name__ == "__main__":
    main()
