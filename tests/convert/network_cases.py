"""Networks that PyTorch exports: MobileNetV2-like, MTCNN-like, and the project's own."""

import torch
import torch.nn.functional as F
from torch import nn

from mien_training.audio import audio_net
from mien_training.networks import architectures

STEPS = 20


def conv_norm(a, b, kernel=1, stride=1, groups=1, activation=True):
    layers = [nn.Conv2d(a, b, kernel, stride, kernel // 2, groups=groups, bias=False), nn.BatchNorm2d(b)]
    return nn.Sequential(*layers, *([nn.ReLU6()] if activation else []))


class InvertedResidual(nn.Module):
    def __init__(self, a, b, stride, expansion):
        super().__init__()
        hidden = a * expansion
        expand = [conv_norm(a, hidden)] if expansion > 1 else []
        self.body = nn.Sequential(*expand, conv_norm(hidden, hidden, 3, stride, hidden),
                                  conv_norm(hidden, b, activation=False))
        self.residual = stride == 1 and a == b

    def forward(self, x):
        return x + self.body(x) if self.residual else self.body(x)


class MobileNetV2(nn.Module):
    """The layers of Sandler et al. 2018, table 2, at a third of their width."""

    def __init__(self, classes=30):
        super().__init__()
        layers, channels = [conv_norm(3, 12, 3, 2)], 12
        for expansion, width, count, stride in ((1, 8, 1, 1), (6, 8, 2, 2), (6, 12, 3, 2), (6, 20, 4, 2),
                                                (6, 32, 3, 1), (6, 52, 3, 2), (6, 104, 1, 1)):
            for i in range(count):
                layers.append(InvertedResidual(channels, width, stride if i == 0 else 1, expansion))
                channels = width
        self.features = nn.Sequential(*layers, conv_norm(channels, 400))
        self.classifier = nn.Sequential(nn.Dropout(0.2), nn.Linear(400, classes))

    def forward(self, x):
        return self.classifier(F.adaptive_avg_pool2d(self.features(x), 1).flatten(1))


class SkipNet(nn.Module):
    """Skip connections over concatenations, as in DenseNet (Huang et al. 2017)."""

    def __init__(self):
        super().__init__()
        self.stem = conv_norm(3, 12, 3, 2)
        self.layers = nn.ModuleList(conv_norm(12 + 5 * i, 5, 3) for i in range(4))
        self.norm, self.head = nn.BatchNorm2d(32), nn.Conv2d(32, 7, 1)

    def forward(self, x):
        x = self.stem(x)
        for layer in self.layers:
            x = torch.cat([x, layer(x)], 1)
        return self.head(F.avg_pool2d(torch.sigmoid(self.norm(x)), 2))


class PNet(nn.Module):
    """As published (Zhang et al. 2016): two scores with a softmax."""

    def __init__(self):
        super().__init__()
        self.body = nn.Sequential(nn.Conv2d(3, 10, 3), nn.PReLU(10), nn.MaxPool2d(2, 2, ceil_mode=True),
                                  nn.Conv2d(10, 16, 3), nn.PReLU(16), nn.Conv2d(16, 32, 3), nn.PReLU(32))
        self.score, self.box = nn.Conv2d(32, 2, 1), nn.Conv2d(32, 4, 1)

    def forward(self, x):
        x = self.body(x)
        return self.box(x), torch.softmax(self.score(x), 1)


class RefiningNet(nn.Module):
    """R-Net and O-Net as published; maps are flattened column by column, as their first authors did."""

    def __init__(self, convolutions, hidden, heads):
        super().__init__()
        self.body = nn.Sequential(*convolutions)
        self.hidden = nn.Sequential(nn.LazyLinear(hidden), nn.PReLU(hidden))
        self.heads = nn.ModuleList(nn.Linear(hidden, n) for n in heads)

    def forward(self, x):
        x = self.hidden(self.body(x).permute(0, 3, 2, 1).flatten(1))
        score, *others = [head(x) for head in self.heads]
        return (torch.softmax(score, 1), *others)


def conv_prelu(a, b, kernel, pool=None):
    return [nn.Conv2d(a, b, kernel), nn.PReLU(b)] + ([nn.MaxPool2d(pool, 2, ceil_mode=True)] if pool else [])


def r_net():
    return RefiningNet([*conv_prelu(3, 28, 3, 3), *conv_prelu(28, 48, 3, 3), *conv_prelu(48, 64, 2)], 128, (2, 4))


def o_net():
    return RefiningNet([*conv_prelu(3, 32, 3, 3), *conv_prelu(32, 64, 3, 3), *conv_prelu(64, 64, 3, 2),
                        *conv_prelu(64, 128, 2)], 256, (2, 4, 10))


class WithoutState(nn.Module):
    """All steps of a stream at once."""

    def __init__(self, network, head=None):
        super().__init__()
        self.network, self.head = network, head or nn.Identity()

    def forward(self, x):
        return self.head(self.network(x)[0])


class EncoderStep(nn.Module):
    """One step, with the states of the convolutions and the cell as inputs and outputs."""

    def __init__(self):
        super().__init__()
        self.encoder = audio_net.Encoder()

    def forward(self, features, first, second, third, hidden, cell):
        embedding, (following, state) = self.encoder(features, ([first, second, third], (hidden, cell)))
        return (embedding, *following, *state)


ENCODER_STATES = {"first": (1, 130, 1), "second": (1, 104, 1), "third": (1, 96, 1), "hidden": (1, 1, 96),
                  "cell": (1, 1, 96)}


def with_statistics(network):
    """Statistics that a trained network might have, so that a wrong fold shows."""
    for module in network.modules():
        if getattr(module, "running_mean", None) is not None:
            nn.init.normal_(module.running_mean, 0, 0.2)
            nn.init.uniform_(module.running_var, 0.5, 1.5)
    for name, buffer in network.named_buffers():
        if name.endswith("deviation"):
            nn.init.uniform_(buffer, 0.5, 2.0)
        if name.endswith("encoder.mean") or name == "network.mean":
            nn.init.normal_(buffer)
    return network.eval()


def networks_to_export():
    """name, network, shapes of its inputs, opset, whether the exporter folds batch norm, states fed back"""
    image = {"x": (1, 3, 96, 96)}
    stream = {"x": (1, STEPS, 80)}
    for opset in (11, 13, 17):
        for folded in (True, False):
            yield f"mobilenet_v2_{opset}_{folded}", MobileNetV2(), image, opset, folded, {}
    yield "skip_net", SkipNet(), {"x": (1, 3, 40, 32)}, 13, False, {}
    yield "p_net", PNet(), {"x": (1, 3, 31, 40)}, 11, True, {}
    yield "r_net", r_net(), {"x": (1, 3, 24, 24)}, 12, True, {}
    yield "o_net", o_net(), {"x": (1, 3, 48, 48)}, 14, True, {}
    yield "basenet", architectures.BaseNetEncoder(), {"x": (1, 3, 65, 65)}, 13, True, {}
    yield "hifinet", architectures.HiFiNetEncoder(), {"x": (1, 3, 129, 109)}, 17, True, {}
    yield "own_p_net", architectures.PNet(), {"x": (1, 3, 24, 36)}, 13, True, {}
    yield "own_r_net", architectures.RNet(), {"x": (1, 3, 24, 24)}, 13, True, {}
    yield "controls_decoder", WithoutState(architectures.ControlsDecoder(),
                                           nn.Hardtanh(0, 1)), {"x": (1, STEPS, 256)}, 13, True, {}
    yield "pose_decoder", WithoutState(architectures.PoseDecoder()), {"x": (1, STEPS, 256)}, 16, True, {}
    yield "audionet_encoder", WithoutState(audio_net.Encoder()), {"x": (1, STEPS, 130)}, 13, True, {}
    yield "audionet_encoder_step", EncoderStep(), {"x": (1, 1, 130), **ENCODER_STATES}, 13, True, ENCODER_STATES
    yield "audionet_controls", WithoutState(audio_net.controls_decoder(), nn.Hardtanh(0, 1)), stream, 11, True, {}
    yield "audionet_activity", WithoutState(audio_net.activity_decoder(), nn.Softmax(-1)), stream, 13, True, {}


def exported(network, inputs, path, opset, folded):
    names = list(inputs)
    arguments = tuple(torch.zeros(shape) for shape in inputs.values())
    with torch.no_grad():
        network.eval()(*arguments)  # lazy layers get their sizes
    mode = torch.onnx.TrainingMode.EVAL if folded else torch.onnx.TrainingMode.PRESERVE
    torch.onnx.export(with_statistics(network), arguments, path, opset_version=opset, input_names=names, training=mode,
                      do_constant_folding=folded)
