"""Adds a jaw decoder to an audionet.mien, or replaces it. The other networks keep their weights.

usage: python3 -m mien_training.audio.add_jaw JAW.pt [--model FILE.mien]
Run golden_outputs.py afterwards, which writes the expected outputs of a test.
"""
import argparse
import json
from pathlib import Path

import torch

from mien_convert.atomic_files import write_whole
from mien_training.audio import export
from mien_training.audio.audio_net import EMBEDDING, WIDTHS, activity_decoder, controls_decoder
from mien_training.audio.features import FEATURES
from mien_training.audio.jaw import JawDecoder
from mien_training.audio.warm_start import decoder_of
from mien_training.networks import weight_reader
from mien_training.networks.export import loaded
from mien_training.networks.round_weights import rounded
from mien_training.paths import ROOT


class StoredEncoder(torch.nn.Module):
    """The encoder of a file, in the form that export.add_encoder expects."""

    @torch.no_grad()
    def __init__(self, layers):
        super().__init__()
        self.layers = layers[:len(WIDTHS)]
        self.lstm = torch.nn.LSTM(WIDTHS[-1], WIDTHS[-1], batch_first=True)
        self.output = torch.nn.Linear(WIDTHS[-1], EMBEDDING)
        weight_reader.set_lstm(self.lstm, layers[-2])
        weight_reader.set_linear(self.output, layers[-1])

    def folded(self):
        inputs = [FEATURES, *WIDTHS]
        return [(weight_reader.split_causal(layer, n), layer.bias) for layer, n in zip(self.layers, inputs)]


def with_jaw(model, decoder):
    """The file `model` as a MienFile with this jaw decoder."""
    networks = weight_reader.networks(model)
    decoders = {"controls": decoder_of(controls_decoder(), networks["controls_decoder"]),
                "activity": decoder_of(activity_decoder(), networks["activity_decoder"])}
    state = {"seconds_heard": int(weight_reader.metadata(model)["encoder_seconds"])}
    file = export.audionet(StoredEncoder(networks["encoder"]), decoders, state)
    export.add_jaw(file, decoder)
    return file


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("jaw", type=Path, help="checkpoint of train_jaw.py")
    parser.add_argument("--model", type=Path, default=ROOT / "models/audionet.mien")
    args = parser.parse_args()
    decoder = loaded(JawDecoder(), torch.load(args.jaw, map_location="cpu"))
    write_whole(args.model, rounded(with_jaw(args.model, decoder).to_bytes()))
    print(json.dumps({"file": args.model.name, "bytes": args.model.stat().st_size}))


if __name__ == "__main__":
    main()
