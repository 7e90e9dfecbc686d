"""A checkpoint of phase 1 from models/audionet.mien, to continue training.

usage: python3 -m mien_training.audio.warm_start --out CHECKPOINT [--model audionet.mien]
The file has neither batch norm nor phoneme heads. New norms are measured on training speech, so that they change
nothing; new heads are trained on synthetic speech, which takes one or two minutes.
"""
import argparse
from pathlib import Path

import numpy as np
import torch

from mien_convert.atomic_files import whole
from mien_training.audio import examples, losses
from mien_training.audio.audio_net import Encoder, PhonemeHeads, activity_decoder, controls_decoder
from mien_training.audio.export import SPEECH_BIAS
from mien_training.networks import weight_reader
from mien_training.networks.weight_reader import set_linear, set_lstm, split_causal
from mien_training.paths import ROOT


def set_convolution(convolution, layer, x):
    """Sets a layer; x: [n, in, t], its input in training. Returns its output."""
    weight = split_causal(layer, convolution.convolution.in_channels)
    convolution.convolution.weight.copy_(weight)
    plain = convolution.convolution(x)
    norm = convolution.norm
    norm.running_mean.copy_(plain.mean((0, 2)))
    norm.running_var.copy_(plain.var((0, 2)))
    norm.weight.copy_(torch.sqrt(norm.running_var + norm.eps))
    norm.bias.copy_(layer.bias + norm.running_mean)
    return convolution.eval()(x)


@torch.no_grad()
def encoder_of(layers, x):
    """x: features [n, t, 130] of training scenes."""
    encoder = Encoder()
    x = x.transpose(1, 2)
    for convolution, layer in zip(encoder.convolutions, layers):
        x = set_convolution(convolution, layer, torch.cat([torch.zeros_like(x[..., :1]), x], 2))
    normalise(encoder)
    set_lstm(encoder.lstm, layers[3])
    set_linear(encoder.output, layers[4])
    return encoder.eval()


def normalise(encoder):
    """Takes the features' normalisation out of the first convolution again: trained weights are of one size then."""
    mean, deviation = examples.normalisation()
    first = encoder.convolutions[0]
    encoder.mean.copy_(mean)
    encoder.deviation.copy_(deviation)
    first.norm.running_mean.sub_((first.convolution.weight * mean.view(1, -1, 1)).sum((1, 2)))
    first.convolution.weight.mul_(deviation.view(1, -1, 1))


@torch.no_grad()
def decoder_of(decoder, layers):
    set_linear(decoder.input, layers[0])
    set_lstm(decoder.lstm, layers[1])
    set_linear(decoder.output, layers[2])
    return decoder.eval()


def heads_for(encoder, data, rng, fresh=60, epochs=12):
    """Trains new heads on `fresh` batches, each `epochs` times, with a fixed encoder."""
    heads = PhonemeHeads()
    optimizer = torch.optim.AdamW(heads.parameters(), 2e-2)
    seen = []
    for step in range(fresh * epochs):
        if step < fresh:
            features, *truth = data.make(rng)
            with torch.no_grad():
                seen.append((encoder(features)[0], truth))
        embedding, truth = seen[rng.integers(len(seen))]
        optimizer.zero_grad()
        sum(losses.phoneme_losses(*heads(embedding), *truth[:3])).backward()
        optimizer.param_groups[0]["lr"] = 2e-2 * (1 - step / (fresh * epochs))
        optimizer.step()
    return heads


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--model", type=Path, default=ROOT / "models/audionet.mien")
    args = parser.parse_args()
    torch.set_num_threads(1)
    networks = weight_reader.networks(args.model)
    data, rng = examples.PhonemeBatches("train", 48, 4.0, 1, shares={"synthetic": 1}), np.random.default_rng(1)
    encoder = encoder_of(networks["encoder"], data.make(rng)[0])
    heads = heads_for(encoder, data, rng)
    decoders = torch.nn.ModuleDict({"controls": decoder_of(controls_decoder(), networks["controls_decoder"]),
                                    "activity": decoder_of(activity_decoder(), networks["activity_decoder"])})
    with torch.no_grad():
        decoders["activity"].output.bias[1] -= SPEECH_BIAS  # which export.py adds
    args.out.parent.mkdir(parents=True, exist_ok=True)
    with whole(args.out) as out:
        torch.save({"encoder": encoder.state_dict(), "heads": heads.state_dict(), "decoders": decoders.state_dict(),
                    "seconds_heard": 0.0}, out)


if __name__ == "__main__":
    main()
