#!/usr/bin/env python3
"""An encoder between two that have a common beginning (Wortsman et al. 2022, Model soups), to train on from. Its maps are other than those of
either, so the statistics of its norms are measured anew (Izmailov et al. 2018, Averaging weights leads to wider optima).

usage: average_encoders.py basenet|hifinet ENCODER.pt OTHER.pt SHARE OUT.pt      SHARE of the other
"""
import argparse
from pathlib import Path

import torch

import augment
import face_data
from networks import FACE_NETWORKS, ConvNorm
from train_encoder import FULL
from whole_files import whole

BATCHES, SIZE = 20, 128


def between(ours, others, share):
    """A state on the line between two."""
    return {name: value.lerp(others[name].to(value), share) if value.is_floating_point() else value for name, value in ours.items()}


def training_pictures(framing):
    """[n,3,h,w] in -1..1, as they are at the end of training"""
    degraded, roughness = FULL
    mixture = face_data.Mixture(framing, face_data.Portraits("train", framing), face_data.Rendered("train_stills", framing=framing), None, 1,
                                real_share=0.4, roughness=roughness)
    batches = [augment.photometric(mixture.batch(SIZE).images, mixture.generator, degraded) for _ in range(BATCHES)]
    return torch.cat(batches).mul_(2).sub_(1)


@torch.no_grad()
def measure_norms(encoder, pictures):
    """Every norm gets the mean and variance of what it is given of these pictures, and answers by them at once."""
    def measure(norm, inputs):
        norm.running_mean.copy_(inputs[0].mean((0, 2, 3)))
        norm.running_var.copy_(inputs[0].var((0, 2, 3)))

    hooks = [module[1].register_forward_pre_hook(measure) for module in encoder.modules() if isinstance(module, ConvNorm)]
    encoder.eval()(pictures)
    for hook in hooks:
        hook.remove()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("network", choices=FACE_NETWORKS)
    parser.add_argument("encoder", type=Path)
    parser.add_argument("other", type=Path)
    parser.add_argument("share", type=float)
    parser.add_argument("out", type=Path)
    args = parser.parse_args()
    network = FACE_NETWORKS[args.network]()
    ours, others = (torch.load(path, map_location="cpu")["average"] for path in (args.encoder, args.other))
    network.load_state_dict(between(ours, others, args.share))
    measure_norms(network.encoder, training_pictures(network.framing))
    state = network.own_state()
    with whole(args.out) as out:
        torch.save({"network": state, "average": state, "samples": 0}, out)


if __name__ == "__main__":
    main()
