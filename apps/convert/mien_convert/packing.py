"""Tensors of a weight file: values in the packed order that docs/format.md defines."""
import math
import struct
from array import array

FP16, FP32 = 1, 2
MAX_DIM, MAX_RANK = 1 << 20, 4


def require(condition, message):
    if not condition:
        raise ValueError(message)


def round_up_8(n):
    return -(-n // 8) * 8


class Tensor:
    def __init__(self, floats, shape, data_type):
        require(all(1 <= n <= MAX_DIM for n in shape), f"dimensions {shape}")
        require(all(map(math.isfinite, floats)), "a value is not a finite float")
        self.shape, self.data_type = tuple(shape), data_type
        try:
            self.data = struct.pack(f"<{len(floats)}{'e' if data_type == FP16 else 'f'}", *floats)
        except OverflowError as error:
            raise ValueError("a weight is too large for fp16") from error

    def record(self, name, offset):
        dims = self.shape + (0,) * (MAX_RANK - len(self.shape))
        return struct.pack("<2I2H4x4I2Q16x", *name, self.data_type, len(self.shape), *dims, offset, len(self.data))


def panels(values, outputs, order, shape):
    """[outputs][row] -> panels of 16 outputs [panel][k][16]; `order` gives the row's element for each k, None a
    zero."""
    row, width = len(values) // outputs, round_up_8(outputs)
    padding = array("f", bytes(4 * (width - outputs)))
    zeros = array("f", bytes(4 * width))
    columns = [zeros if k is None else values[k::row] + padding for k in order]
    packed = array("f")
    for first in range(0, width, 16):
        for column in columns:
            packed += column[first:first + 16]
    return Tensor(packed, shape, FP16)


def depthwise_tensor(values, channels, kh, kw):
    """[channels][kh][kw] -> [block][kh][kw][8]"""
    taps = kh * kw
    values = values + array("f", bytes(4 * taps * (round_up_8(channels) - channels)))
    packed = array("f")
    for block in range(0, channels, 8):
        for tap in range(taps):
            packed += values[block * taps + tap:(block + 8) * taps:taps]
    return Tensor(packed, (round_up_8(channels), kh, kw), FP16)


def vector(values, count):
    """Bias or slopes, padded with zeros."""
    floats = array("f", bytes(4 * count)) if values is None else shaped(values, 1)[0]
    require(len(floats) == count, f"{len(floats)} values, not {count}")
    return Tensor(floats + array("f", bytes(4 * (round_up_8(count) - count))), (round_up_8(count),), FP16)


def padded_order(order):
    return list(order) + [None] * (-len(order) % 8)


def shaped(values, rank):
    """Flat floats and the shape without the ones behind `rank`."""
    floats, shape = flat_floats(values)
    require(len(shape) >= rank and all(n == 1 for n in shape[rank:]), f"shape {shape}, rank {rank} wanted")
    require(len(floats) > 0, f"shape {shape} is empty")
    return floats, shape[:rank]


def flat_floats(values):
    if isinstance(values, tuple) and len(values) == 2 and isinstance(values[0], array):
        floats, shape = array("f", values[0]), tuple(values[1])
    elif hasattr(values, "tolist"):
        shape = tuple(values.shape)
        floats = array("f", values.reshape(-1).tolist())
    else:
        shape, floats = nested_shape(values), array("f", flatten(values))
    require(len(floats) == math.prod(shape), f"{len(floats)} values in shape {shape}")
    return floats, shape


def nested_shape(values):
    return (len(values), *(nested_shape(values[0]) if values else ())) if isinstance(values, (list, tuple)) else ()


def flatten(values):
    if not isinstance(values, (list, tuple)):
        return [values]
    require(len({nested_shape(v) for v in values}) <= 1, "ragged array")
    return [x for v in values for x in flatten(v)]
