"""Runs an ONNX graph with numpy alone: the reference for the converter's outputs where ONNX Runtime is not installed.

Supports the operators of arithmetic_cases.py in the forms that it writes. Follows ONNX's documentation and shares no
code with the converter.
"""
import math

import numpy as np
from onnx import helper, numpy_helper


def run(case, x):
    """All outputs."""
    model = case.model()
    values = {"": None, "x": x.astype(np.float64)}
    values.update({p.name: numpy_helper.to_array(p) for p in model.graph.initializer})
    opset = model.opset_import[0].version
    for node in model.graph.node:
        attributes = {a.name: helper.get_attribute_value(a) for a in node.attribute}
        attributes = {key: value.decode() if isinstance(value, bytes) else value for key, value in attributes.items()}
        results = OPERATORS[node.op_type]([values[name] for name in node.input], attributes, opset, len(node.output))
        values.update(zip(node.output, results if isinstance(results, list) else [results]))
    return [values[name] for name in case.outputs]


def conv(inputs, a, *_):
    x, w, *b = inputs
    groups, pads, strides = a.get("group", 1), a.get("pads", [0] * 4), a.get("strides", [1, 1])
    x = np.pad(x, ((0, 0), (0, 0), (pads[0], pads[2]), (pads[1], pads[3])))
    windows = np.lib.stride_tricks.sliding_window_view(x, w.shape[2:], (2, 3))[:, :, ::strides[0], ::strides[1]]
    n = w.shape[0] // groups
    parts = [np.einsum("bchwij,ocij->bohw", windows[:, g * w.shape[1]:(g + 1) * w.shape[1]], w[g * n:(g + 1) * n])
             for g in range(groups)]
    return np.concatenate(parts, 1) + (b[0].reshape(1, -1, 1, 1) if b else 0)


def clip(inputs, a, opset, _):
    low, high = (a.get("min"), a.get("max")) if opset < 11 else (*inputs[1:], None, None)[:2]
    return np.clip(inputs[0], -np.inf if low is None else low, np.inf if high is None else high)


def erf(x):
    return np.vectorize(math.erf)(x)


def gelu(inputs, a, *_):
    x = inputs[0]
    inner = np.tanh(math.sqrt(2 / math.pi)
                    * (x + 0.044715 * x ** 3)) if a.get("approximate") == "tanh" else erf(x / math.sqrt(2))
    return x * (1 + inner) / 2


def softmax(inputs, a, opset, _):
    x, axis = inputs[0], a.get("axis", -1)
    power = np.exp(x - x.max(axis, keepdims=True))
    return power / power.sum(axis, keepdims=True)


def mean(inputs, a, *_):
    axes = inputs[1].tolist() if len(inputs) > 1 else a.get("axes")
    return inputs[0].mean(tuple(axes) if axes else None, keepdims=bool(a.get("keepdims", 1)))


def normalized(inputs, a, *_):
    x, scale, bias = inputs
    return (x - x.mean(-1, keepdims=True)) / np.sqrt(x.var(-1, keepdims=True) + a.get("epsilon", 1e-5)) * scale + bias


