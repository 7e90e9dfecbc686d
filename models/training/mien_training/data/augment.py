"""Photometric augmentation of tensors: camera, lens, codec and light.

All functions take images f32 [n,3,h,w] in 0..1 and draw from a torch Generator.
"""
import functools
import math

import torch
import torch.nn.functional as F

STRANGE = 0.1  # share of images in unusual light


def uniform(generator, n, low, high, channels=1):
    return torch.empty(n, channels, 1, 1).uniform_(low, high, generator=generator)


def chosen(generator, n, share):
    return (torch.rand(n, 1, 1, 1, generator=generator) < share).float()


def grey(x):
    """The mean of the colours, [n,1,h,w]; a sum of three is faster than a mean."""
    return (x[:, :1] + x[:, 1:2]).add_(x[:, 2:]).mul_(1 / 3)


def colour(x, g):
    """Exposure, contrast, gamma, white balance, saturation; black-and-white and tinted images."""
    n = len(x)
    saturation = uniform(g, n, 0.3, 1.5) * (1 - chosen(g, n, 0.2))  # some black and white
    tint = torch.exp(torch.randn(n, 3, 1, 1, generator=g) * 0.07)
    tint = tint / tint.mean(1, keepdim=True)
    x = torch.lerp(grey(x), x, saturation).mul_(tint).clamp_(0, 1)
    bend = uniform(g, n, -0.5, 0.5)  # x + bend x (1 - x): a gamma-like curve without its cost
    contrast, brightness = uniform(g, n, 0.6, 1.35), uniform(g, n, -0.15, 0.15)
    curved = (x * (-bend * contrast)).add_((1 + bend) * contrast).mul_(x)
    return curved.add_(0.5 + brightness - 0.5 * contrast).clamp_(0, 1)


def shade(x, g):
    """A soft shadow or light across the image: a ramp in a random direction."""
    n, _, h, w = x.shape
    angle = uniform(g, n, 0, 2 * math.pi)
    ys, xs = torch.linspace(-1, 1, h).view(1, 1, h, 1), torch.linspace(-1, 1, w).view(1, 1, 1, w)
    along = torch.cos(angle) * xs + torch.sin(angle) * ys + uniform(g, n, -0.6, 0.6)
    ramp = torch.sigmoid(along * torch.exp(uniform(g, n, 0, 2.5)))
    depth = uniform(g, n, 0, 0.75)
    return x * ((1 - depth * ramp) * (1 + 0.5 * depth))


def coloured_light(x, g):
    """Light of nearly one colour, as on a stage: only brightness in that colour remains."""
    n = len(x)
    light = uniform(g, n, 0, 1, channels=3)
    light = light / light.amax(1, keepdim=True)
    brightness = torch.lerp(grey(x), x.amax(1, keepdim=True), uniform(g, n, 0, 1))
    return torch.lerp(x, brightness * light, uniform(g, n, 0.4, 1))


def badly_exposed(x, g):
    """Much too bright, much too dark, or with little contrast, as in haze."""
    n, kind = len(x), torch.rand(len(x), 1, 1, 1, generator=g)
    light, dark = x * uniform(g, n, 1.3, 2.5) + uniform(g, n, 0, 0.3), x * uniform(g, n, 0.1, 0.5)
    faded = x * uniform(g, n, 0.15, 0.5) + uniform(g, n, 0, 0.5)
    return torch.where(kind < 0.35, light, torch.where(kind < 0.7, dark, faded)).clamp_(0, 1)


def strange_light(x, g):
    return torch.where(torch.rand(len(x), 1, 1, 1, generator=g) < 0.4, coloured_light(x, g), badly_exposed(x, g))


def lit(x, g):
    """Copies in another light, before the lens."""
    return share_of(colour(share_of(x.clone(), g, 0.35, shade), g), g, STRANGE, strange_light)


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
        theta = torch.tensor([[1, 0, 2 * s * math.cos(angle) / w], [0, 1, 2 * s * math.sin(angle) / h]]).expand(n, -1,
                                                                                                                -1)
        total = total + F.grid_sample(x, F.affine_grid(theta, x.shape, align_corners=False), padding_mode="border",
                                      align_corners=False)
    return total / len(shifts)


def low_resolution(x, factor):
    h, w = x.shape[-2:]
    small = F.interpolate(x, scale_factor=1 / factor, mode="area" if factor > 1.5 else "bilinear")
    return F.interpolate(small, (h, w), mode="bilinear", align_corners=False)


@functools.lru_cache
def _dct():
    """The 64 orthonormal 8x8 cosine patterns [64,64,1,1] and the coarseness [64,1,1] of each, higher frequencies
    coarser."""
    k, i = torch.arange(8.0).view(8, 1), torch.arange(8.0).view(1, 8)
    basis = torch.cos((2 * i + 1) * k * math.pi / 16) / 2
    basis[0] /= math.sqrt(2)
    patterns = torch.einsum("ay,bx->abyx", basis, basis).reshape(64, 64, 1, 1)
    return patterns, ((1 + k + k.T) / 8).reshape(64, 1, 1)


