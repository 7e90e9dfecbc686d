"""HiFiNet's controls of the training portraits, from which BaseNet learns (distillation, Hinton et al. 2015).

usage: python3 -m mien_training.phase2.distil_controls [--checkpoints FOLDER]
Writes FOLDER/distilled.npz: controls [n,52], each the mean of a portrait's and of its mirror image's, and
supported bool [52]. HiFiNet follows a person who speaks better than BaseNet does (check_encoder.py), and MediaPipe's
controls depend on identity: with them, BaseNet's pucker followed this person worse.
"""
import argparse
from pathlib import Path

import numpy as np
import torch

from mien_convert.atomic_files import whole
from mien_training.data.crop_sampler import sample
from mien_training.data.expressions import MIRROR
from mien_training.data.face_batches import Portraits
from mien_training.data.framing import HIFINET
from mien_training.data.sequences import for_inference
from mien_training.paths import cache
from mien_training.phase2.decoder_output import output_controls

BATCH = 64


@torch.no_grad()
def controls(network, portraits):
    rows = []
    for start in range(0, len(portraits), BATCH):
        part = slice(start, start + BATCH)
        images = sample(portraits.images[part], portraits.crop[part], HIFINET) * 2 - 1
        plain, mirrored = (network(view)["controls"] for view in (images, images.flip(3)))
        rows.append((plain + mirrored[:, MIRROR]) / 2)
    return output_controls(torch.cat(rows))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--checkpoints", type=Path, default=cache() / "runs/shipped",
                        help="where shipped_checkpoints.py put them")
    folder = parser.parse_args().checkpoints
    network = for_inference(HIFINET.name, folder / "hifinet.pt", folder / "hifinet_decoders.pt")
    supported = torch.load(folder / "hifinet_decoders.pt")["supported"] > 0
    found = controls(network, Portraits("train", HIFINET))
    with whole(folder / "distilled.npz") as out:
        np.savez(out, controls=found, supported=supported)


if __name__ == "__main__":
    main()
