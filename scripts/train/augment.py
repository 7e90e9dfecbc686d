"""Photometric variety on tensors: what a camera, its lens, its codec and the light in the room do to a face.

Every function takes images f32 [n,3,h,w] in 0..1 and draws from a torch Generator.
"""
import math

import torch
import torch.nn.functional as F


def uniform(generator, n, low, high, channels=1):
    return torch.empty(n, channels, 1, 1).uniform_(low, high, generator=generator)


def chosen(generator, n, share):
    return (torch.rand(n, 1, 1, 1, generator=generator) < share).float()


def colour(x, g):
    """Exposure, contrast, gamma, white balance, saturation; black-and-white and tinted pictures."""
    n = len(x)
    grey = x.mean(1, keepdim=True)
    saturation = uniform(g, n, 0.3, 1.5)
    saturation = saturation * (1 - chosen(g, n, 0.2))  # black and white
    x = grey + (x - grey) * saturation
    tint = torch.exp(torch.randn(n, 3, 1, 1, generator=g) * 0.08)
    x = x * (tint / tint.mean(1, keepdim=True))
    bend = uniform(g, n, -0.5, 0.5)  # a gamma-like curve without its cost
    x = x.clamp(0, 1)
    x = x + bend * x * (1 - x)
    contrast, brightness = uniform(g, n, 0.6, 1.35), uniform(g, n, -0.15, 0.15)
    return ((x - 0.5) * contrast + 0.5 + brightness).clamp(0, 1)


def shade(x, g):
    """A soft shadow or light across the picture: a ramp in a random direction."""
    n, _, h, w = x.shape
    angle = uniform(g, n, 0, 2 * math.pi)
    ys, xs = torch.linspace(-1, 1, h).view(1, 1, h, 1), torch.linspace(-1, 1, w).view(1, 1, 1, w)
    along = torch.cos(angle) * xs + torch.sin(angle) * ys + uniform(g, n, -0.6, 0.6)
    ramp = torch.sigmoid(along * torch.exp(uniform(g, n, 0, 2.5)))
    depth = uniform(g, n, 0, 0.75) * chosen(g, n, 0.35)
    return x * (1 - depth * ramp) * (1 + 0.5 * depth)


def gaussian(x, sigma):
    radius = max(1, math.ceil(2 * sigma))
    at = torch.arange(-radius, radius + 1, dtype=torch.float32)
    kernel = torch.exp(-at ** 2 / (2 * sigma ** 2))
    kernel = (kernel / kernel.sum()).expand(3, 1, -1)
    x = F.pad(x, (radius,) * 4, mode="replicate")
    return F.conv2d(F.conv2d(x, kernel.unsqueeze(2), groups=3), kernel.unsqueeze(3), groups=3)


def motion(x, length, angle):
    """Linear motion blur by averaging shifted copies."""
    shifts = torch.linspace(-length / 2, length / 2, max(2, math.ceil(length)))
    n, _, h, w = x.shape
    total = 0
    for s in shifts:
        theta = torch.tensor([[1, 0, 2 * s * math.cos(angle) / w], [0, 1, 2 * s * math.sin(angle) / h]]).expand(n, -1, -1)
        total = total + F.grid_sample(x, F.affine_grid(theta, x.shape, align_corners=False), padding_mode="border", align_corners=False)
    return total / len(shifts)


def low_resolution(x, factor):
    h, w = x.shape[-2:]
    small = F.interpolate(x, scale_factor=1 / factor, mode="area" if factor > 1.5 else "bilinear")
    return F.interpolate(small, (h, w), mode="bilinear", align_corners=False)


def _dct():
    k, i = torch.arange(8.0).view(8, 1), torch.arange(8.0).view(1, 8)
    basis = torch.cos((2 * i + 1) * k * math.pi / 16) / 2
    basis[0] /= math.sqrt(2)
    return basis


