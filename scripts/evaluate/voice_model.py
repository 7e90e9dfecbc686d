"""AudioNet as the model file has it (folded, fp16 weights), asked of whole recordings."""
import sys
from pathlib import Path

import numpy as np
import torch

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "train"))
from voice import export, recognise  # noqa: E402
from voice.audio_net import SPEECH_CONTROLS  # noqa: E402
from voice.features import features, seconds_of_steps  # noqa: E402

INDEX = {name: i for i, name in enumerate(SPEECH_CONTROLS)}


class Model:
    """`split`: of what was held out, val to decide by and test to report."""

    def __init__(self, encoder_path, decoders_path, split="test"):
        self.split = split
        torch.set_num_threads(1)
        encoder, decoders, state = export.read(encoder_path, decoders_path)
        self.folded = export.Folded(encoder, decoders)
        self.heard = state["seconds_heard"]
        self.encoder, self.heads = recognise.load(encoder_path)

    def __call__(self, sound):
        """Of f32 [samples] at 16 kHz: (times, controls [t,18], voice activity [t])"""
        x = torch.from_numpy(np.float32(features(sound)))[None]
        _, controls, activity = self.folded(x)
        controls[..., INDEX["mouthClose"]] = torch.minimum(controls[..., INDEX["mouthClose"]], controls[..., INDEX["jawOpen"]])  # as the tracker
        return seconds_of_steps(x.shape[1]), controls[0].numpy(), activity[0, :, 1].numpy()
