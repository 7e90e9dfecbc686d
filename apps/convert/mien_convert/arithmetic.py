"""ONNX operators of arithmetic: with constants, and of two tensors."""
import numpy as np

from .errors import require
from .operands import constant, is_constant, scalar


def add(t, node):
    total = node.inputs[0]
    for other in node.inputs[1:]:
        total = add_two(t, total, other)
    return [total]


def add_two(t, a, b):
    if is_constant(a):
        a, b = b, a
    if is_constant(b):
        return t.affine(a, 1.0, b.astype(np.float64))
    return combined(t, "broadcast_add", a, b)


def combined(t, op, a, b):
    """Arithmetic of two computed tensors; one may be broadcast to the other."""
    rank = max(len(a.shape), len(b.shape))
    a, b = (x.moved(lambda part, x=x: part.reshape([1] * (rank - len(x.shape)) + list(x.shape))) for x in (a, b))
    shape = np.broadcast_shapes(a.shape, b.shape)
    if a.shape != shape and op != "divide":
        a, b = b, a
    if a.shape != shape:
        a = expanded(t, a, shape)
    a, b = t.settled(a), t.settled(b)
    same = t.same_layers(a, b)
    if same:
        return t.replaced_layers(a, {first.number: combined_layers(t, op, first, second) for first, second in same})
    (first, second), steps, back = t.arranged_alike([a, b])
    return t.result(combined_layers(t, op, first, second), steps, back)


def combined_layers(t, op, first, second):
    if op == "broadcast_add" and first.shape == second.shape:
        op = "add"
    return t.layer(op, [first, second], first.shape)


def expanded(t, x, shape):
    """Broadcast along rows and columns: the map is resized."""
    require(len(shape) == 4 and x.shape[:2] == shape[:2],
            f"it broadcasts {list(x.shape)} to {list(shape)}; rows and columns are possible")
    layer, (h, w) = t.as_map(x), shape[2:]
    large = t.layer("resize", [layer], (h, w, layer.shape[2]), height=h, width=w, grid="asymmetric", sampling="floor")
    return t.whole(large, len(x.at))


def subtract(t, node):
    a, b = node.inputs
    if is_constant(a):
        return [t.affine(b, -1.0, a.astype(np.float64))]
    if is_constant(b):
        return [t.affine(a, 1.0, -b.astype(np.float64))]
    return [add_two(t, a, t.affine(b, -1.0, 0.0))]


def multiply(t, node):
    a, b = node.inputs
    if is_constant(a):
        a, b = b, a
    if is_constant(b):
        return [t.affine(a, b.astype(np.float64), 0.0)]
    return [combined(t, "multiply", a, b)]


def divide(t, node):
    a, b = node.inputs
    if is_constant(b):
        return [t.affine(a, 1.0 / b.astype(np.float64), 0.0)]
    if is_constant(a):
        a = t.affine(b, 0.0, a.astype(np.float64))
    return [combined(t, "divide", a, b)]


def reciprocal(t, node):
    x = node.inputs[0]
    return [combined(t, "divide", t.affine(x, 0.0, 1.0), x)]


def negate(t, node):
    return [t.affine(node.inputs[0], -1.0, 0.0)]


def power(t, node):
    x, exponent = node.inputs[0], scalar(constant(node.inputs[1], "exponent"), 1.0)
    require(not is_constant(x), "its base is a constant")
    require(np.size(node.inputs[1]) == 1 and exponent in (0.5, 1, 2, 3, 4),
            f"an exponent of {exponent}; 0.5, 1, 2, 3 and 4 are possible")
    if exponent == 0.5:
        return [square_root(t, x)]
    result = x
    for _ in range(int(exponent) - 1):
        result = combined(t, "multiply", result, x)
    return [result]


def square_root(t, x):
    return t.activated(x, np.sqrt, {"activation": "sqrt"})


def absolute(t, node):
    """relu(x) + relu(-x)"""
    x = t.settled(node.inputs[0])
    parts = [t.activated(t.affine(x, sign, 0.0), lambda v: np.maximum(v, 0), {"activation": "relu"})
             for sign in (1.0, -1.0)]
    return [combined(t, "broadcast_add", *parts)]


def layer_norm(t, node):
    require(len(node.outputs) == 1 or not any(node.outputs[1:]), "its further outputs, mean and deviation")
    x, axis = node.inputs[0], node.attributes.get("axis", -1)
    axis %= len(x.shape)
    require(all(n == 1 for n in x.shape[axis + 1:]),
            f"a normalization over axes {axis} .. {len(x.shape) - 1} together; one axis is possible")
    epsilon = max(node.attributes.get("epsilon", 1e-5), 1e-30)
    layer, steps, back = t.arranged(x, axis)
    y = t.result(t.layer("normalize", [layer], layer.shape, epsilon=epsilon), steps, back)
    scale, bias = (constant(i, "scale").astype(np.float64) if i is not None else neutral
                   for i, neutral in zip((*node.inputs[1:], None)[:2], (1.0, 0.0)))
    return [t.affine(y, scale, bias)]


def batch_norm(t, node):
    require(not node.attributes.get("training_mode", 0), "it is in training mode")
    x = node.inputs[0]
    gain, bias, mean, variance = (constant(i, "statistics").astype(np.float64) for i in node.inputs[1:5])
    scale = gain / np.sqrt(variance + node.attributes.get("epsilon", 1e-5))
    axes = [1, -1] + [1] * (len(x.shape) - 2)
    return [t.affine(x, scale.reshape(axes), (bias - mean * scale).reshape(axes))]