def jpeg(x, strength):
    """8x8 DCT quantisation, coarser for high frequencies: JPEG and intra-frame video artefacts."""
    n, c, h, w = x.shape
    padded = F.pad(x, (0, -w % 8, 0, -h % 8), mode="replicate")
    blocks = padded.unfold(2, 8, 8).unfold(3, 8, 8)
    dct = _dct()
    step = strength * (1 + torch.arange(8.0).view(8, 1) + torch.arange(8.0).view(1, 8)) / 8
    coefficients = torch.round(dct @ blocks @ dct.T / step) * step
    blocks = dct.T @ coefficients @ dct
    return blocks.permute(0, 1, 2, 4, 3, 5).reshape(padded.shape)[..., :h, :w]


def some(x, g, share, operation):
    """Applies an operation to a random share of the pictures, in groups that share its parameters."""
    rows = torch.nonzero(torch.rand(len(x), generator=g) < share)[:, 0]
    for group in rows.split(max(1, len(rows) // 4 + 1)):
        if len(group):
            x = x.index_copy(0, group, operation(x[group], float(torch.rand(1, generator=g))))
    return x


def noise(x, g):
    n = len(x)
    level = uniform(g, n, 0, 0.27) ** 2
    fine = torch.randn(x.shape, generator=g)
    grey = torch.where(torch.rand(n, 1, 1, 1, generator=g) < 0.5, fine.mean(1, keepdim=True) * 1.7, fine)
    return x + grey * level * (0.3 + x.mean(1, keepdim=True).sqrt())


def occlude(x, g, share=0.2):
    """Half-planes, discs and bars of one colour over part of the picture."""
    n, _, h, w = x.shape
    ys, xs = torch.linspace(-1, 1, h).view(1, 1, h, 1), torch.linspace(-1, 1, w).view(1, 1, 1, w)
    angle, reach = uniform(g, n, 0, 2 * math.pi), uniform(g, n, 0.45, 1.1)
    cx, cy = torch.cos(angle) * reach, torch.sin(angle) * reach
    kind = torch.rand(n, 1, 1, 1, generator=g)
    disc = (xs - cx) ** 2 + (ys - cy) ** 2 < uniform(g, n, 0.15, 0.6) ** 2
    half = torch.cos(angle) * xs + torch.sin(angle) * ys > reach
    bar = (torch.cos(angle) * (xs - cx / 2) + torch.sin(angle) * (ys - cy / 2)).abs() < uniform(g, n, 0.04, 0.15)
    mask = torch.where(kind < 0.5, disc, torch.where(kind < 0.8, half, bar)).float() * chosen(g, n, share)
    own = x.flatten(2)[..., torch.randint(h * w, (1,), generator=g)].unsqueeze(3)  # a colour of the picture itself
    paint = torch.where(torch.rand(n, 1, 1, 1, generator=g) < 0.5, own, torch.rand(n, 3, 1, 1, generator=g))
    return torch.lerp(x, paint.expand_as(x), mask)


def lens_and_codec(x, g, share=0.3):
    x = some(x, g, share, lambda y, u: gaussian(y, 0.4 + 1.4 * u))
    x = some(x, g, share * 0.4, lambda y, u: motion(y, 2 + 5 * u, math.pi * 7 * u))
    x = some(x, g, share * 0.7, lambda y, u: low_resolution(y, 1.2 + 1.6 * u))
    return x


def photometric(x, g):
    """The whole chain, for pictures that have nothing to do with each other."""
    x = colour(shade(occlude(x, g), g), g)
    x = noise(lens_and_codec(x, g), g).clamp(0, 1)
    return some(x, g, 0.25, lambda y, u: jpeg(y, 0.05 + 0.25 * u)).clamp(0, 1)


class OfSequence:
    """The chain for sequences in step: light, colour and lens stay, noise and codec change from frame to frame."""

    def __init__(self, n, seed):
        self.n, self.seed = n, seed

    def __call__(self, x, frame):
        steady = torch.Generator().manual_seed(self.seed)
        x = lens_and_codec(colour(shade(x, steady), steady), steady)
        fresh = torch.Generator().manual_seed(self.seed * 1009 + frame + 1)
        level = uniform(steady, self.n, 0, 0.06)
        x = (x + torch.randn(x.shape, generator=fresh) * level).clamp(0, 1)
        return some(x, steady, 0.3, lambda y, u: jpeg(y, 0.05 + 0.2 * u)).clamp(0, 1)
