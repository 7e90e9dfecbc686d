"""An inverted residual without its projection as one layer for training on a CPU: a pointwise convolution that expands few channels to
many, norm and ReLU6, a 3x3 depthwise convolution, norm and ReLU6.

The expanded map, the largest of all, is never stored: it is made from what comes in, a vector of channels of a picture at a time, and again on
the way back. Maps are fp32 or bfloat16, all in between is fp32. Run as a program it tests itself.
"""
import ctypes
from ctypes import POINTER, c_float, c_int, c_size_t, c_void_p
import functools

import torch
import torch.nn.functional as F
from torch import nn

from native_layers.depthwise_unit import Norm, Shape, norm
from native_layers.native import address, by_pixel, code
from native_layers.norm_activation import NormActivation

MOST_NARROW = 24  # channels that come in; beyond, a product of matrices is faster


class Gradients(ctypes.Structure):
    _fields_ = [(name, c_void_p) for name in ("expansion", "first_weight", "first_bias", "weights", "second_weight", "second_bias")]


@functools.lru_cache
def native():
    lib = code("expanded_unit")
    lib.expanded_unit_forward.argtypes = [POINTER(Shape), c_size_t, c_int, c_void_p, c_float, c_void_p, Norm, c_void_p, Norm,
                                          *[c_void_p] * 3]
    lib.expanded_unit_backward.argtypes = [POINTER(Shape), c_size_t, c_int, *[c_void_p] * 4, Norm, c_void_p, Norm, *[c_void_p] * 2,
                                           Gradients]
    return lib


class Fused(torch.autograd.Function):
    """x -> (y, mean and 1 / deviation of the first norm, and of the second)"""

    @staticmethod
    def forward(ctx, x, expansion, first_weight, first_bias, weights, second_weight, second_bias, epsilon, stride, padding):
        x, kernel = by_pixel(x), weights.flatten(1).T.contiguous()
        n, narrow, h, w = x.shape
        out = [(side + 2 * padding - 3) // stride + 1 for side in (h, w)]
        slid, y = (torch.empty(n, len(expansion), *out, dtype=x.dtype, memory_format=torch.channels_last) for _ in range(2))
        first = [first_weight, first_bias, torch.empty_like(first_weight), torch.empty_like(first_weight)]
        second = [second_weight, second_bias, torch.empty_like(second_weight), torch.empty_like(second_weight)]
        gram = torch.empty(narrow + 1, narrow, dtype=torch.float64)
        expansion = expansion.flatten(1).to(x.dtype).float().contiguous()
        native().expanded_unit_forward(Shape(n, h, w, len(expansion), stride, padding), narrow, x.dtype == torch.bfloat16, address(x),
                                       epsilon, address(expansion), norm(*first), address(kernel), norm(*second),
                                       *map(address, (gram, slid, y)))
        ctx.save_for_backward(x, slid, expansion, kernel, gram, *first, *second)
        ctx.stride, ctx.padding, ctx.kernel_shape = stride, padding, weights.shape
        moments = first[2:] + second[2:]
        ctx.mark_non_differentiable(*moments)
        return y, *moments

    @staticmethod
    def backward(ctx, dy, *_):
        x, slid, expansion, kernel, gram, *norms = ctx.saved_tensors
        dy, dx = by_pixel(dy), torch.empty_like(x)
        gradients = [torch.empty_like(p) for p in (expansion, norms[0], norms[1], kernel, norms[4], norms[5])]
        n, narrow, h, w = x.shape
        native().expanded_unit_backward(Shape(n, h, w, len(expansion), ctx.stride, ctx.padding), narrow, x.dtype == torch.bfloat16,
                                        *map(address, (dy, x, slid, expansion)), norm(*norms[:4]), address(kernel), norm(*norms[4:]),
                                        address(gram), address(dx), Gradients(*map(address, gradients)))
        gradients[0] = gradients[0].view(*gradients[0].shape, 1, 1)
        gradients[3] = gradients[3].T.reshape(ctx.kernel_shape)
        return dx, *gradients, None, None, None


def fits(x):
    """Whether a map has few enough channels."""
    return x.shape[1] <= MOST_NARROW and x.shape[1] % 8 == 0


def expanded_unit(x, expansion, first, convolution, second):
    """x [n,narrow,h,w]; two pairs of nn.Conv2d without bias (pointwise; 3x3 depthwise) and NormActivation with ReLU6."""
    assert convolution.kernel_size == (3, 3) and first.activation and second.activation
    y, *moments = Fused.apply(x, expansion.weight, first.weight, first.bias, convolution.weight, second.weight, second.bias, second.eps,
                              convolution.stride[0], convolution.padding[0])
    first.follow(*moments[:2], x.numel() // x.shape[1])
    second.follow(*moments[2:], y.numel() // y.shape[1])
    return y


def self_test():
    """Answers, gradients and statistics against those of PyTorch's own layers in fp64."""
    torch.manual_seed(1)
    for dtype, tolerance in ((torch.float32, 2e-4), (torch.bfloat16, 6e-2)):
        for narrow, channels, h, w, stride, padding in ((16, 32, 13, 11, 1, 0), (24, 96, 12, 9, 2, 0), (40, 120, 5, 5, 1, 1), (16, 40, 7, 6, 2, 1)):
            convolution = lambda: nn.Conv2d(channels, channels, 3, stride, padding, groups=channels, bias=False)
            layers = nn.Sequential(nn.Conv2d(narrow, channels, 1, bias=False), NormActivation(channels, True), convolution(),
                                   NormActivation(channels, True)).train()
            for layer in (layers[1], layers[3]):
                nn.init.uniform_(layer.weight, 0.5, 1.5), nn.init.uniform_(layer.bias, 0.5, 2)
            layers[0].weight.data = layers[0].weight.data.to(dtype).float()
            twin = nn.Sequential(nn.Conv2d(narrow, channels, 1, bias=False), nn.BatchNorm2d(channels), convolution(),
                                 nn.BatchNorm2d(channels)).double().train()
            twin.load_state_dict(layers.state_dict())
            x = (torch.randn(6, narrow, h, w) + 0.5).to(dtype).requires_grad_()
            exact = x.detach().double().requires_grad_()
            y = expanded_unit(x, *layers)
            truth = F.relu6(twin[3](twin[2](F.relu6(twin[1](twin[0](exact))))))
            slope = torch.randn(truth.shape).to(dtype)
            (y * slope).sum().backward(), (truth * slope).sum().backward()
            pairs = [(y, truth), (x.grad, exact.grad), *zip(layers.buffers(), twin.buffers()),
                     *zip((p.grad for p in layers.parameters()), (p.grad for p in twin.parameters()))]
            for mine, theirs in pairs:
                off = float((mine.detach().double() - theirs.detach()).norm() / theirs.detach().double().norm().clamp(min=1))
                assert off < tolerance, (dtype, narrow, channels, stride, padding, off)
    print("expanded_unit: ok")


if __name__ == "__main__":
    self_test()
