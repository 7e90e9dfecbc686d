"""AudioNet as in the model file (folded, fp16 weights), run on whole recordings."""

import numpy as np
import torch

from mien_training.audio import export, recognition
from mien_training.audio.audio_net import SPEECH_CONTROLS
from mien_training.audio.features import features, seconds_of_steps

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
        # as the tracker
        controls[..., INDEX["mouthClose"]] = torch.minimum(controls[..., INDEX["mouthClose"]],
                                                           controls[..., INDEX["jawOpen"]])
        return seconds_of_steps(x.shape[1]), controls[0].numpy(), activity[0, :, 1].numpy()
