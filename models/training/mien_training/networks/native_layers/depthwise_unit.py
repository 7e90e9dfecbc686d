"""Norm and ReLU6 of an expanded map, a 3x3 depthwise convolution, its norm and ReLU6, as one layer for training on
CPUs.

Separate layers read and write the largest maps several times. Here only two maps are stored; the others are recomputed,
a vector of channels of an image at a time. Maps are fp32 or bfloat16, parameters and sums fp32.
"""
import ctypes
import functools
from ctypes import POINTER, c_float, c_int, c_size_t, c_void_p

import torch

from mien_training.networks.native_layers.native import address, by_pixel, code


class Shape(ctypes.Structure):
    _fields_ = [(name, c_size_t) for name in ("images", "height", "width", "channels", "stride", "padding")]


class Norm(ctypes.Structure):
    _fields_ = [(name, c_void_p) for name in ("weight", "bias", "mean", "inverse")]


class Gradients(ctypes.Structure):
    _fields_ = [(name, c_void_p) for name in ("first_weight", "first_bias", "weights", "second_weight", "second_bias")]


@functools.lru_cache
def native():
    lib = code("depthwise_unit")
    lib.depthwise_unit_forward.argtypes = [POINTER(Shape), c_int, c_void_p, c_float, Norm, c_void_p, Norm, c_void_p,
                                           c_void_p]
    lib.depthwise_unit_backward.argtypes = [POINTER(Shape), c_int, *[c_void_p] * 3, Norm, c_void_p, Norm, c_void_p,
                                            Gradients]
    return lib


def shape_of(x, stride, padding):
    n, c, h, w = x.shape
    return Shape(n, h, w, c, stride, padding)


def norm(*tensors):
    return Norm(*map(address, tensors))


class Fused(torch.autograd.Function):
    """x -> (y, mean and 1 / deviation of the first norm, and of the second)"""

    @staticmethod
    def forward(ctx, x, first_weight, first_bias, weights, second_weight, second_bias, epsilon, stride, padding):
        x, kernel = by_pixel(x), weights.flatten(1).T.contiguous()
        like = lambda parameter: None if parameter is None else torch.empty_like(parameter)
        n, c, h, w = x.shape
        out = [(side + 2 * padding - 3) // stride + 1 for side in (h, w)]
        convolved, y = (torch.empty(n, c, *out, dtype=x.dtype, memory_format=torch.channels_last) for _ in range(2))
        first = [first_weight, first_bias, like(first_weight), like(first_weight)]
        second = [second_weight, second_bias, like(second_weight), like(second_weight)]
        native().depthwise_unit_forward(shape_of(x, stride, padding), x.dtype == torch.bfloat16, address(x), epsilon,
                                        norm(*first), address(kernel), norm(*second), address(convolved), address(y))
        ctx.save_for_backward(x, convolved, kernel, *first, *second)
        ctx.stride, ctx.padding, ctx.kernel_shape = stride, padding, weights.shape
        moments = first[2:] + second[2:]
        ctx.mark_non_differentiable(*(m for m in moments if m is not None))
        return y, *moments

    @staticmethod
    def backward(ctx, dy, *_):
        x, convolved, kernel, *norms = ctx.saved_tensors
        dy, dx = by_pixel(dy), torch.empty_like(x)
        parameters = norms[0], norms[1], kernel, norms[4], norms[5]
        gradients = [None if p is None else torch.empty_like(p) for p in parameters]
        native().depthwise_unit_backward(shape_of(x, ctx.stride, ctx.padding), x.dtype == torch.bfloat16, address(dy),
                                         address(x),
                                         address(convolved), norm(*norms[:4]), address(kernel), norm(*norms[4:]),
                                         address(dx), Gradients(*map(address, gradients)))
        gradients[2] = gradients[2].T.reshape(ctx.kernel_shape)
        return dx, *gradients, None, None, None


def depthwise_unit(x, first, convolution, second):
    """x [n,c,h,w]; the norm `first` may be None; `convolution` is the nn.Conv2d, `second` its NormActivation."""
    assert convolution.kernel_size == (3, 3) and second.activation and (first is None or first.activation)
    before = (None, None) if first is None else (first.weight, first.bias)
    y, *moments = Fused.apply(x, *before, convolution.weight, second.weight, second.bias, second.eps,
                              convolution.stride[0], convolution.padding[0])
    if first is not None:
        first.follow(*moments[:2], x.numel() // x.shape[1])
    second.follow(*moments[2:], y.numel() // y.shape[1])
    return y