def jpeg(x, strength):
    """8x8 DCT quantisation: JPEG and intra-frame video artefacts."""
    n, c, h, w = x.shape
    patterns, coarseness = _dct()
    padded = F.pad(x, (0, -w % 8, 0, -h % 8), mode="replicate").flatten(0, 1).unsqueeze(1)
    step = strength * coarseness
    coefficients = torch.round(F.conv2d(F.pixel_unshuffle(padded, 8), patterns) / step) * step
    blocks = F.conv2d(coefficients, patterns.transpose(0, 1))
    return F.pixel_shuffle(blocks, 8).view(n, c, *padded.shape[-2:])[..., :h, :w]


def some(x, g, share, operation):
    """Applies an operation to a random share of the images in place, in groups that share its parameters."""
    rows = torch.nonzero(torch.rand(len(x), generator=g) < share)[:, 0]
    for group in rows.split(max(1, len(rows) // 4 + 1)):
        if len(group):
            x[group] = operation(x[group], float(torch.rand(1, generator=g)))
    return x


def share_of(x, g, share, operation):
    """Applies an operation, which draws its own parameters per image, to a random share of the images in place."""
    rows = torch.nonzero(torch.rand(len(x), generator=g) < share)[:, 0]
    if len(rows):
        x[rows] = operation(x[rows], g)
    return x


def noise(x, g):
    """Sensor noise, coloured or grey, stronger where it is bright."""
    n = len(x)
    level = uniform(g, n, 0.02, 0.25) ** 2
    fine = torch.randn(x.shape, generator=g)
    fine = torch.where(torch.rand(n, 1, 1, 1, generator=g) < 0.5, fine[:, :1], fine)
    return x + fine * level * (0.3 + grey(x).sqrt())


def low_light(x, g, of_frame=None):
    """A dark room: the camera amplifies its signal and its noise (Poisson-Gaussian, Foi et al. 2008); colours fade.

    The noise comes from the generator `of_frame`, if given.
    """
    n = len(x)
    grain, light, saturation = uniform(g, n, 0.05, 0.25) ** 2, uniform(g, n, 0.25, 1), uniform(g, n, 0.2, 1)
    linear = torch.lerp(grey(x), x, saturation).square()
    seen = linear + torch.randn(x.shape, generator=of_frame or g) * (linear * grain + grain ** 2).sqrt()
    return seen.clamp_(0, 1).mul_(light).sqrt_()


def occlude(x, g):
    """Half-planes, discs and bars of one colour over part of the image."""
    n, _, h, w = x.shape
    ys, xs = torch.linspace(-1, 1, h).view(1, 1, h, 1), torch.linspace(-1, 1, w).view(1, 1, 1, w)
    angle, reach = uniform(g, n, 0, 2 * math.pi), uniform(g, n, 0.45, 1.1)
    cx, cy = torch.cos(angle) * reach, torch.sin(angle) * reach
    kind = torch.rand(n, 1, 1, 1, generator=g)
    disc = (xs - cx) ** 2 + (ys - cy) ** 2 < uniform(g, n, 0.15, 0.6) ** 2
    half = torch.cos(angle) * xs + torch.sin(angle) * ys > reach
    bar = (torch.cos(angle) * (xs - cx / 2) + torch.sin(angle) * (ys - cy / 2)).abs() < uniform(g, n, 0.04, 0.15)
    mask = torch.where(kind < 0.5, disc, torch.where(kind < 0.8, half, bar)).float()
    own = x.flatten(2)[..., torch.randint(h * w, (1,), generator=g)].unsqueeze(3)  # a colour of the image itself
    paint = torch.where(torch.rand(n, 1, 1, 1, generator=g) < 0.5, own, torch.rand(n, 3, 1, 1, generator=g))
    return torch.lerp(x, paint.expand_as(x), mask)


def lens(x, g, share=0.2):
    x = some(x, g, share, lambda y, u: gaussian(y, 0.4 + 1.4 * u))
    x = some(x, g, share * 0.5, lambda y, u: motion(y, 2 + 5 * u, math.pi * 7 * u))
    return some(x, g, share, lambda y, u: low_resolution(y, 1.2 + 1.6 * u))


def degrade(x, g):
    """Occluders, lens, sensor noise and codec."""
    x = lens(share_of(x, g, 0.3, occlude), g, 0.35)
    x = share_of(share_of(x, g, 0.15, low_light), g, 0.7, noise).clamp_(0, 1)
    return some(x, g, 0.35, lambda y, u: jpeg(y, 0.05 + 0.25 * u)).clamp_(0, 1)


def photometric(x, g, degraded=0.5):
    """All effects, for unrelated images. Some images stay sharp, for eyelids and lips."""
    return share_of(lit(x, g), g, degraded, degrade)


class OfSequence:
    """The chain for sequences in step: light, colour and lens stay, noise and codec change from frame to frame."""

    def __init__(self, n, seed):
        self.n, self.seed = n, seed

    def __call__(self, x, frame):
        steady = torch.Generator().manual_seed(self.seed)
        x = lens(lit(x, steady), steady)
        fresh = torch.Generator().manual_seed(self.seed * 1009 + frame + 1)
        level, dark = uniform(steady, self.n, 0, 0.06), torch.rand(self.n, generator=steady) < 0.1
        x = (x + torch.randn(x.shape, generator=fresh) * level).clamp(0, 1)
        x[dark] = low_light(x[dark], steady, fresh)
        return some(x, steady, 0.3, lambda y, u: jpeg(y, 0.05 + 0.2 * u)).clamp(0, 1)
