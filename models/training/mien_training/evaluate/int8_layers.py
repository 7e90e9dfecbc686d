"""Chooses the pointwise layers of an encoder that may have 8-bit inputs, from a simulation on portraits.

usage: python3 -m mien_training.evaluate.int8_layers basenet|hifinet [--models FOLDER] [--out FILE.mien]
Training portraits determine the input bounds (docs/format.md), by the mean square error of rounding and saturation.
Then layers get 16 bits, those with the largest error per multiplication first, until validation portraits meet the
targets; after that, those that turn out not to need them get 8 bits again. Errors of landmarks are relative to the
distance between the pupils. --out writes the file with the bounds of the chosen layers.
"""
import argparse
import contextlib
import struct
from pathlib import Path

import numpy as np
import torch
from torch import nn

from mien_convert.atomic_files import write_whole
from mien_convert.weight_file import OPS, RECORD_BYTES, sealed
from mien_training.data import face_batches, landmark_points, sequences
from mien_training.data.framing import FRAMINGS
from mien_training.evaluate import metrics
from mien_training.networks import architectures, warm_start
from mien_training.networks.shipped_checkpoints import network_of
from mien_training.paths import ROOT

CALIBRATION = 512                                      # training portraits
VALUES = 1 << 13                                       # of each, that determine a layer's bound
LANDMARKS, CONTROLS, CORRELATION = 0.001, 0.004, 0.01  # targets: largest differences
MOVES = 0.02                                           # least deviation of a control whose correlation counts


class People:
    """Inputs of an encoder, landmarks in crop coordinates and the teacher's controls of portraits."""

    def __init__(self, split, framing, count=None):
        found = face_batches.Portraits(split, framing)
        rows = np.linspace(0, len(found) - 1, count or len(found)).astype(int)
        crop, window = found.crop[rows], lambda i: torch.from_numpy(found.images[i:i + 1].copy()).permute(0, 3, 1, 2)
        self.images = torch.cat([sequences.sample_crops(window(i) / 255, one[None], framing) * 2 - 1
                                 for i, one in zip(rows, crop)])
        self.landmarks = face_batches.to_crop(crop, found.landmarks[rows])
        self.controls = found.controls[rows].numpy()


def rounded_weights(weight):
    """The weights of each output in multiples of 1/127 of the largest."""
    scale = weight.abs().amax(1, keepdim=True).clamp_min(1e-20) / 127
    return torch.round(weight / scale) * scale


class Layer:
    """A pointwise convolution; inside `with`, its weights and inputs have 8 bits."""

    def __init__(self, name, convolution):
        self.name, self.convolution, self.exact = name, convolution, convolution.weight.data
        after_relu6 = name.endswith("project.0") or name == "tail.2"
        self.low, self.high = (0, 255) if after_relu6 else (-127, 127)
        self.bound, self.work, self.values = None, 0, []
        self.rounded = rounded_weights(self.exact)

    def sample(self, _, inputs):
        flat, self.work = inputs[0].flatten(), self.exact.numel() * inputs[0][0, 0].numel()
        self.values.append(flat[torch.cat([flat.abs().argmax()[None], torch.randint(len(flat), (VALUES,))])])

    def quantized(self, values, bound):
        return torch.round(values * (self.high / bound)).clamp(self.low, self.high) * (bound / self.high)

    def choose_bound(self):
        values, self.values = torch.cat(self.values), []
        error = lambda bound: float((self.quantized(values, bound) - values).square().mean())
        self.bound = min((values.abs().max() * torch.linspace(0.3, 1, 29)).tolist(), key=error)

    def __enter__(self):
        self.convolution.weight.data = self.rounded
        self.hook = self.convolution.register_forward_pre_hook(lambda _, x: (self.quantized(x[0], self.bound),))

    def __exit__(self, *_):
        self.convolution.weight.data = self.exact
        self.hook.remove()


