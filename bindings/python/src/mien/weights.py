"""Weight files, mapped into memory without a copy and shared between processes."""

from __future__ import annotations

import errno
import mmap
from ctypes import byref
from pathlib import Path
from typing import Union

import numpy as np
import numpy.typing as npt

from ._handle import Handle
from ._library import WeightsConfig, function
from .errors import OutOfMemoryError, WeightsTruncatedError, check_detail, new_detail

Bytes = npt.NDArray[np.uint8]
Model = Union[str, Path, bytes]


def mapped(path: Path) -> Bytes:
    with open(path, "rb") as file:
        if path.stat().st_size == 0:  # cannot be mapped
            raise WeightsTruncatedError
        try:
            pages = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        except OSError as error:
            if error.errno != errno.ENOMEM:
                raise
            raise OutOfMemoryError(f"{path}: cannot be mapped: out of memory") from error
        return np.frombuffer(pages, np.uint8)


class Weights(Handle):
    """Opened weight files, which any number of trackers and networks in any threads may share.

    Each model is a path or bytes: a weight file, a packed one, or a bundle of several. A folder stands for its basenet.mien,
    proposal.mien, hifinet.mien and audionet.mien, where the last two are optional.
    """

    _kind = "weights"

    def __init__(self, *models: Model) -> None:
        super().__init__()
        sources = [source for model in models for source in _sources(model)]
        if len(sources) > 8:
            raise ValueError(f"models: too many files (got {len(sources)}, expected 8 at most; join them to a bundle)")
        # The library uses aligned files in place, and copies and unpacks others.
        self._files = [source if isinstance(source, bytes) else mapped(source) for source in sources]
        self.names = [f"weights[{i}]" if isinstance(source, bytes) else str(source) for i, source in enumerate(sources)]
        config = WeightsConfig()
        function("mien_weights_config_default")(byref(config))
        for i, data in enumerate(self._files):
            array = np.frombuffer(data, np.uint8) if isinstance(data, bytes) else data
            if not array.size:
                raise WeightsTruncatedError
            config.files[i], config.file_bytes[i] = array.ctypes.data, array.size
        detail = new_detail()
        check_detail(function("mien_weights_create")(byref(config), byref(self._handle), byref(detail)), detail, self.names)


def _sources(model: Model) -> list[Union[Path, bytes]]:
    if isinstance(model, bytes):
        return [model]
    path = Path(model)
    if not path.is_dir():
        return [path]
    required = [path / "basenet.mien", path / "proposal.mien"]
    return [*required, *(file for name in ("hifinet", "audionet") if (file := path / f"{name}.mien").exists())]


def opened(model: Union[Model, Weights]) -> Weights:
    return model if isinstance(model, Weights) else Weights(model)
