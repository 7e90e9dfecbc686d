"""Small networks of the kinds that are exported today: like ResNet-18, MobileNetV3 and ConvNeXt, with random
weights."""
import torch
import torch.nn.functional as F
from network_cases import conv_norm, with_statistics
from torch import nn

SHAPE = (1, 3, 64, 48)


class BasicBlock(nn.Module):
    """He et al. 2016"""

    def __init__(self, a, b, stride):
        super().__init__()
        self.body = nn.Sequential(nn.Conv2d(a, b, 3, stride, 1, bias=False), nn.BatchNorm2d(b), nn.ReLU(inplace=True),
                                  conv_norm(b, b, 3, activation=False))
        self.shortcut = conv_norm(a, b, 1, stride, activation=False) if stride > 1 or a != b else nn.Identity()

    def forward(self, x):
        return F.relu(self.body(x) + self.shortcut(x))


def resnet():
    stem = [nn.Conv2d(3, 16, 7, 2, 3, bias=False), nn.BatchNorm2d(16), nn.ReLU(), nn.MaxPool2d(3, 2, 1)]
    blocks = [BasicBlock(16, 16, 1), BasicBlock(16, 16, 1), BasicBlock(16, 32, 2), BasicBlock(32, 32, 1)]
    return nn.Sequential(*stem, *blocks, nn.AdaptiveAvgPool2d(1), nn.Flatten(), nn.Linear(32, 20))


class SqueezeExcitation(nn.Module):
    def __init__(self, channels):
        super().__init__()
        self.down, self.up = nn.Conv2d(channels, channels // 4, 1), nn.Conv2d(channels // 4, channels, 1)

    def forward(self, x):
        return x * F.hardsigmoid(self.up(F.relu(self.down(F.adaptive_avg_pool2d(x, 1)))))


class MobileBlock(nn.Module):
    """Howard et al. 2019"""

    def __init__(self, a, hidden, b, kernel, stride, activation):
        super().__init__()
        self.body = nn.Sequential(conv_norm(a, hidden, activation=False), activation(),
                                  conv_norm(hidden, hidden, kernel, stride, hidden, False), activation(),
                                  SqueezeExcitation(hidden), conv_norm(hidden, b, activation=False))
        self.residual = stride == 1 and a == b

    def forward(self, x):
        return x + self.body(x) if self.residual else self.body(x)


def mobilenet_v3():
    blocks = [MobileBlock(16, 16, 16, 3, 2, nn.ReLU), MobileBlock(16, 72, 24, 3, 2, nn.ReLU),
              MobileBlock(24, 96, 24, 5, 1, nn.Hardswish)]
    return nn.Sequential(conv_norm(3, 16, 3, 2, activation=False), nn.Hardswish(), *blocks, nn.AdaptiveAvgPool2d(1),
                         nn.Flatten(), nn.Linear(24, 64), nn.Hardswish(), nn.Dropout(0.2), nn.Linear(64, 20))


class ConvNeXtBlock(nn.Module):
    """Liu et al. 2022"""

    def __init__(self, c):
        super().__init__()
        self.depthwise, self.norm = nn.Conv2d(c, c, 7, padding=3, groups=c), nn.LayerNorm(c, eps=1e-6)
        self.up, self.down, self.scale = nn.Linear(c, 4 * c), nn.Linear(4 * c, c), nn.Parameter(torch.rand(c))

    def forward(self, x):
        y = self.norm(self.depthwise(x).permute(0, 2, 3, 1))
        return x + (self.scale * self.down(F.gelu(self.up(y)))).permute(0, 3, 1, 2)


class ChannelNorm(nn.LayerNorm):
    def forward(self, x):
        return super().forward(x.permute(0, 2, 3, 1)).permute(0, 3, 1, 2)


def convnext():
    layers = [nn.Conv2d(3, 24, 4, 4), ChannelNorm(24), ConvNeXtBlock(24), ConvNeXtBlock(24), ChannelNorm(24),
              nn.Conv2d(24, 48, 2, 2), ConvNeXtBlock(48)]
    return nn.Sequential(*layers, nn.AdaptiveAvgPool2d(1), nn.Flatten(), nn.LayerNorm(48), nn.Linear(48, 20))


def networks():
    yield from (("resnet", resnet()), ("mobilenet_v3", mobilenet_v3()), ("convnext", convnext()))


def has_default_export():
    """Whether PyTorch's current exporter is installed. By default it writes opset 18 or later, and weights to a
    separate file."""
    try:
        import onnxscript  # noqa: F401
    except ModuleNotFoundError:
        return False
    return tuple(map(int, torch.__version__.split(".")[:2])) >= (2, 5)


def exported(network, path, by_default):
    """Exports with the default exporter of torch.onnx.export, or with that of PyTorch up to 2.4."""
    options = {} if by_default else {"opset_version": 16, "input_names": ["x"]}
    if has_default_export():
        options["dynamo"] = by_default
    torch.onnx.export(with_statistics(network), (torch.zeros(SHAPE),), path, **options)
