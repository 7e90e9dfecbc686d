"""Tensors of an ONNX graph in terms of the engine's layers.

A tensor maps each element to an element of a layer, or to a constant. Therefore operators that only move elements
(Reshape, Transpose, Slice, Concat, Pad, ...) cost nothing until a layer needs them in another order. An element is

    scale * (element of a layer, or 0) + shift

`at` identifies the element: layer << 32 | step * size + (channel * h + row) * w + column, or NOTHING for a constant.
"""
import numpy as np

from .errors import Refused, require, require_room

NOTHING, FUTURE = -1, -2  # FUTURE: of later steps of the stream, which a convolution over time reads
BITS = 32
MASK = (1 << BITS) - 1


class Tensor:
    def __init__(self, at, scale=None, shift=None):
        self.at = at
        # A scalar, which takes no memory until it is used in arithmetic.
        self.scale = np.broadcast_to(1.0, at.shape) if scale is None else scale
        self.shift = np.broadcast_to(0.0, at.shape) if shift is None else shift

    @property
    def shape(self):
        return self.at.shape

    def moved(self, move):
        """The same elements in another arrangement."""
        return Tensor(move(self.at), move(self.scale), move(self.shift))

    def constant(self):
        """The values, if all elements are constants."""
        return self.shift if (self.at == NOTHING).all() else None

    def is_plain(self):
        return not ((self.at >= 0) & ((self.scale != 1) | (self.shift != 0))).any()

    def layer_numbers(self):
        return [int(n) for n in np.unique(self.at[self.at >= 0] >> BITS)]


def of_constant(values):
    values = np.asarray(values, dtype=np.float64)
    return Tensor(np.full(values.shape, NOTHING, np.int64), shift=values)


def joined(tensors, axis):
    require_room(sum(t.at.size for t in tensors))
    return Tensor(*(np.concatenate([getattr(t, part) for t in tensors], axis) for part in ("at", "scale", "shift")))


def elements(layer, steps=1):
    """[steps, c, h, w]"""
    h, w, c = layer.shape
    return (layer.number << BITS) + np.arange(steps * layer.size, dtype=np.int64).reshape(steps, c, h, w)


def per_channel(layer, at, values, neutral):
    """Converts values per element of a layer to values per channel."""
    h, w, c = layer.shape
    channel = (at & MASK) % layer.size // (h * w)
    of_channel = np.full(c, neutral, np.float64)
    of_channel[channel] = values  # the last axis, over which values must be equal
    require((of_channel[channel] == values).all(), "its second operand is not one number for each channel")
    return of_channel


def along(array, other_axes, message):
    """Removes the axes along which all values are equal."""
    first = array[tuple(slice(0, 1) if axis in other_axes else slice(None) for axis in range(array.ndim))]
    require((array == first).all(), message)
    return first.reshape([n for axis, n in enumerate(array.shape) if axis not in other_axes])


def zero_border(tensor):
    """(top, left, bottom, right): numbers of rows and columns of zeros around [1, c, h, w], and the tensor without
    them."""
    empty = ((tensor.at == NOTHING) & (tensor.shift == 0)).all((0, 1))
    rows, columns = np.flatnonzero(~empty.all(1)), np.flatnonzero(~empty.all(0))
    if not len(rows):
        raise Refused("all its inputs are zeros")
    top, left, bottom, right = rows[0], columns[0], rows[-1] + 1, columns[-1] + 1
    border = int(top), int(left), int(empty.shape[0] - bottom), int(empty.shape[1] - right)
    return border, tensor.moved(lambda part: part[:, :, top:bottom, left:right])
