"""Reads the weights of a .mien file (docs/format.md) as tensors.

It does not validate the file; the library does.
"""
import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch

from mien_convert.weight_file import HEADER_BYTES, OPS, RECORD_BYTES

NAMES = {number: name for name, number in OPS.items()}


@dataclass
class Layer:
    op: str
    channels: int
    weight: torch.Tensor  # [outputs, elements of the reduction] in the file's order; of depthwise layers as stored
    bias: torch.Tensor    # [outputs]


def _tensor(data, record):
    kind, = struct.unpack_from("<H", record, 8)
    offset, size = struct.unpack_from("<2Q", record, 32)
    return np.frombuffer(data, {1: "<f2", 2: "<f4"}[kind], size // (2 * kind), offset).astype(np.float32)


def unpacked(panels, rows):
    """Panels of 16 outputs [panel][k][16], the last one perhaps of 8 -> [rows, k]"""
    width = -(-rows // 8) * 8
    elements = len(panels) // width
    parts = [panels[first * elements:(first + 16) * elements].reshape(elements, -1).T for first in range(0, width, 16)]
    return torch.from_numpy(np.concatenate(parts)[:rows].copy())


def _layer(data, record, tensors):
    op = NAMES[struct.unpack_from("<H", record)[0]]
    channels, = struct.unpack_from("<I", record, 20)
    weights, bias = struct.unpack_from("<2I", record, 48)
    if weights >= len(tensors):
        return Layer(op, channels, None, None)
    rows = channels * (4 if op == "lstm" else 1)
    stored = _tensor(data, tensors[weights])
    weight = torch.from_numpy(stored) if op == "depthwise" else unpacked(stored, rows)
    return Layer(op, channels, weight, torch.from_numpy(_tensor(data, tensors[bias])[:rows].copy()))


def _read(path):
    """(the file, its records of networks, layers and tensors, its names)"""
    data = Path(path).read_bytes()
    counts = struct.unpack_from("<4I", data, 20)
    ends = np.cumsum([HEADER_BYTES, *(RECORD_BYTES * n for n in counts[:3]), 16 * counts[3]])
    records = [[data[at:at + RECORD_BYTES] for at in range(a, b, RECORD_BYTES)] for a, b in zip(ends[:3], ends[1:4])]
    return data, records, data[ends[4]:]


def _name(record, strings):
    at, size = struct.unpack_from("<2I", record)
    return strings[at:at + size].decode()


def networks(path):
    """{name: [Layer]}"""
    data, records, strings = _read(path)
    out = {}
    for record in records[0]:
        first, count = struct.unpack_from("<2I", record, 24)
        out[_name(record, strings)] = [_layer(data, r, records[2]) for r in records[1][first:first + count]]
    return out


def constant(path, name):
    """Values of a constant, flat."""
    data, records, strings = _read(path)
    return torch.from_numpy(next(_tensor(data, r) for r in records[2] if _name(r, strings) == name).copy())


def metadata(path):
    """{key: value}"""
    data = Path(path).read_bytes()
    *counts, pairs, strings = struct.unpack_from("<5I", data, 20)
    at = HEADER_BYTES + RECORD_BYTES * sum(counts[:3])
    texts = data[at + 16 * pairs:at + 16 * pairs + strings]
    text = lambda offset: texts[slice(*np.cumsum(struct.unpack_from("<2I", data, offset)))].decode()
    return {text(at + 16 * k): text(at + 16 * k + 8) for k in range(pairs)}


def split_causal(layer, channels_in):
    """[out, 2 * padded in] -> [out, in, 2]"""
    return layer.weight.reshape(layer.channels, 2, -1)[..., :channels_in].permute(0, 2, 1)


def set_lstm(lstm, layer):
    inputs = lstm.input_size
    lstm.weight_ih_l0.copy_(layer.weight[:, :inputs])
    lstm.weight_hh_l0.copy_(layer.weight[:, -lstm.hidden_size:])
    lstm.bias_ih_l0.copy_(layer.bias)
    lstm.bias_hh_l0.zero_()


def set_linear(linear, layer):
    linear.weight.copy_(layer.weight[:, :linear.in_features])
    linear.bias.copy_(layer.bias)
