"""Evaluates layers with numpy in fp32, to estimate the effect of rounding weights to fp16 on the outputs.

Values are [n, h, w, c]: n independent inputs, or n steps of a stream.
"""
import math

import numpy as np

from .layers import window_count

TENSORS = ("weight", "bias", "weight_ih", "weight_hh")  # of a layer, rounded to fp16 in a file


def exact(values):
    return np.asarray(values, np.float32)


def rounded(values):
    """Like the writer, which first rounds to fp32."""
    return exact(values).astype(np.float16).astype(np.float32)


def in_two_parts(values):
    """The precision of a sum of two fp16 numbers."""
    high = rounded(values)
    return high + rounded(values - high)


def tensors_of(layer):
    slopes = layer.activation.get("slopes")
    return [layer.options[name] for name in TENSORS if name in layer.options] + ([] if slopes is None else [slopes])


def value_of(layer, inputs, weights_as, slopes_as):
    """The output of a layer; the functions transform its tensors."""
    options = {name: weights_as(value) if name in TENSORS else value for name, value in layer.options.items()}
    y = OPERATIONS[layer.op](*inputs, layer, **options)
    kind = layer.activation.get("activation")
    if kind == "prelu":
        return np.where(y < 0, y * slopes_as(layer.activation["slopes"]), y)
    return CURVES[kind](y, layer.activation.get("alpha")) if kind else y


# -- layers ------------------------------------------------------------


def windows(x, weight, stride, padding, fill=0.0):
    """For each tap of a window: its position and the values at it, [n, H, W, c]."""
    top, left, bottom, right = padding
    kh, kw = weight
    h, w = window_count(x.shape[1], kh, stride[0], top, bottom), window_count(x.shape[2], kw, stride[1], left, right)
    if any(padding):
        x = np.pad(x, ((0, 0), (top, bottom), (left, right), (0, 0)), constant_values=fill)
    for row in range(kh):
        for column in range(kw):
            yield row, column, x[:, row:row + (h - 1) * stride[0] + 1:stride[0],
                                 column:column + (w - 1) * stride[1] + 1:stride[1]]


def conv2d(x, _, weight, bias, stride, padding):
    taps = weight.transpose(2, 3, 1, 0)
    return bias + sum(product(part, taps[row, column])
                      for row, column, part in windows(x, weight.shape[2:], stride, padding))


def product(x, matrix):
    """x @ matrix for all pixels at once, because numpy is slow row by row."""
    return (np.ascontiguousarray(x).reshape(-1, x.shape[-1]) @ np.ascontiguousarray(matrix)).reshape(*x.shape[:-1], -1)


def depthwise(x, _, weight, bias, stride, padding):
    return bias + sum(part * weight[:, 0, row, column]
                      for row, column, part in windows(x, weight.shape[2:], stride, padding))


def fully_connected(x, _, weight, bias):
    return (x.transpose(0, 3, 1, 2).reshape(len(x), -1) @ weight.T + bias)[:, None, None, :]


def causal_conv(x, _, weight, bias):
    before = np.concatenate([np.zeros_like(x[:1]), x[:-1]])
    return before @ weight[:, :, 0].T + x @ weight[:, :, 1].T + bias


def lstm(x, _, weight_ih, weight_hh, bias):
    gates, size = x[:, 0, 0] @ weight_ih.T + bias, weight_hh.shape[1]
    hidden, cell, outputs = np.zeros(size, np.float32), np.zeros(size, np.float32), []
    for step in gates:
        i, f, g, o = (step + weight_hh @ hidden).reshape(4, size)
        cell = sigmoid(f) * cell + sigmoid(i) * np.tanh(g)
        hidden = sigmoid(o) * np.tanh(cell)
        outputs.append(hidden)
    return np.stack(outputs)[:, None, None, :]


def max_pool(x, layer, kernel, stride, padding, ceil_mode):
    top, left, bottom, right = padding
    (h, w, _), margins = layer.shape, [bottom, right]
    for axis, (size, before) in enumerate(((h, top), (w, left))):
        reach = (size - 1) * stride[axis] + kernel[axis] - before - x.shape[1 + axis]
        margins[axis] = max(reach, margins[axis]) if ceil_mode else margins[axis]
    parts = windows(x, kernel, stride, (top, left, *margins), -np.inf)
    return np.max([part[:, :h, :w] for _, _, part in parts], axis=0)


