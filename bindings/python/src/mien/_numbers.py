"""Range checks of numbers for C: ctypes truncates those that do not fit."""

from __future__ import annotations

import math
import operator
from ctypes import c_float, c_int32, c_int64, c_size_t, c_uint32, c_uint64, sizeof
from typing import Any, Callable, Optional, Sequence

_FLOAT_MAX = float.fromhex("0x1.fffffep+127")
_WHOLE = {kind: (sizeof(kind), kind(-1).value < 0) for kind in (c_int32, c_uint32, c_int64, c_uint64, c_size_t)}
_LIMITS = {kind: (-(1 << 8 * size - 1), (1 << 8 * size - 1) - 1) if signed else (0, (1 << 8 * size) - 1) for kind, (size, signed) in _WHOLE.items()}

Check = Callable[[Any, str], Any]


def _out_of_range(name: str, value: object, least: object, most: object) -> Exception:
    from .errors import OutOfRangeError  # which needs the library, and that needs this

    return OutOfRangeError(f"{name}: number out of range (got {value}, expected {least} to {most})")


def check_of(kind: Any) -> Optional[Check]:
    """The function that converts a Python number to a C type, or raises; None: not a type of numbers."""
    if kind is c_float:
        return _real
    if kind not in _LIMITS:
        return None
    least, most = _LIMITS[kind]

    def whole(value: Any, name: str) -> int:
        try:
            number = operator.index(value)
        except TypeError:
            raise TypeError(f"{name}: not a whole number (got {value!r}, expected {least} to {most})") from None
        if least <= number <= most:
            return number
        raise _out_of_range(name, number, least, most)

    return whole


def _real(value: Any, name: str) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{name}: not a number (got {value!r})") from None
    if abs(number) <= _FLOAT_MAX or not math.isfinite(number):
        return number
    raise _out_of_range(name, number, -_FLOAT_MAX, _FLOAT_MAX)


def unit_fraction(value: float, name: str) -> float:
    if 0 <= _real(value, name) <= 1:
        return value
    raise _out_of_range(name, value, 0, 1)


def with_checked_arguments(function: Callable[..., Any], name: str, kinds: Sequence[Any]) -> Callable[..., Any]:
    checks = [(i, check, f"argument {i + 1} of {name}") for i, kind in enumerate(kinds) if (check := check_of(kind))]
    if not checks:
        return function

    def call(*arguments: Any) -> Any:
        given = list(arguments)
        for i, check, what in checks:
            given[i] = check(given[i], what)
        return function(*given)

    return call


def nanoseconds(seconds: float, name: str = "time_s") -> int:
    if not math.isfinite(seconds):
        raise _out_of_range(name, seconds, *_seconds())
    number = round(seconds * 1e9)
    least, most = _LIMITS[c_int64]
    if least <= number <= most:
        return number
    raise _out_of_range(name, seconds, *_seconds())


def _seconds() -> tuple[float, float]:
    least, most = _LIMITS[c_int64]
    return least / 1e9, most / 1e9
