"""The networks as PyTorch modules. Encoders resemble MobileNetV2 (Sandler et al. 2018), with unpadded depthwise
layers."""
import copy

import torch
import torch.nn.functional as F
from torch import nn

from mien_training.data.expressions import PAIRED
from mien_training.data.framing import BASENET, HIFINET
from mien_training.networks.native_layers import expanded_unit
from mien_training.networks.native_layers.depthwise_unit import depthwise_unit
from mien_training.networks.native_layers.native import in_training
from mien_training.networks.native_layers.norm_activation import NormActivation

FEATURES = 256
LANDMARKS = 175
CONTROLS = 52
POSE = 9
LEAK = 0.1  # slope of every leaky ReLU


class ConvNorm(nn.Sequential):
    """A convolution without bias and its norm. Maps may be bfloat16 in training; weights are fp32 and cast to the type
    of the map."""

    def forward(self, x):
        return self[1](self.convolved(x))

    def convolved(self, x):
        convolution = self[0]
        if not in_training(self, x):
            return convolution(x)
        weight = convolution.weight.to(x.dtype)
        if convolution.kernel_size == (1, 1):  # a matrix product is faster
            return F.linear(x.permute(0, 2, 3, 1), weight.flatten(1)).permute(0, 3, 1, 2)
        if convolution.kernel_size == x.shape[2:]:
            return (x * weight.permute(1, 0, 2, 3)).sum((2, 3), keepdim=True)
        return F.conv2d(x, weight, None, convolution.stride, convolution.padding, 1, convolution.groups)


def conv_norm(channels_in, channels_out, kernel=1, stride=1, padding=0, groups=1, activation=True):
    return ConvNorm(nn.Conv2d(channels_in, channels_out, kernel, stride, padding, groups=groups, bias=False),
                    NormActivation(channels_out, activation))


def fold(sequence):
    """Weight and bias of a convolution into which the following batch norm is folded."""
    convolution, norm = sequence[0], sequence[1]
    gain = norm.weight / torch.sqrt(norm.running_var + norm.eps)
    return convolution.weight * gain.view(-1, 1, 1, 1), norm.bias - norm.running_mean * gain


def folded(module):
    """A faster copy for inference only: batch norms are folded into convolutions."""
    if isinstance(module, ConvNorm):
        c = module[0]
        convolution = nn.Conv2d(c.in_channels, c.out_channels, c.kernel_size, c.stride, c.padding, groups=c.groups)
        with torch.no_grad():
            for own, value in zip((convolution.weight, convolution.bias), fold(module)):
                own.copy_(value)
        return nn.Sequential(convolution, nn.ReLU6(inplace=True) if module[1].activation else nn.Identity())
    out = copy.copy(module)
    out._modules = {name: folded(child) for name, child in module.named_children()}
    return out


class Branch(torch.autograd.Function):
    """A map for an inverted residual, and its centre for the addition. The backward pass adds the gradient of the
    centre in place to the other gradient, which has no other owner; autograd would first create a whole map of zeros.
    """

    @staticmethod
    def forward(ctx, x, margin):
        ctx.margin = margin
        return x.view_as(x), centre(x, margin).clone()

    @staticmethod
    def backward(ctx, gradient, of_centre):
        centre(gradient, ctx.margin).add_(of_centre)
        return gradient, None


def centre(x, margin):
    return x[..., margin:-margin, margin:-margin] if margin else x


class InvertedResidual(nn.Module):
    """Expand x t, depthwise 3x3, project; the residual is the centre slice of the input where the map shrinks."""

    def __init__(self, channels_in, channels_out, expansion, stride, padded):
        super().__init__()
        hidden = channels_in * expansion
        self.expand = conv_norm(channels_in, hidden) if expansion > 1 else nn.Identity()
        self.depthwise = conv_norm(hidden, hidden, 3, stride, int(padded), groups=hidden)
        self.project = conv_norm(hidden, channels_out, activation=False)
        self.residual = stride == 1 and channels_in == channels_out
        self.margin = 0 if padded else 1

    def expand_and_depthwise(self, x):
        if not in_training(self, x):
            return self.depthwise(self.expand(x))
        if isinstance(self.expand, ConvNorm):
            if expanded_unit.fits(x):
                return expanded_unit.expanded_unit(x, *self.expand, *self.depthwise)
            return depthwise_unit(self.expand.convolved(x), self.expand[1], *self.depthwise)
        return depthwise_unit(x, None, *self.depthwise)

    def forward(self, x):
        if not self.residual:
            return self.project(self.expand_and_depthwise(x))
        if not in_training(self, x) or not x.requires_grad:
            return self.project(self.expand_and_depthwise(x)) + centre(x, self.margin)
        x, middle = Branch.apply(x, self.margin)
        return self.project(self.expand_and_depthwise(x)).add_(middle)


