"""Checks of the inputs of operators."""
import numpy as np

from . import tensors
from .errors import require


def is_constant(x):
    return isinstance(x, np.ndarray)


def as_tensor(x):
    return tensors.of_constant(x) if is_constant(x) else x


def constant(x, what):
    require(x is None or is_constant(x), f"its {what} is not a constant")
    return x


def scalar(x, default):
    return default if x is None else float(np.asarray(x).reshape(-1)[0])
