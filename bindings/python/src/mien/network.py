"""Custom networks: weight files that `python -m mien.convert` makes from ONNX files."""

from __future__ import annotations

from ctypes import byref, c_float
from typing import Any, NamedTuple, Optional, Union

import numpy as np
import numpy.typing as npt

from ._handle import Handle
from ._library import NetworkConfig, NetworkShape, function
from .errors import check, check_detail, new_detail
from .weights import Model, Weights, opened

Floats = npt.NDArray[np.float32]
_BLOCK = 8  # channels stored together
_INTERLEAVED = 4  # an input of up to this number of channels is stored as an image


class Shape(NamedTuple):
    channels: int
    height: int
    width: int


class Network(Handle):
    """A network of a weight file. One thread at a time may use it.

    model: a path, the file's bytes, or Weights. name: of the network; default: the file's first.
    size: (height, width) of the input, for networks that accept several.
    """

    _kind = "network"

    def __init__(self, model: Union[Model, Weights], name: Optional[str] = None, size: Optional[tuple[int, int]] = None) -> None:
        super().__init__()
        self._weights = opened(model)  # whose files must outlive the network
        config = NetworkConfig()
        function("mien_network_config_default")(byref(config))
        config.weights = self._weights._open()
        config.name = None if name is None else name.encode()
        if size is not None:
            config.height, config.width = size
        detail = new_detail()
        check_detail(function("mien_network_create")(byref(config), byref(self._handle), byref(detail)), detail, self._weights.names)
        shape = NetworkShape()
        place = function("mien_network_input")(self._handle, byref(shape))
        self.input_shape = Shape(shape.channels, shape.height, shape.width)
        c, h, w = self.input_shape
        self._interleaved = c <= _INTERLEAVED and h * w > 1
        self._input = _floats_at(place, h * w * c if self._interleaved else -(-c // _BLOCK) * h * w * _BLOCK)

    def run(self, array: npt.ArrayLike) -> list[Floats]:
        """Runs the network once. Returns every output as [channels, height, width], or [channels] for a vector.

        array: [channels, height, width], or [channels] for a vector, or [channels, width] for a map of one row. Leading axes of 1
        are allowed, and one leading axis of steps with one run each: outputs have the same leading axes. Other shapes raise
        ValueError, even with the right number of elements.
        """
        given = np.asarray(array, np.float32)
        front = given.shape[: given.ndim - self._item_axes(given.shape)]
        maps = given.reshape(-1, *self.input_shape)
        return [np.stack(outputs).reshape(front + outputs[0].shape) for outputs in zip(*(self._step(step) for step in maps))]

    def _item_axes(self, shape: tuple[int, ...]) -> int:
        """Number of trailing axes of one input. Sizes must match, so that a wrong order of axes is an error."""
        c, h, w = self.input_shape
        items = [(c, h, w)] + ([(c,)] if h == w == 1 else [(c, w)] if h == 1 else [])
        for item in items:
            front = shape[: max(len(shape) - len(item), 0)]
            if shape[len(front) :] == item and sum(n != 1 for n in front) <= 1 and 0 not in front:
                return len(item)
        wanted = " or ".join(str(item) for item in items)
        raise ValueError(f"array: wrong shape (got {shape}, expected {wanted}, channels first, after leading axes of 1 or one axis of steps)")

    def _step(self, array: Floats) -> list[Floats]:
        handle = self._open()
        c, h, w = self.input_shape
        map_ = array.reshape(c, h, w)
        if self._interleaved:
            self._input[:] = map_.transpose(1, 2, 0).reshape(-1)
        else:
            blocks = self._input.reshape(-1, h, w, _BLOCK)
            for block in range(len(blocks)):
                part = map_[block * _BLOCK : (block + 1) * _BLOCK]
                blocks[block, :, :, : len(part)] = part.transpose(1, 2, 0)
        check(function("mien_network_run")(handle))
        return [self._output(i) for i in range(function("mien_network_output_count")(handle))]

    def _output(self, index: int) -> Floats:
        shape = NetworkShape()
        place = function("mien_network_output")(self._handle, index, byref(shape))
        c, h, w = shape.channels, shape.height, shape.width
        blocks = -(-c // _BLOCK)
        values = _floats_at(place, blocks * h * w * _BLOCK).reshape(blocks, h, w, _BLOCK)
        map_ = values.transpose(0, 3, 1, 2).reshape(-1, h, w)[:c]
        return np.array(map_[:, 0, 0] if h == w == 1 else map_)

    def reset(self) -> None:
        """Resets the state of temporal layers to the start of a stream."""
        if self._handle:
            function("mien_network_reset")(self._open())


def _floats_at(place: Any, count: int) -> Floats:
    memory: Any = (c_float * count).from_address(place)
    array: Floats = np.frombuffer(memory, np.float32)
    return array


def run(model: Union[Model, Weights], array: npt.ArrayLike, *, network: Optional[str] = None) -> list[Floats]:
    """Runs a converted network once (see Network.run for the layout of arrays) and returns its outputs."""
    with Network(model, network) as opened_network:
        return opened_network.run(array)
