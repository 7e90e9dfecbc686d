"""AudioNet as PyTorch modules (Navarro et al. 2023; docs/architecture.md): an encoder of 130 features and two decoders.

All modules stream: forward(x [n,t,...], state) returns outputs and the next state. Without a state a stream begins.
"""
import torch
import torch.nn.functional as F
from torch import nn

from mien_training.audio.features import FEATURES
from mien_training.audio.phonemes import NAMES
from mien_training.networks.architectures import LEAK

WIDTHS = [104, 96, 96]
EMBEDDING = 80
HIDDEN = 64
SPEECH_CONTROLS = ["jawOpen", "jawForward", "mouthClose", "mouthFunnel", "mouthPucker", "mouthRollLower",
                   "mouthRollUpper",
                   "mouthShrugLower", "mouthShrugUpper", "mouthPressLeft", "mouthPressRight", "mouthStretchLeft",
                   "mouthStretchRight",
                   "mouthLowerDownLeft", "mouthLowerDownRight", "mouthUpperUpLeft", "mouthUpperUpRight", "tongueOut"]
JAW = SPEECH_CONTROLS.index("jawOpen")


class CausalConv(nn.Module):
    """Kernel 2, batch norm (Ioffe, Szegedy 2015), leaky ReLU. Before the stream's start its input is zero."""

    def __init__(self, channels_in, channels_out):
        super().__init__()
        self.convolution = nn.Conv1d(channels_in, channels_out, 2, bias=False)
        self.norm = nn.BatchNorm1d(channels_out)

    def forward(self, x):
        return F.leaky_relu(self.norm(self.convolution(x)), LEAK)

    def folded(self):
        """Weight and bias with the batch norm in them."""
        gain = self.norm.weight / torch.sqrt(self.norm.running_var + self.norm.eps)
        return self.convolution.weight * gain.view(-1, 1, 1), self.norm.bias - self.norm.running_mean * gain


class Encoder(nn.Module):
    def __init__(self):
        super().__init__()
        # Padding before the start is zero before normalization, not after it, so that normalization folds into the
        # first convolution exactly.
        self.register_buffer("mean", torch.zeros(FEATURES))
        self.register_buffer("deviation", torch.ones(FEATURES))
        self.convolutions = nn.ModuleList(CausalConv(a, b) for a, b in zip([FEATURES] + WIDTHS, WIDTHS))
        self.lstm = nn.LSTM(WIDTHS[-1], WIDTHS[-1], batch_first=True)
        self.output = nn.Linear(WIDTHS[-1], EMBEDDING)

    def forward(self, features, state=None):
        x = features.transpose(1, 2)
        previous, lstm_state = state or ([x.new_zeros(len(x), c.convolution.in_channels, 1) for c in self.convolutions],
                                         None)
        following = []
        for k, (convolution, before) in enumerate(zip(self.convolutions, previous)):
            x = torch.cat([before, x], 2)
            following.append(x[..., -1:])
            x = convolution((x - self.mean[:, None]) / self.deviation[:, None] if k == 0 else x)
        x, lstm_state = self.lstm(x.transpose(1, 2), lstm_state)
        return self.output(x), (following, lstm_state)

    def folded(self):
        """[(weight, bias)] of the convolutions, into which normalisation and batch norm are folded."""
        layers = [convolution.folded() for convolution in self.convolutions]
        weight, bias = layers[0]
        weight = weight / self.deviation.view(1, -1, 1)
        layers[0] = weight, bias - (weight * self.mean.view(1, -1, 1)).sum((1, 2))
        return layers


class Decoder(nn.Module):
    def __init__(self, outputs):
        super().__init__()
        self.input = nn.Linear(EMBEDDING, HIDDEN)
        self.lstm = nn.LSTM(HIDDEN, HIDDEN, batch_first=True)
        self.output = nn.Linear(HIDDEN, outputs)

    def forward(self, embedding, state=None):
        x, state = self.lstm(self.input(embedding), state)
        return self.output(x), state


class PhonemeHeads(nn.Module):
    """Only for training. `sequence`: log-probabilities for CTC, blank first; `frame`: scores of the phoneme of each
    step."""

    def __init__(self):
        super().__init__()
        self.sequence = nn.Linear(EMBEDDING, len(NAMES))
        self.frame = nn.Linear(EMBEDDING, len(NAMES))

    def forward(self, embedding):
        return F.log_softmax(self.sequence(embedding), -1), self.frame(embedding)


def controls_decoder():
    """Clamped to 0..1 when used, not in training."""
    return Decoder(len(SPEECH_CONTROLS))


def activity_decoder():
    """Scores of silence or noise, and of speech."""
    return Decoder(2)
