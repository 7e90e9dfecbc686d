"""Writes models/audionet.mien from the checkpoints of both phases, and checks that folding changes nothing.

usage: python3 -m mien_training.audio.export ENCODER.pt DECODERS.pt [--out FOLDER]
Run golden_outputs.py next.
"""
import argparse
import json
from pathlib import Path

import numpy as np
import torch
import torch.nn.functional as F

from mien_convert.atomic_files import write_whole
from mien_convert.weight_file import MienFile
from mien_training.audio.audio_net import EMBEDDING, SPEECH_CONTROLS, Encoder, activity_decoder, controls_decoder
from mien_training.audio.features import FEATURES
from mien_training.audio.golden_outputs import outputs, some_features
from mien_training.audio.jaw import INPUTS
from mien_training.data.expressions import CONTROLS
from mien_training.networks.architectures import LEAK
from mien_training.networks.export import LICENCE, loaded, plain
from mien_training.networks.round_weights import rounded
from mien_training.paths import ROOT

# Weight of audio for a control during speech with an image; video has the rest. It is larger for closed lips, which
# video shows too late and too briefly at 30 frames per second, and small for others, because audio knows few speakers:
# it predicts the jaw of other people worse than the image does (docs/results/audio.md), and with a smaller amplitude.
FROM_SOUND = dict.fromkeys(SPEECH_CONTROLS, 0.2) | {"mouthClose": 0.4, "mouthPressLeft": 0.3, "mouthPressRight": 0.3,
                                                    "mouthRollLower": 0.3, "mouthRollUpper": 0.3}
# Added to the logit of speech, because a mouth that moves to noise looks worse than one that starts late. Chosen on
# validation speech, where as many frames are correct as without it (96.3 % at 20 dB), and the mouth rests for 95 % of
# the time in all noises.
SPEECH_BIAS = -1.0


def add_lstm(net, x, lstm):
    return net.lstm(x, plain(lstm.weight_ih_l0), plain(lstm.weight_hh_l0), plain(lstm.bias_ih_l0 + lstm.bias_hh_l0))


def add_encoder(file, encoder):
    net = file.network("encoder", input=(1, 1, FEATURES))
    x = net.input
    for weight, bias in encoder.folded():
        x = net.causal_conv(x, plain(weight), plain(bias), activation="leaky_relu", alpha=LEAK)
    x = add_lstm(net, x, encoder.lstm)
    net.output(net.fully_connected(x, plain(encoder.output.weight), plain(encoder.output.bias)))


def add_decoder(file, name, decoder, activation):
    """Adds a decoder. `activation`: of the output, or softmax."""
    net = file.network(name, input=(1, 1, EMBEDDING))
    own = "none" if activation == "softmax" else activation
    x = add_temporal(net, plain(decoder.input.weight), plain(decoder.input.bias), decoder, own)
    net.output(net.softmax(x) if activation == "softmax" else x)


def add_temporal(net, weight, bias, decoder, activation):
    """Adds the layers of a decoder; `weight`, `bias`: of the first one. Returns the number of their value."""
    x = add_lstm(net, net.fully_connected(net.input, weight, bias), decoder.lstm)
    return net.fully_connected(x, plain(decoder.output.weight), plain(decoder.output.bias), activation=activation)


def add_jaw(file, decoder):
    """Adds a decoder of jaw.py."""
    net = file.network("jaw_decoder", input=(1, 1, INPUTS))
    net.output(add_temporal(net, *(plain(v) for v in decoder.folded_input()), decoder, "clamp01"))


@torch.no_grad()
def folded(encoder, x):
    """The embedding of features [n,t,130] with all norms folded into the convolutions, as in the file."""
    x = x.transpose(1, 2)
    for weight, bias in encoder.folded():
        x = F.leaky_relu(F.conv1d(F.pad(x, (1, 0)), weight, bias), LEAK)
    return encoder.output(encoder.lstm(x.transpose(1, 2))[0])


@torch.no_grad()
def whole(encoder, decoders, x):
    """[n,t,130] -> embedding, controls, activity"""
    embedding = encoder(x)[0]
    return embedding, decoders["controls"](embedding)[0].clamp(0, 1), decoders["activity"](embedding)[0].softmax(-1)


def read(encoder_path, decoders_path):
    """(encoder, {name: decoder}, state of the encoder's checkpoint), as they are exported."""
    state, trained = (torch.load(p, map_location="cpu") for p in (encoder_path, decoders_path))
    encoder = loaded(Encoder(), trained.get("encoder", state["encoder"])).eval()
    decoders = {"controls": loaded(controls_decoder(), trained["controls_decoder"]).eval(),
                "activity": loaded(activity_decoder(), trained["activity_decoder"]).eval()}
    with torch.no_grad():
        decoders["activity"].output.bias[1] += SPEECH_BIAS
    return encoder, decoders, state


def differences(said, other):
    """Largest differences of embedding, controls and activity."""
    return [(a - b).abs().max().item() for a, b in zip(said, other)]


def audionet(encoder, decoders, state):
    file = MienFile()
    add_encoder(file, encoder)
    add_decoder(file, "controls_decoder", decoders["controls"], "clamp01")
    add_decoder(file, "activity_decoder", decoders["activity"], "softmax")
    sound = np.float32([FROM_SOUND.get(c, 0) for c in CONTROLS])
    file.constant("mix_audio", sound)
    file.constant("mix_video", 1 - sound)
    file.metadata.update({"name": "audionet", "licence": LICENCE, "controls": " ".join(SPEECH_CONTROLS),
                          "encoder_seconds": str(int(state["seconds_heard"]))})
    return file


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("checkpoints", type=Path, nargs=2)
    parser.add_argument("--out", type=Path, default=ROOT / "models", help="folder")
    args = parser.parse_args()
    encoder, decoders, state = read(*args.checkpoints)
    x = some_features(200)
    said = whole(encoder, decoders, x)
    folding = (folded(encoder, x) - said[0]).abs().max().item()
    assert folding < 1e-3 * max(1.0, said[0].abs().max().item()), folding
    path = args.out / "audionet.mien"
    write_whole(path, rounded(audionet(encoder, decoders, state).to_bytes()))
    print(json.dumps({"file": path.name, "bytes": path.stat().st_size, "folding changes": folding,
                      "with rounding": differences(said, outputs(path, x))}))


if __name__ == "__main__":
    main()
