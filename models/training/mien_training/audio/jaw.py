"""The jaw decoder: its input, its network, and the recordings that it learns from.

Input: the encoder's embedding, and the log-mel energies of the newest window relative to a running level
(audio/loudness.h), which do not depend on the distance to the microphone.
"""
import numpy as np
import torch
from torch import nn

from mien_training.audio.audio_net import EMBEDDING
from mien_training.audio.features import BANDS, log_mel, without_offset

INPUTS = EMBEDDING + BANDS
HIDDEN = 32
SILENCE = float(np.log(np.float32(1e-8)))
ATTACK, RELEASE = 4.0, 200.0  # windows


def energies(sound, warp=1.0):
    """f32 [samples] -> f32 [windows, 26]: log-mel energies as the front end computes them."""
    return log_mel(without_offset(np.clip(sound, -1, 1)), warp)


def relative(bands):
    """Energies [windows, 26], relative to the running level: audio/loudness.cpp."""
    level, levels = SILENCE, np.empty((len(bands), 1), np.float32)
    for window, mean in enumerate(bands.mean(1)):
        level += (mean - level) / (ATTACK if mean > level else RELEASE)
        levels[window] = level
    return bands - levels


class JawDecoder(nn.Module):
    """forward(input [n,t,106], state) -> jawOpen [n,t], the state that continues"""

    def __init__(self, hidden=HIDDEN):
        super().__init__()
        self.register_buffer("mean", torch.zeros(INPUTS))
        self.register_buffer("deviation", torch.ones(INPUTS))
        self.input = nn.Linear(INPUTS, hidden)
        self.lstm = nn.LSTM(hidden, hidden, batch_first=True)
        self.output = nn.Linear(hidden, 1)

    def forward(self, x, state=None):
        x, state = self.lstm(self.input((x - self.mean) / self.deviation), state)
        return self.output(x)[..., 0], state

    def folded_input(self):
        """Weight and bias of the first layer, with the normalization in them."""
        weight = self.input.weight / self.deviation
        return weight, self.input.bias - weight @ self.mean
