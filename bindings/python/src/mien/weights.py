"""Weight files, mapped into memory without a copy and shared between processes."""

from __future__ import annotations

import errno
import mmap
from pathlib import Path
from typing import Union

import numpy as np
import numpy.typing as npt

from ._library import ALIGNMENT
from .errors import OutOfMemoryError, WeightsTruncatedError

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


def aligned(data: bytes) -> Bytes:
    """A copy with the alignment that the library needs."""
    if not data:
        raise WeightsTruncatedError
    memory = np.empty(len(data) + ALIGNMENT, np.uint8)
    first = -memory.ctypes.data % ALIGNMENT
    copy = memory[first : first + len(data)]
    copy[:] = np.frombuffer(data, np.uint8)
    return copy


def opened(model: Model) -> Bytes:
    return aligned(model) if isinstance(model, bytes) else mapped(Path(model))
