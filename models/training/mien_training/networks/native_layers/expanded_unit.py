"""Expand and depthwise, each with norm and ReLU6, as one layer for training on CPUs.

The expanded map, the largest of all, is never stored: it is computed from the input, a vector of channels of an image
at a time, and again in the backward pass. Maps are fp32 or bfloat16, everything else is fp32.
"""
import ctypes
import functools
from ctypes import POINTER, c_float, c_int, c_size_t, c_void_p

import torch

from mien_training.networks.native_layers.depthwise_unit import Norm, Shape, norm
from mien_training.networks.native_layers.native import address, by_pixel, code

MAX_NARROW = 24  # input channels; with more, a matrix product is faster


class Gradients(ctypes.Structure):
    _fields_ = [(name, c_void_p)
                for name in ("expansion", "first_weight", "first_bias", "weights", "second_weight", "second_bias")]


@functools.lru_cache
def native():
    lib = code("expanded_unit")
    lib.expanded_unit_forward.argtypes = [POINTER(Shape), c_size_t, c_int, c_void_p, c_float, c_void_p, Norm, c_void_p,
                                          Norm, *[c_void_p] * 3]
    lib.expanded_unit_backward.argtypes = [POINTER(Shape), c_size_t, c_int, *[c_void_p] * 4, Norm, c_void_p, Norm,
                                           *[c_void_p] * 2, Gradients]
    return lib


class Fused(torch.autograd.Function):
    """x -> (y, mean and 1 / deviation of the first norm, and of the second)"""

    @staticmethod
    def forward(ctx, x, expansion, first_weight, first_bias, weights, second_weight, second_bias, epsilon, stride,
                padding):
        x, kernel = by_pixel(x), weights.flatten(1).T.contiguous()
        n, narrow, h, w = x.shape
        out = [(side + 2 * padding - 3) // stride + 1 for side in (h, w)]
        convolved, y = (torch.empty(n, len(expansion), *out, dtype=x.dtype, memory_format=torch.channels_last)
                   for _ in range(2))
        first = [first_weight, first_bias, torch.empty_like(first_weight), torch.empty_like(first_weight)]
        second = [second_weight, second_bias, torch.empty_like(second_weight), torch.empty_like(second_weight)]
        gram = torch.empty(narrow + 1, narrow, dtype=torch.float64)
        expansion = expansion.flatten(1).to(x.dtype).float().contiguous()
        native().expanded_unit_forward(Shape(n, h, w, len(expansion), stride, padding), narrow,
                                       x.dtype == torch.bfloat16, address(x),
                                       epsilon, address(expansion), norm(*first), address(kernel), norm(*second),
                                       *map(address, (gram, convolved, y)))
        ctx.save_for_backward(x, convolved, expansion, kernel, gram, *first, *second)
        ctx.stride, ctx.padding, ctx.kernel_shape = stride, padding, weights.shape
        moments = first[2:] + second[2:]
        ctx.mark_non_differentiable(*moments)
        return y, *moments

    @staticmethod
    def backward(ctx, dy, *_):
        x, convolved, expansion, kernel, gram, *norms = ctx.saved_tensors
        dy, dx = by_pixel(dy), torch.empty_like(x)
        gradients = [torch.empty_like(p) for p in (expansion, norms[0], norms[1], kernel, norms[4], norms[5])]
        n, narrow, h, w = x.shape
        native().expanded_unit_backward(Shape(n, h, w, len(expansion), ctx.stride, ctx.padding), narrow,
                                        x.dtype == torch.bfloat16,
                                        *map(address, (dy, x, convolved, expansion)), norm(*norms[:4]), address(kernel),
                                        norm(*norms[4:]),
                                        address(gram), address(dx), Gradients(*map(address, gradients)))
        gradients[0] = gradients[0].view(*gradients[0].shape, 1, 1)
        gradients[3] = gradients[3].T.reshape(ctx.kernel_shape)
        return dx, *gradients, None, None, None


def fits(x):
    """Whether the map has at most MAX_NARROW channels."""
    return x.shape[1] <= MAX_NARROW and x.shape[1] % 8 == 0


def expanded_unit(x, expansion, first, convolution, second):
    """x [n,narrow,h,w]; two pairs of nn.Conv2d without bias (pointwise; 3x3 depthwise) and NormActivation with
    ReLU6."""
    assert convolution.kernel_size == (3, 3) and first.activation and second.activation
    y, *moments = Fused.apply(x, expansion.weight, first.weight, first.bias, convolution.weight, second.weight,
                              second.bias, second.eps, convolution.stride[0], convolution.padding[0])
    first.follow(*moments[:2], x.numel() // x.shape[1])
    second.follow(*moments[2:], y.numel() // y.shape[1])
    return y
