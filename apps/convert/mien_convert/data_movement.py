"""ONNX operators that only move elements, for constants and computed tensors."""
import math

import numpy as np

from . import tensors
from .constants import axes_of
from .errors import require, require_room
from .operands import as_tensor, constant, is_constant, scalar
from .tensors import NOTHING, Tensor


def moved(x, move):
    return move(x) if is_constant(x) else x.moved(move)


def identity(t, node):
    return [node.inputs[0]]


def dropout(t, node):
    training = constant(node.inputs[2], "training_mode") if len(node.inputs) > 2 else None
    require(not scalar(training, 0), "it is in training mode")
    return [node.inputs[0], None]


def cast(t, node):
    require(node.attributes["to"] in (1, 10, 11), "it converts computed values to integers")
    return [node.inputs[0]]


def reshape(t, node):
    x, wanted = node.inputs[0], [int(n) for n in constant(node.inputs[1], "shape")]
    if not node.attributes.get("allowzero", 0):
        wanted = [x.shape[i] if n == 0 else n for i, n in enumerate(wanted)]
    return [moved(x, lambda part: part.reshape(wanted))]


def flatten(t, node):
    x, axis = node.inputs[0], node.attributes.get("axis", 1)
    rows = math.prod(x.shape[:axis])
    return [moved(x, lambda part: part.reshape(rows, -1))]


def squeeze(t, node):
    x, axes = node.inputs[0], axes_of(node.inputs, node.attributes)
    axes = [i for i, n in enumerate(x.shape) if n == 1] if axes is None else axes
    return [moved(x, lambda part: part.squeeze(tuple(axes)))]


def unsqueeze(t, node):
    x, axes = node.inputs[0], axes_of(node.inputs, node.attributes)
    return [moved(x, lambda part: np.expand_dims(part, tuple(axes)))]


def transpose(t, node):
    order = node.attributes.get("perm")
    return [moved(node.inputs[0], lambda part: part.transpose(order))]


def gather(t, node):
    index, axis = constant(node.inputs[1], "index").astype(np.int64), node.attributes.get("axis", 0)
    x = node.inputs[0]
    require_room(math.prod(x.shape) // max(x.shape[axis], 1), index.size)
    return [moved(x, lambda part: np.take(part, index, axis))]


def slice_(t, node):
    x = node.inputs[0]
    if t.opset < 10:
        starts, ends, axes = (node.attributes.get(key) for key in ("starts", "ends", "axes"))
    else:
        starts, ends = (constant(i, "range").reshape(-1) for i in node.inputs[1:3])
        axes = axes_of(node.inputs, {}, 3)
    axes = range(len(starts)) if axes is None else axes
    steps = constant(node.inputs[4], "steps").reshape(-1) if len(node.inputs) > 4 and node.inputs[
        4] is not None else np.ones(len(starts), int)
    ranges = [slice(None)] * len(x.shape)
    for axis, start, end, step in zip(axes, starts, ends, steps):
        size = x.shape[axis]
        first, last = slice_bounds(int(start), int(end), int(step), size)
        ranges[axis] = slice(first, last, int(step))
    return [moved(x, lambda part: part[tuple(ranges)])]


def slice_bounds(start, end, step, size):
    """Converts an ONNX range to one of Python: clamps distant ends; a descending range that includes the first element
    has no end."""
    low, high = (0, size) if step > 0 else (-1, size - 1)
    first, last = (min(max(n + size if n < 0 else n, low), high) for n in (start, max(end, -size - 1)))
    return max(first, 0), None if last < 0 else last


def split(t, node):
    x, axis = node.inputs[0], node.attributes.get("axis", 0)
    sizes = constant(node.inputs[1], "split") if len(node.inputs) > 1 else node.attributes.get("split")
    if sizes is None:
        part = math.ceil(x.shape[axis] / len(node.outputs))
        sizes = [min(part, x.shape[axis] - part * i) for i in range(len(node.outputs))]
    ends = np.cumsum([int(n) for n in sizes])
    return [moved(x, lambda part, first=end - n, last=end: np.take(part, range(first, last), axis))
            for n, end in zip(sizes, ends)]


def concat(t, node):
    axis = node.attributes["axis"]
    if all(map(is_constant, node.inputs)):
        return [np.concatenate(node.inputs, axis)]
    return [tensors.joined([as_tensor(x) for x in node.inputs], axis)]


def pad(t, node):
    x, mode = node.inputs[0], node.attributes.get("mode", "constant")
    require(mode == "constant",
            f"padding of mode {mode!r}; zeros are possible: pad the input in your program and export the model without "
            "it")
    if t.opset < 11:
        amounts, value = node.attributes["pads"], node.attributes.get("value", 0.0)
    else:
        amounts = constant(node.inputs[1], "pads").reshape(-1)
        value = scalar(constant(node.inputs[2], "value") if len(node.inputs) > 2 else None, 0.0)
    axes = axes_of(node.inputs, {}, 3)
    axes = list(range(len(x.shape))) if axes is None else axes
    before, after = [0] * len(x.shape), [0] * len(x.shape)
    for i, axis in enumerate(axes):
        before[axis], after[axis] = int(amounts[i]), int(amounts[len(axes) + i])
    require(min(before + after) >= 0, "negative padding")
    require_room(*(b + n + e for b, n, e in zip(before, x.shape, after)))
    widths = list(zip(before, after))
    x = as_tensor(x)
    return [Tensor(np.pad(x.at, widths, constant_values=NOTHING), np.pad(x.scale, widths, constant_values=1.0),
                   np.pad(x.shift, widths, constant_values=value))]


def shape(t, node):
    first, last = node.attributes.get("start", 0), node.attributes.get("end")
    return [np.array(node.inputs[0].shape[first:last], np.int64)]
