"""Batch norm and ReLU6 as one layer that reads its map half as often in training on CPUs.

Maps are fp32 or bfloat16; parameters, moments and sums are fp32.
"""
import functools
from ctypes import c_float, c_int, c_size_t, c_void_p

import torch
import torch.nn.functional as F
from torch import nn

from mien_training.networks.native_layers.native import MAX_CHANNELS, address, by_pixel, code, in_training

RELU6, UNBOUNDED = (0.0, 6.0), (-float("inf"), float("inf"))


@functools.lru_cache
def native():
    lib = code("norm_activation")
    pixels_channels, limits = [c_size_t] * 2, [c_float] * 2
    lib.norm_activation_forward.argtypes = [c_void_p, c_int, *pixels_channels, c_float, *limits, *[c_void_p] * 5]
    lib.norm_activation_backward.argtypes = [*[c_void_p] * 2, c_int, *pixels_channels, *limits, *[c_void_p] * 7]
    return lib


def extent(x):
    """(whether a map is bfloat16, its pixels, its channels)"""
    return x.dtype == torch.bfloat16, x.numel() // x.shape[1], x.shape[1]


class Fused(torch.autograd.Function):
    """x -> (y, mean, 1 / standard deviation)"""

    @staticmethod
    def forward(ctx, x, weight, bias, epsilon, limits):
        x = by_pixel(x)
        y, mean, inverse = torch.empty_like(x), torch.empty_like(weight), torch.empty_like(weight)
        native().norm_activation_forward(address(x), *extent(x), epsilon, *limits,
                                         *map(address, (weight, bias, mean, inverse, y)))
        ctx.save_for_backward(x, weight, bias, mean, inverse)
        ctx.limits = limits
        ctx.mark_non_differentiable(mean, inverse)
        return y, mean, inverse

    @staticmethod
    def backward(ctx, dy, *_):
        x, weight, bias, mean, inverse = ctx.saved_tensors
        dy, dx, dweight, dbias = by_pixel(dy), torch.empty_like(x), torch.empty_like(weight), torch.empty_like(bias)
        native().norm_activation_backward(address(dy), address(x), *extent(x), *ctx.limits,
                                          *map(address, (weight, bias, mean, inverse, dx, dweight, dbias)))
        return dx, dweight, dbias, None, None


class NormActivation(nn.BatchNorm2d):
    """`activation`: whether ReLU6 follows."""

    def __init__(self, channels, activation):
        assert channels <= MAX_CHANNELS
        super().__init__(channels)
        self.activation = activation

    def forward(self, x):
        if not in_training(self, x):
            y = super().forward(x)
            return F.relu6(y) if self.activation else y
        y, mean, inverse = Fused.apply(x, self.weight, self.bias, self.eps, RELU6 if self.activation else UNBOUNDED)
        self.follow(mean, inverse, x.numel() // x.shape[1])
        return y

    @torch.no_grad()
    def follow(self, mean, inverse, pixels):
        """Updates the running statistics like nn.BatchNorm2d."""
        variance = (inverse.double() ** -2 - self.eps).clamp(min=0).float() * (pixels / max(1, pixels - 1))
        self.running_mean.lerp_(mean, self.momentum)
        self.running_var.lerp_(variance, self.momentum)
        self.num_batches_tracked += 1
