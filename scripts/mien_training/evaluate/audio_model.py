"""AudioNet as in the model file (folded, fp16 weights), run on whole recordings."""

import numpy as np
import torch

from mien_training.audio import export, golden_outputs, jaw, recognition
from mien_training.audio.audio_net import SPEECH_CONTROLS
from mien_training.audio.features import features, seconds_of_steps
from mien_training.networks import weight_reader

INDEX = {name: i for i, name in enumerate(SPEECH_CONTROLS)}


class Model:
    """`split`: val for selection or test for results."""

    def __init__(self, encoder_path, decoders_path, split="test"):
        self.split = split
        torch.set_num_threads(1)
        encoder, decoders, state = export.read(encoder_path, decoders_path)
        self.folded = export.Folded(encoder, decoders)
        self.heard = state["seconds_heard"]
        self.encoder, self.heads = recognition.load(encoder_path)

    def __call__(self, sound):
        """Of f32 [samples] at 16 kHz: (times, controls [t,18], voice activity [t])"""
        x = torch.from_numpy(np.float32(features(sound)))[None]
        _, controls, activity = self.folded(x)
        return seconds_of_steps(x.shape[1]), *limited(controls, activity)


class StoredModel:
    """The networks of a model file. `checkpoints`: encoder and decoders of the file, for the heads of phonemes."""

    def __init__(self, path, checkpoints=None, split="test"):
        self.networks, self.split, self.heads = weight_reader.networks(path), split, None
        torch.set_num_threads(1)
        if checkpoints:
            self.encoder, self.heads = recognition.load(checkpoints[0])
            self.heard = torch.load(checkpoints[0], map_location="cpu")["seconds_heard"]

    def __call__(self, sound):
        """The same as of Model."""
        x, energies = (torch.from_numpy(np.float32(v))[None] for v in (features(sound), jaw.energies(sound)))
        _, controls, activity = golden_outputs.outputs_of(self.networks, x, energies)
        return seconds_of_steps(x.shape[1]), *limited(controls, activity)


def limited(controls, activity):
    """Controls and voice activity of one recording; mouthClose is at most jawOpen, as in the tracker."""
    close, open_jaw = INDEX["mouthClose"], INDEX["jawOpen"]
    controls[..., close] = torch.minimum(controls[..., close], controls[..., open_jaw])
    return controls[0].numpy(), activity[0, :, 1].numpy()
