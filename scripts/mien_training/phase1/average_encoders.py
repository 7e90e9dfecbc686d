"""An encoder between two that have a common beginning (Wortsman et al. 2022, Model soups), to train on from. Its maps
are other than those of either, so the statistics of its norms are measured anew (Izmailov et al. 2018, Averaging
weights leads to wider optima).

usage: python3 -m mien_training.phase1.average_encoders basenet|hifinet OURS.pt OTHERS.pt SHARE OUT.pt      SHARE of the
       others
"""
import argparse

import torch

from mien_training.data import augment, face_batches
from mien_training.networks.architectures import FACE_NETWORKS, ConvNorm
from mien_training.networks.warm_start import save_start, set_statistics
from mien_training.phase1.train_encoder import FULL
from mien_training.phase2.blend_decoders import add_line, between

BATCHES, SIZE = 20, 128


def training_pictures(framing):
    """[n,3,h,w] in -1..1, as they are at the end of training"""
    degraded, roughness = FULL
    mixture = face_batches.Mixture(framing, face_batches.Portraits("train", framing),
                                   face_batches.Rendered("train_stills", framing=framing), None, 1,
                                real_share=0.4, roughness=roughness)
    batches = [augment.photometric(mixture.batch(SIZE).images, mixture.generator, degraded) for _ in range(BATCHES)]
    return torch.cat(batches).mul_(2).sub_(1)


@torch.no_grad()
def measure_norms(encoder, pictures):
    """Sets mean and variance of each norm from its input for these images, in one pass."""
    measure = lambda norm, inputs: set_statistics(norm, inputs[0])
    hooks = [module[1].register_forward_pre_hook(measure) for module in encoder.modules()
             if isinstance(module, ConvNorm)]
    encoder.eval()(pictures)
    for hook in hooks:
        hook.remove()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("network", choices=FACE_NETWORKS)
    add_line(parser)
    args = parser.parse_args()
    network = FACE_NETWORKS[args.network]()
    ours, others = (torch.load(path, map_location="cpu")["average"] for path in (args.ours, args.others))
    network.load_state_dict(between(ours, others, args.share))
    measure_norms(network.encoder, training_pictures(network.framing))
    save_start(network, args.out)


if __name__ == "__main__":
    main()
