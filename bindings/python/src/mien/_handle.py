"""Objects of the C library. Each belongs to one Python object, in the process that created it."""

from __future__ import annotations

import os
from ctypes import c_void_p
from types import TracebackType
from typing import Any, NoReturn, Optional, TypeVar

from ._library import function
from .errors import MienError

Self = TypeVar("Self", bound="Handle")

_forks = 0


def _count_fork() -> None:
    global _forks
    _forks += 1


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_count_fork)


class Handle:
    """Cannot be copied or pickled, because two owners would destroy the C object twice. After a fork it can only be closed."""

    _kind = ""  # name in messages and C functions

    def __init__(self) -> None:
        self._handle = c_void_p()
        self._fork_count = _forks

    def _open(self) -> c_void_p:
        if not self._handle:
            raise MienError(f"the {self._kind} is closed")
        if self._fork_count != _forks:
            raise MienError(f"the {self._kind} was created before a fork; create one in each process")
        return self._handle

    def close(self) -> None:
        """Overwrites the memory with zeros and releases it. No other call is allowed afterwards."""
        handle, self._handle = self._handle, c_void_p()
        function(f"mien_{self._kind}_destroy")(handle)

    def __enter__(self: Self) -> Self:
        return self

    def __exit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException], trace: Optional[TracebackType]) -> None:
        self.close()

    def __del__(self) -> None:
        if getattr(self, "_handle", None):
            self.close()

    def __reduce_ex__(self, protocol: Any) -> NoReturn:
        raise TypeError(f"a {self._kind} cannot be copied or pickled; create another one")
