"""Norm and ReLU6 of an expanded map, a 3x3 depthwise convolution, its norm and ReLU6, as one layer for training on a CPU.

Layer by layer these sweep the largest maps of an encoder over and over; here what lies between is made again from the two maps that
are kept, a vector of channels of a picture at a time. Maps are fp32 or bfloat16, parameters and sums fp32. Run as a program it tests itself.
"""
import ctypes
from ctypes import POINTER, c_float, c_int, c_size_t, c_void_p
import functools

import torch
import torch.nn.functional as F
from torch import nn

from native_layers.native import address, by_pixel, code
from native_layers.norm_activation import NormActivation


class Shape(ctypes.Structure):
    _fields_ = [(name, c_size_t) for name in ("images", "height", "width", "channels", "stride", "padding")]


class Norm(ctypes.Structure):
    _fields_ = [(name, c_void_p) for name in ("weight", "bias", "mean", "inverse")]


class Gradients(ctypes.Structure):
    _fields_ = [(name, c_void_p) for name in ("first_weight", "first_bias", "weights", "second_weight", "second_bias")]


@functools.lru_cache
def native():
    lib = code("depthwise_unit")
    lib.depthwise_unit_forward.argtypes = [POINTER(Shape), c_int, c_void_p, c_float, Norm, c_void_p, Norm, c_void_p, c_void_p]
    lib.depthwise_unit_backward.argtypes = [POINTER(Shape), c_int, *[c_void_p] * 3, Norm, c_void_p, Norm, c_void_p, Gradients]
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
        slid, y = (torch.empty(n, c, *out, dtype=x.dtype, memory_format=torch.channels_last) for _ in range(2))
        first = [first_weight, first_bias, like(first_weight), like(first_weight)]
        second = [second_weight, second_bias, like(second_weight), like(second_weight)]
        native().depthwise_unit_forward(shape_of(x, stride, padding), x.dtype == torch.bfloat16, address(x), epsilon, norm(*first),
                                        address(kernel), norm(*second), address(slid), address(y))
        ctx.save_for_backward(x, slid, kernel, *first, *second)
        ctx.stride, ctx.padding, ctx.kernel_shape = stride, padding, weights.shape
        moments = first[2:] + second[2:]
        ctx.mark_non_differentiable(*(m for m in moments if m is not None))
        return y, *moments

    @staticmethod
    def backward(ctx, dy, *_):
        x, slid, kernel, *norms = ctx.saved_tensors
        dy, dx = by_pixel(dy), torch.empty_like(x)
        parameters = norms[0], norms[1], kernel, norms[4], norms[5]
        gradients = [None if p is None else torch.empty_like(p) for p in parameters]
        native().depthwise_unit_backward(shape_of(x, ctx.stride, ctx.padding), x.dtype == torch.bfloat16, address(dy), address(x),
                                         address(slid), norm(*norms[:4]), address(kernel), norm(*norms[4:]), address(dx),
                                         Gradients(*map(address, gradients)))
        gradients[2] = gradients[2].T.reshape(ctx.kernel_shape)
        return dx, *gradients, None, None, None


def depthwise_unit(x, first, convolution, second):
    """x [n,c,h,w]; the norm `first` may be None; `convolution` is the nn.Conv2d, `second` its NormActivation."""
    assert convolution.kernel_size == (3, 3) and second.activation and (first is None or first.activation)
    before = (None, None) if first is None else (first.weight, first.bias)
    y, *moments = Fused.apply(x, *before, convolution.weight, second.weight, second.bias, second.eps, convolution.stride[0],
                              convolution.padding[0])
    if first is not None:
        first.follow(*moments[:2], x.numel() // x.shape[1])
    second.follow(*moments[2:], y.numel() // y.shape[1])
    return y


def self_test():
    """Answers, gradients and statistics against those of PyTorch's own layers in fp64."""
    torch.manual_seed(1)
    for dtype, tolerance in ((torch.float32, 1e-4), (torch.bfloat16, 6e-2)):
        for channels, h, w, stride, padding, expanded in ((40, 13, 11, 1, 0, True), (64, 12, 9, 2, 0, True), (24, 5, 4, 1, 1, True),
                                                          (16, 7, 6, 2, 1, True), (16, 9, 8, 1, 0, False)):
            first = NormActivation(channels, True) if expanded else None
            layers = [first, nn.Conv2d(channels, channels, 3, stride, padding, groups=channels, bias=False), NormActivation(channels, True)]
            for layer in (layers[0], layers[2]):
                if layer is not None:
                    nn.init.uniform_(layer.weight, 0.5, 1.5), nn.init.uniform_(layer.bias, 0.5, 2)
            twin = [nn.BatchNorm2d(channels).double() if isinstance(m, nn.BatchNorm2d) else m and nn.Conv2d(
                channels, channels, 3, stride, padding, groups=channels, bias=False).double() for m in layers]
            for mine, theirs in zip(layers, twin):
                if mine is not None:
                    theirs.load_state_dict(mine.state_dict())
            x = torch.randn(6, channels, h, w).to(dtype).requires_grad_()
            exact = x.detach().double().requires_grad_()
            y = depthwise_unit(x, *layers)
            seen = F.relu6(twin[0](exact)) if expanded else exact
            truth = F.relu6(twin[2](twin[1](seen)))
            slope = torch.randn(truth.shape).to(dtype)
            (y * slope).sum().backward(), (truth * slope).sum().backward()
            pairs = [(y, truth), (x.grad, exact.grad)]
            for mine, theirs in zip(layers, twin):
                if mine is not None:
                    pairs += zip((p.grad for p in mine.parameters()), (p.grad for p in theirs.parameters()))
                    pairs += [(a, b) for a, b in zip(mine.buffers(), theirs.buffers())]
            for mine, theirs in pairs:
                off = float((mine.detach().double() - theirs.detach()).norm() / theirs.double().norm().clamp(min=1))
                assert off < tolerance, (dtype, channels, stride, padding, off)
    print("depthwise_unit: ok")


if __name__ == "__main__":
    self_test()