class Encoder(nn.Module):
    """blocks: (expansion, stride, padded, channels). tail_kernel: the last map's size (h, w)."""

    def __init__(self, blocks, tail_kernel):
        super().__init__()
        self.map_type = torch.float32  # of maps in training; bfloat16 takes half the memory traffic
        layers, channels = [conv_norm(3, 16, 3, 2)], 16
        for expansion, stride, padded, out in blocks:
            layers.append(InvertedResidual(channels, out, expansion, stride, padded))
            channels = out
        self.body = nn.Sequential(*layers)
        self.tail = nn.Sequential(conv_norm(channels, channels * 6),
                                  conv_norm(channels * 6, channels * 6, tail_kernel, groups=channels * 6),
                                  nn.Conv2d(channels * 6, FEATURES, 1))

    def forward(self, image):
        """image [n,3,h,w] in -1..1 -> features [n,256]"""
        if not self.training:
            return self.tail(self.body(image)).flatten(1)
        image = image.to(self.map_type).contiguous(memory_format=torch.channels_last)
        return self.tail[2](self.tail[:2](self.body(image)).float()).flatten(1)


class BaseNetEncoder(Encoder):
    """Input 65 x 65."""

    def __init__(self):
        super().__init__([(2, 2, False, 16), (2, 1, False, 16), (2, 1, False, 16), (3, 2, False, 40), (3, 1, True, 40),
                          (4, 2, True, 72)] + [(4, 1, True, 72)] * 4 + [(4, 1, True, 112)], 3)


class HiFiNetEncoder(Encoder):
    """Input 129 high, 109 wide."""

    def __init__(self):
        super().__init__([(1, 1, False, 16), (4, 2, False, 24), (4, 1, False, 24), (4, 2, False, 40), (4, 1, False, 40),
                          (4, 1, False, 40), (4, 2, True, 96)] + [(4, 1, True, 96)] * 3 + [(4, 1, False, 128)]
                         + [(4, 1, True, 128)] * 2, (3, 2))


class FaceNetwork(nn.Module):
    """Encoder with its heads. `controls`, `pose` and `sides` (left minus right of each pair of controls) exist in
    training only, to keep expression in the features."""

    def __init__(self, encoder, framing):
        super().__init__()
        self.encoder, self.framing = encoder, framing
        self.still = nn.ModuleDict()  # StillDecoders that replace heads of the same names (see_through)
        self.landmarks = nn.Linear(FEATURES, 2 * LANDMARKS)
        self.face = nn.Linear(FEATURES, 1)
        self.controls = nn.Linear(FEATURES, CONTROLS)
        self.pose = nn.Linear(FEATURES, POSE)
        self.sides = nn.Linear(FEATURES, len(PAIRED))

    def forward(self, image):
        features = self.encoder(image)
        head = lambda name: (self.still[name] if name in self.still else getattr(self, name))(features)
        return {"features": features, "landmarks": self.landmarks(features).view(-1, LANDMARKS, 2),
                "face": self.face(features)[:, 0], "controls": head("controls"), "pose": head("pose"),
                "sides": self.sides(features)}

    def use_decoders(self, decoders, learn=False):
        """Trained decoders, {"controls_decoder": state, ...}, replace the heads that exist only in training. The
        encoder then improves their output; if they do not `learn` as well, they need no new training."""
        for name, kind in (("controls", ControlsDecoder), ("pose", PoseDecoder)):
            if f"{name}_decoder" in decoders:
                self.still[name] = StillDecoder(kind(), decoders[f"{name}_decoder"], learn)

    def state_without_decoders(self):
        """The state without that of these decoders."""
        return {name: value for name, value in self.state_dict().items() if not name.startswith("still.")}

    def decoders(self):
        """The decoders, as an argument of see_through."""
        return {f"{name}_decoder": still.decoder.state_dict() for name, still in self.still.items()}