def split(inputs, a, opset, outputs):
    sizes = inputs[1].tolist() if len(inputs) > 1 else a.get("split") or [
        inputs[0].shape[a["axis"]] // outputs] * outputs
    return np.split(inputs[0], np.cumsum(sizes)[:-1], a["axis"])


def sliced(inputs, a, opset, _):
    starts, ends, axes = (a["starts"], a["ends"], a["axes"]) if opset < 10 else inputs[1:4]
    ranges = [slice(None)] * inputs[0].ndim
    for start, end, axis in zip(starts, ends, axes):
        ranges[axis] = slice(int(start), int(end))
    return inputs[0][tuple(ranges)]


def padded(inputs, a, opset, _):
    pads = a["pads"] if opset < 11 else inputs[1]
    n = inputs[0].ndim
    return np.pad(inputs[0], [(int(pads[i]), int(pads[n + i])) for i in range(n)])


def place(i, old, new, mode):
    if mode == "align_corners":
        return i * (old - 1) / (new - 1) if new > 1 else 0.0
    if mode == "asymmetric":
        return i * old / new
    if mode == "pytorch_half_pixel" and new == 1:
        return 0.0
    return (i + 0.5) * old / new - 0.5


ROUNDINGS = {"round_prefer_floor": lambda v: math.ceil(v - 0.5 - 1e-9),
             "round_prefer_ceil": lambda v: math.floor(v + 0.5 + 1e-9),
             "floor": lambda v: math.floor(v + 1e-9), "ceil": lambda v: math.ceil(v - 1e-9)}


def matrix(old, new, linear, mode, rounding):
    """[new, old], a row for each place."""
    weights = np.zeros((new, old))
    for i in range(new):
        at = place(i, old, new, mode)
        at = min(max(at if linear else ROUNDINGS[rounding](at), 0), old - 1)
        low = int(at)
        weights[i, low] += 1 - (at - low)
        weights[i, min(low + 1, old - 1)] += at - low
    return weights


def resize(inputs, a, opset, _):
    x, linear = inputs[0], a.get("mode", "nearest") != "nearest"
    if opset < 11:
        scales, sizes, mode, rounding = inputs[1], None, "asymmetric", "floor"
    else:
        scales, sizes = (*inputs[2:], None)[:2]
        mode, rounding = a.get("coordinate_transformation_mode", "half_pixel"), a.get("nearest_mode",
                                                                                      "round_prefer_floor")
    sizes = [int(n) for n in sizes] if sizes is not None else [int(round(n * s)) for n, s in zip(x.shape, scales)]
    rows, columns = (matrix(x.shape[axis], sizes[axis], linear, mode, rounding) for axis in (2, 3))
    return np.einsum("ih,bchw,jw->bcij", rows, x, columns)


OPERATORS = {
    "Conv": conv, "Clip": clip, "Gelu": gelu, "Softmax": softmax, "ReduceMean": mean, "LayerNormalization": normalized,
    "Split": split, "Slice": sliced, "Pad": padded, "Resize": resize, "Upsample": resize,
    "Relu": lambda i, *_: np.maximum(i[0], 0), "Sigmoid": lambda i, *_: 1 / (1 + np.exp(-i[0])), "Tanh": lambda i,
    *_: np.tanh(i[0]),
    "Exp": lambda i, *_: np.exp(i[0]), "Sqrt": lambda i, *_: np.sqrt(i[0]), "Erf": lambda i, *_: erf(i[0]),
    "Abs": lambda i, *_: np.abs(i[0]), "Pow": lambda i, *_: i[0] ** i[1], "Reciprocal": lambda i, *_: 1 / i[0],
    "Max": lambda i, *_: np.maximum(*i), "Min": lambda i, *_: np.minimum(*i),
    "Elu": lambda i, a, *_: np.where(i[0] < 0, a.get("alpha", 1.0) * (np.exp(i[0]) - 1), i[0]),
    "Swish": lambda i, a, *_: i[0] / (1 + np.exp(-a.get("alpha", 1.0) * i[0])),
    "HardSwish": lambda i, *_: i[0] * np.clip(i[0] + 3, 0, 6) / 6,
    "HardSigmoid": lambda i, a, *_: np.clip(a.get("alpha", 0.2) * i[0] + a.get("beta", 0.5), 0, 1),
    "Mul": lambda i, *_: i[0] * i[1], "Add": lambda i, *_: i[0] + i[1], "Sub": lambda i, *_: i[0] - i[1],
    "Div": lambda i, *_: i[0] / i[1],
    "GlobalAveragePool": lambda i, *_: i[0].mean((2, 3), keepdims=True), "ReduceSum": lambda i,
    *_: i[0].sum(tuple(i[1]), keepdims=True),
    "Transpose": lambda i, a, *_: i[0].transpose(a["perm"]), "Concat": lambda i, a, *_: np.concatenate(i, a["axis"]),
    "Reshape": lambda i, *_: i[0].reshape([i[0].shape[k] if n == 0 else int(n) for k, n in enumerate(i[1])]),
    "Flatten": lambda i, *_: i[0].reshape(len(i[0]), -1), "Tile": lambda i, *_: np.tile(*i), "MatMul": lambda i,
    *_: i[0] @ i[1], "Identity": lambda i, *_: i[0],
}
