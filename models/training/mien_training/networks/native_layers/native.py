"""Loads the C++ parts of the layers, and passes maps to them."""
import ctypes
import functools
from pathlib import Path

import torch

from mien_training.native_build import library

HERE = Path(__file__).resolve().parent
MAP_TYPES = (torch.float32, torch.bfloat16)
MAX_CHANNELS = 1024


@functools.lru_cache
def code(name):
    return ctypes.CDLL(str(library(HERE / f"{name}.cpp", sorted(HERE.glob("*.h")))))


def address(tensor):
    return None if tensor is None else ctypes.c_void_p(tensor.data_ptr())


def by_pixel(x):
    """x [n,c,h,w] with its channels innermost in memory."""
    return x.contiguous(memory_format=torch.channels_last)


def in_training(layer, x):
    """Whether the native code applies: in training on a CPU."""
    return layer.training and x.device.type == "cpu" and x.dtype in MAP_TYPES
