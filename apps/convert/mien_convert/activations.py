"""ONNX operators that change each element by itself, and softmax."""
import math

import numpy as np

from . import tensors
from .arithmetic import combined
from .errors import require
from .operands import constant, is_constant, scalar


def relu(t, node):
    return [t.activated(node.inputs[0], lambda x: np.maximum(x, 0), {"activation": "relu"})]


def sigmoid(t, node):
    return [t.activated(node.inputs[0], lambda x: 1 / (1 + np.exp(-x)), {"activation": "sigmoid"})]


def tanh(t, node):
    return [t.activated(node.inputs[0], np.tanh, {"activation": "tanh"})]


def leaky_relu(t, node):
    return [leaky(t, node.inputs[0], node.attributes.get("alpha", 0.01))]


def leaky(t, x, alpha):
    def function(v):
        return np.where(v < 0, alpha * v, v)
    if alpha == 0:
        return t.activated(x, function, {"activation": "relu"})
    if 0 < alpha < 1:
        return t.activated(x, function, {"activation": "leaky_relu", "alpha": alpha})
    return t.activated(x, function, {"activation": "prelu"}, lambda number: np.full(t.layers[number].shape[2], alpha))


def prelu(t, node):
    x, slope = t.settled(node.inputs[0]), constant(node.inputs[1], "slope").astype(np.float64)
    slope = np.broadcast_to(slope, x.shape)
    constants = x.at < 0
    require(not (constants & (x.shift < 0)).any(), "a negative constant beside computed values")

    def slopes(number):
        mine = (x.at >= 0) & (x.at >> tensors.BITS == number)
        return tensors.per_channel(t.layers[number], x.at[mine], slope[mine], 0.0)
    return [t.activated(x, lambda v: v, {"activation": "prelu"}, slopes)]


def clip(t, node):
    """Limits are attributes until opset 10."""
    inputs, given = [*node.inputs, None, None], node.attributes
    low, high = given.get("min", -math.inf), given.get("max", math.inf)
    return [limited(t, node.inputs[0], scalar(constant(inputs[1], "minimum"), low),
                    scalar(constant(inputs[2], "maximum"), high))]


def largest(t, node):
    return [of_numbers(t, node, lambda x, number: limited(t, x, number, math.inf))]


def smallest(t, node):
    return [of_numbers(t, node, lambda x, number: limited(t, x, -math.inf, number))]


def of_numbers(t, node, function):
    """For one tensor and scalar constants."""
    numbers = [x for x in node.inputs if is_constant(x)]
    require(len(numbers) == len(node.inputs) - 1 and all(np.size(n) == 1 for n in numbers),
            "it compares tensors; numbers are possible")
    x, = [x for x in node.inputs if not is_constant(x)]
    for number in numbers:
        x = function(x, scalar(number, 0.0))
    return x


def limited(t, x, low, high):
    # Exporters write the largest float for no limit, and ReLU6 as a clip at 6 after a ReLU.
    low, high = low if low > -3e38 else -math.inf, high if high < 3e38 else math.inf
    return clipped(t, x, max(low, 0.0) if not_negative(t, x) else low, high)


def not_negative(t, x):
    return x.is_plain() and not ((x.at < 0) & (x.shift < 0)).any() and all(
        t.layers[n].activation.get("activation") in ("relu", "relu6", "clamp01", "sigmoid") for n in x.layer_numbers())


def clipped(t, x, low, high):
    """Expresses a clip with the available activations: relu, relu6, and clamp01 between two affine layers."""
    if low == -math.inf and high == math.inf:
        return x
    if low == -math.inf:  # high - relu(high - x)
        return t.affine(clipped(t, t.affine(x, -1.0, high), 0.0, math.inf), -1.0, high)
    if low == 0 and high == 6:
        return t.activated(x, lambda v: np.clip(v, 0, 6), {"activation": "relu6"})
    if high == math.inf:
        x = x if low == 0 else t.affine(x, 1.0, -low)
        x = t.activated(x, lambda v: np.maximum(v, 0), {"activation": "relu"})
        return x if low == 0 else t.affine(x, 1.0, low)
    require(low < high, f"a range of {low} .. {high}")
    x = x if (low, high) == (0, 1) else t.affine(x, 1 / (high - low), -low / (high - low))
    x = t.activated(x, lambda v: np.clip(v, 0, 1), {"activation": "clamp01"})
    return x if (low, high) == (0, 1) else t.affine(x, high - low, low)


def hard_sigmoid(t, node):
    x = t.affine(node.inputs[0], node.attributes.get("alpha", 0.2), node.attributes.get("beta", 0.5))
    return [clipped(t, x, 0.0, 1.0)]


def curve(kind, function):
    """An operator that is an activation of the engine."""
    return lambda t, node: [t.activated(node.inputs[0], function, {"activation": kind})]


def erf_of(x):
    return np.vectorize(math.erf, otypes=[float])(x)


def gelu_of(x):
    return 0.5 * x * (1 + erf_of(x / math.sqrt(2)))


def gelu_tanh_of(x):
    return 0.5 * x * (1 + np.tanh(math.sqrt(2 / math.pi) * (x + 0.044715 * x ** 3)))


def gelu(t, node):
    approximate = node.attributes.get("approximate", "none")
    require(approximate in ("none", "tanh"), f"the approximation {approximate!r}")
    kind, function = ("gelu_tanh", gelu_tanh_of) if approximate == "tanh" else ("gelu", gelu_of)
    return curve(kind, function)(t, node)


def swish(t, node):
    x = t.settled(node.inputs[0])
    gate = t.activated(t.affine(x, node.attributes.get("alpha", 1.0), 0.0),
                       lambda v: 1 / (1 + np.exp(-v)), {"activation": "sigmoid"})
    return [combined(t, "multiply", x, gate)]


def elu(t, node):
    """relu(x) + alpha (exp(min(x, 0)) - 1)"""
    x = t.settled(node.inputs[0])
    below = t.activated(clipped(t, x, -math.inf, 0.0), np.exp, {"activation": "exp"})
    alpha = node.attributes.get("alpha", 1.0)
    above = t.activated(x, lambda v: np.maximum(v, 0), {"activation": "relu"})
    return [combined(t, "broadcast_add", above, t.affine(below, alpha, -alpha))]


CURVES = {"HardSwish": curve("hard_swish", lambda x: x * np.clip(x + 3, 0, 6) / 6), "Erf": curve("erf", erf_of),
          "Exp": curve("exp", np.exp), "Sqrt": curve("sqrt", np.sqrt)}


def softmax(t, node):
    x = node.inputs[0]
    axis = node.attributes.get("axis", -1 if t.opset >= 13 else 1) % len(x.shape)
    # Until opset 12 it applies to all axes from this one on.
    require(t.opset >= 13 or math.prod(x.shape[axis:]) == max(x.shape[axis:]),
            f"a softmax over axes {axis} .. {len(x.shape) - 1} together")
    axis = axis if t.opset >= 13 else axis + int(np.argmax(x.shape[axis:]))
    layer, steps, back = t.arranged(x, axis)
    return [t.result(t.layer("softmax", [layer], layer.shape), steps, back)]