def add(a, b, _):
    top, left = ((b.shape[axis] - a.shape[axis]) // 2 for axis in (1, 2))
    return a + b[:, top:top + a.shape[1], left:left + a.shape[2]]


def softmax(x, _):
    y = np.exp(x - x.max(-1, keepdims=True))
    return y / y.sum(-1, keepdims=True)


def cut(x, _, first_channel, channels, padding):
    top, left, bottom, right = padding
    return x[:, top:x.shape[1] - bottom, left:x.shape[2] - right, first_channel:first_channel + channels]


def resize(x, layer, height, width, grid, sampling):
    for axis, size in ((1, height), (2, width)):
        low, high, fraction = places(x.shape[axis], size, grid, sampling)
        fraction = fraction.reshape(-1, *[1] * (3 - axis))
        x = np.take(x, low, axis) * (1 - fraction) + np.take(x, high, axis) * fraction
    return x


def places(old, new, grid, sampling):
    """The two source rows of each row of a resized map, and the weight of the second."""
    at = np.arange(new)
    if grid == "align_corners":
        at = at * (old - 1) / max(new - 1, 1)
    else:
        at = ((2 * at + 1) * old - new) / (2 * new) if grid == "half_pixel" else at * old / new
    if sampling == "bilinear":
        at = np.clip(at, 0, old - 1)
        low = np.floor(at).astype(int)
        return low, np.minimum(low + 1, old - 1), (at - low).astype(np.float32)
    whole = {"round_half_down": np.ceil(at - 0.5), "round_half_up": np.floor(at + 0.5), "floor": np.floor(at),
             "ceil": np.ceil(at)}[sampling]
    nearest = np.clip(whole, 0, old - 1).astype(int)
    return nearest, nearest, np.zeros(new, np.float32)


def rearrange(x, layer, order):
    return x.transpose(0, *(1 + "hwc".index(axis) for axis in order)).reshape(len(x), *layer.shape)


def normalize(x, _, epsilon):
    return (x - x.mean(-1, keepdims=True)) / np.sqrt(x.var(-1, keepdims=True) + np.float32(epsilon))


OPERATIONS = {
    "conv2d": conv2d, "depthwise": depthwise, "fully_connected": fully_connected, "causal_conv": causal_conv,
    "lstm": lstm, "max_pool": max_pool,
    "add": add, "activation": lambda x, _: x, "softmax": softmax, "global_average_pool": lambda x,
    _: x.mean((1, 2), keepdims=True),
    "concat": lambda a, b, _: np.concatenate([a, b], -1), "slice": cut, "multiply": lambda a, b, _: a * b,
    "divide": lambda a, b, _: a / b,
    "broadcast_add": lambda a, b, _: a + b, "resize": resize, "rearrange": rearrange, "normalize": normalize,
}

# -- activations ------------------------------------------------------------


def sigmoid(x):
    return 1 / (1 + np.exp(-x))


def erf(x):
    """Abramowitz and Stegun, 7.1.26: to 1.5e-7."""
    t = 1 / (1 + 0.3275911 * np.abs(x))
    series = t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))))
    return np.sign(x) * (1 - series * np.exp(-x * x))


CURVES = {
    "relu": lambda x, _: np.maximum(x, 0), "relu6": lambda x, _: np.clip(x, 0, 6), "clamp01": lambda x,
    _: np.clip(x, 0, 1),
    "leaky_relu": lambda x, alpha: np.where(x < 0, np.float32(alpha) * x, x), "sigmoid": lambda x, _: sigmoid(x),
    "tanh": lambda x, _: np.tanh(x),
    "hard_swish": lambda x, _: x * np.clip(x + 3, 0, 6) / 6, "swish": lambda x, _: x * sigmoid(x),
    "gelu": lambda x, _: x * (1 + erf(x * np.float32(0.5 ** 0.5))) / 2,
    "gelu_tanh": lambda x,
    _: x * (1 + np.tanh(np.float32((2 / math.pi) ** 0.5) * (x + np.float32(0.044715) * x ** 3))) / 2,
    "erf": lambda x, _: erf(x), "exp": lambda x, _: np.exp(x), "sqrt": lambda x, _: np.sqrt(x),
}