class Encoder:
    def __init__(self, path, name):
        self.network, decoders = network_of(path, name), warm_start.decoders_of(path)
        self.network.encoder = sequences.faster(self.network.encoder)
        self.decoder = architectures.StillDecoder(architectures.ControlsDecoder(), decoders["controls_decoder"], False)
        self.supported = decoders["supported"].bool().numpy()
        self.layers = [Layer(name, module) for name, module in self.network.encoder.named_modules()
                       if isinstance(module, nn.Conv2d) and module.kernel_size == (1, 1)]

    def features(self, images, layers=()):
        """With these layers in 8 bits."""
        with contextlib.ExitStack() as quantized:
            for layer in layers:
                quantized.enter_context(layer)
            return torch.cat([self.network.encoder(part.contiguous(memory_format=torch.channels_last))
                              for part in images.split(16)])

    def calibrate(self, images):
        hooks = [layer.convolution.register_forward_pre_hook(layer.sample) for layer in self.layers]
        for image in images:
            self.network.encoder(image[None])
        for layer, hook in zip(self.layers, hooks):
            hook.remove()
            layer.choose_bound()

    def answers(self, features, people):
        controls = self.decoder(features).clamp(0, 1).numpy()
        return (self.network.landmarks(features).unflatten(1, (-1, 2)), controls,
                metrics.correlations(controls, people.controls))

    def compare(self, people, exact, layers):
        """Differences with these layers in 8 bits: landmark error, landmarks, controls, the worst correlation."""
        before, after = self.answers(exact, people), self.answers(self.features(people.images, layers), people)
        right, left = (people.landmarks[:, landmark_points.POSITION[iris[0]]] for iris in landmark_points.IRIS)
        pupils = (right - left).norm(dim=-1).clamp_min(0.1)  # of a profile, they are close together
        error = lambda a, b: float(((a - b).norm(dim=-1).mean(1) / pupils).mean())
        moved = self.supported & (people.controls.std(0) > MOVES)
        return (error(after[0], people.landmarks) - error(before[0], people.landmarks), error(after[0], before[0]),
                np.abs(after[1] - before[1])[:, self.supported].mean(), (after[2] - before[2])[moved].min())


def meets_targets(differences):
    error, _, controls, correlation = differences
    return error <= LANDMARKS and controls <= CONTROLS and correlation >= -CORRELATION


def choose(encoder, people, exact):
    error = {layer: (encoder.features(people.images, [layer]) - exact).square().sum() for layer in encoder.layers}
    chosen, dropped = sorted(encoder.layers, key=lambda layer: error[layer] / layer.work), []
    fits = lambda layers: meets_targets(encoder.compare(people, exact, layers))
    while not fits(chosen):
        dropped.append(chosen.pop())
    for layer in dropped[:-1]:
        chosen = chosen + [layer] if fits(chosen + [layer]) else chosen
    return chosen


def with_bounds(file, bounds):
    """The bytes of a weight file with these input bounds of the encoder's pointwise layers."""
    out, networks = bytearray(file), struct.unpack_from("<I", file, 20)[0]
    layers = RECORD_BYTES * (1 + networks) + RECORD_BYTES * np.arange(struct.unpack_from("<I", file, 24)[0])
    pointwise = [at for at in layers if struct.unpack_from("<H", file, at)[0] == OPS["pointwise"]]
    struct.pack_into("<H", out, 10, 3)  # minor version
    for at, bound in zip(pointwise, bounds, strict=True):
        struct.pack_into("<f", out, at + 60, bound)
    return sealed(bytes(out))


@torch.no_grad()
def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("network", choices=FRAMINGS)
    parser.add_argument("--models", type=Path, default=ROOT / "models")
    parser.add_argument("--out", type=Path)
    args = parser.parse_args()
    torch.set_num_threads(1)
    torch.manual_seed(1)
    path, framing = args.models / f"{args.network}.mien", FRAMINGS[args.network]
    encoder = Encoder(path, args.network)
    encoder.calibrate(People("train", framing, CALIBRATION).images)
    people, test = People("val", framing), People("test", framing)
    exact = encoder.features(people.images)
    chosen = choose(encoder, people, exact)
    for layer in encoder.layers:
        precision = f"8 bits up to {layer.bound:.2f}" if layer in chosen else "16 bits"
        print(f"{layer.name:18} {layer.work:9,} multiplications, {precision}")
    share = sum(layer.work for layer in chosen) / sum(layer.work for layer in encoder.layers)
    print(f"{len(chosen)} of {len(encoder.layers)} layers, {100 * share:.1f} % of the multiplications")
    for name, group, features in (("val", people, exact), ("test", test, encoder.features(test.images))):
        error, moved, controls, correlation = encoder.compare(group, features, chosen)
        print(f"{name}: landmark error {100 * error:+.3f} %, landmarks move {100 * moved:.2f} %, controls differ by "
              f"{controls:.4f}, correlations by {correlation:+.3f} at worst")
    if args.out:
        bounds = [layer.bound if layer in chosen else 0.0 for layer in encoder.layers]
        write_whole(args.out, with_bounds(path.read_bytes(), bounds))


if __name__ == "__main__":
    main()
