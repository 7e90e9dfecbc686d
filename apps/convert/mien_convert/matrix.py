"""ONNX operators that multiply by a matrix."""
import numpy as np

from .convolution import conv_over_map
from .errors import require
from .operands import constant, is_constant


def gemm(t, node):
    a, b = node.inputs[:2]
    require(not is_constant(a), "its first operand is a constant")
    require(not node.attributes.get("transA", 0), "transA")
    weight = constant(b, "second operand").astype(np.float64) * node.attributes.get("alpha", 1.0)
    weight = weight if node.attributes.get("transB", 0) else weight.T
    bias = np.zeros(len(weight))
    if len(node.inputs) > 2 and node.inputs[2] is not None:
        addend = constant(node.inputs[2], "addend") * node.attributes.get("beta", 1.0)
        require(addend.size in (1, len(weight)), f"an addend {list(addend.shape)}")
        bias = bias + addend.reshape(-1)
    return [product(t, a, weight, bias)]


def matmul(t, node):
    a, b = node.inputs
    require(not is_constant(a), "its first operand is a constant")
    weight = constant(b, "second operand").astype(np.float64)
    require(weight.ndim == 2, f"a weight {list(weight.shape)}")
    return [product(t, a, weight.T, np.zeros(weight.shape[1]))]


def product(t, x, weight, bias):
    """[..., n] times weight [out, n]: for a vector, for every step, or at every pixel."""
    rows = x.moved(lambda part: part.reshape(-1, part.shape[-1]))
    require(weight.shape[1] == rows.shape[1], f"{rows.shape[1]} numbers times a weight for {weight.shape[1]}")
    if len(rows.at) <= max(t.steps, 1):
        y = t.whole(t.dense(t.rows(rows), weight, bias), len(rows.at))
        return y.moved(lambda part: part.reshape(*x.shape[:-1], len(weight)))
    return at_every_pixel(t, rows, x.shape[-3:-1], weight,
                          bias).moved(lambda part: part.reshape(*x.shape[:-1], len(weight)))


def at_every_pixel(t, rows, shape, weight, bias):
    """[h * w, n] times weight [out, n] -> [h * w, out]. The rows are the pixels of a map, else of one of that shape."""
    numbers = rows.layer_numbers()
    require(len(numbers) > 0, "all its inputs are constants")
    h, w, _ = t.real(numbers[0]).shape
    if len(rows.at) != h * w:
        h, w = shape if len(shape) == 2 and shape[0] * shape[1] == len(rows.at) else (len(rows.at), 1)
    x = rows.moved(lambda part: part.T.reshape(1, -1, h, w))
    y = conv_over_map(t, x, weight[:, :, None, None], bias, 1, [1, 1], (0, 0, 0, 0))
    return y.moved(lambda part: part.reshape(len(weight), -1).T)