class BaseNet(FaceNetwork):
    def __init__(self):
        super().__init__(BaseNetEncoder(), BASENET)


class HiFiNet(FaceNetwork):
    """Its face probability is not used."""

    def __init__(self):
        super().__init__(HiFiNetEncoder(), HIFINET)


FACE_NETWORKS = {BASENET.name: BaseNet, HIFINET.name: HiFiNet}


class TemporalDecoder(nn.Module):
    """Three causal convolutions over time (kernel 2), one LSTM, one fully connected layer."""

    def __init__(self, widths, outputs, features=FEATURES):
        super().__init__()
        self.convolutions = nn.ModuleList(nn.Conv1d(a, b, 2) for a, b in zip([features] + widths, widths))
        self.lstm = nn.LSTM(widths[-1], widths[-1], batch_first=True)
        self.output = nn.Linear(widths[-1], outputs)

    def forward(self, features, state=None):
        """features [n,t,256] -> outputs [n,t,m] and the state that continues the stream; no state is a stream's
        start."""
        x = features.transpose(1, 2)
        previous, lstm_state = state or ([x.new_zeros(len(x), c.in_channels, 1) for c in self.convolutions], None)
        following = []
        for convolution, before in zip(self.convolutions, previous):
            x = torch.cat([before, x], 2)
            following.append(x[..., -1:])
            x = F.leaky_relu(convolution(x), LEAK)
        x, lstm_state = self.lstm(x.transpose(1, 2), lstm_state)
        return self.output(x), (following, lstm_state)


class ControlsDecoder(TemporalDecoder):
    """Outputs are clamped to 0..1 when used, not in training."""

    def __init__(self, features=FEATURES):
        super().__init__([128, 128, 96], CONTROLS, features)


class PoseDecoder(TemporalDecoder):
    """Starts with heads that look ahead, because the gradient vanishes at a rotation of half a turn."""

    def __init__(self):
        super().__init__([48, 48, 32], POSE)
        nn.init.zeros_(self.output.bias)
        with torch.no_grad():
            self.output.bias[[0, 4]] = 1.0


class StillDecoder(nn.Module):
    """Output of a trained decoder for a constant stream."""

    FRAMES = 8

    def __init__(self, decoder, state, learn):
        super().__init__()
        decoder.load_state_dict(state)
        self.decoder = decoder.requires_grad_(learn)

    def forward(self, features):
        return self.decoder(features.unsqueeze(1).expand(-1, self.FRAMES, -1))[0][:, -1]


class PNet(nn.Module):
    """First stage of MTCNN (Zhang et al. 2016), fully convolutional, cell 12, stride 2. Box: dx, dy, dlog."""

    def __init__(self):
        super().__init__()
        self.body = nn.Sequential(nn.Conv2d(3, 10, 3), nn.PReLU(10), nn.MaxPool2d(2, 2, ceil_mode=True),
                                  nn.Conv2d(10, 16, 3), nn.PReLU(16), nn.Conv2d(16, 32, 3), nn.PReLU(32))
        self.face, self.box = nn.Conv2d(32, 1, 1), nn.Conv2d(32, 3, 1)

    def forward(self, image):
        x = self.body(image)
        return self.face(x), self.box(x)


class RNet(nn.Module):
    """Second stage of MTCNN, on 24x24."""

    def __init__(self):
        super().__init__()
        self.body = nn.Sequential(nn.Conv2d(3, 28, 3), nn.PReLU(28), nn.MaxPool2d(3, 2, ceil_mode=True),
                                  nn.Conv2d(28, 48, 3), nn.PReLU(48), nn.MaxPool2d(3, 2, ceil_mode=True),
                                  nn.Conv2d(48, 64, 2), nn.PReLU(64))
        self.hidden = nn.Sequential(nn.Linear(64 * 3 * 3, 128), nn.PReLU(128))
        self.face, self.box = nn.Linear(128, 1), nn.Linear(128, 3)

    def forward(self, image):
        x = self.hidden(self.body(image).flatten(1))
        return self.face(x), self.box(x)
