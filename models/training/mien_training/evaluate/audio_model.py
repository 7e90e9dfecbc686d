"""The networks of a model file, run on whole recordings."""
import numpy as np
import torch

from mien_training.audio import golden_outputs, jaw
from mien_training.audio.audio_net import SPEECH_CONTROLS
from mien_training.audio.features import features, seconds_of_steps
from mien_training.networks import weight_reader

INDEX = {name: i for i, name in enumerate(SPEECH_CONTROLS)}


class StoredModel:
    def __init__(self, path):
        self.networks = weight_reader.networks(path)
        torch.set_num_threads(1)

    def __call__(self, sound):
        """f32 [samples] at 16 kHz -> (times, controls [t,18], voice activity [t]). mouthClose is at most jawOpen, as
        in the tracker."""
        x, energies = (torch.from_numpy(np.float32(v))[None] for v in (features(sound), jaw.energies(sound)))
        _, controls, activity = golden_outputs.outputs_of(self.networks, x, energies)
        close, open_jaw = INDEX["mouthClose"], INDEX["jawOpen"]
        controls[..., close] = torch.minimum(controls[..., close], controls[..., open_jaw])
        return seconds_of_steps(x.shape[1]), controls[0].numpy(), activity[0, :, 1].numpy()
