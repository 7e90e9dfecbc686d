"""Samples crops for the networks from stored windows of 8-bit pixels."""
import ctypes
import functools
from ctypes import c_float, c_size_t, c_void_p
from pathlib import Path

import numpy as np
import torch

from mien_training.native_build import library


@functools.lru_cache
def native():
    lib = ctypes.CDLL(str(library(Path(__file__).resolve().parent / "crop_sampler.cpp")))
    lib.sample_crops_u8.argtypes = [c_void_p, c_size_t, c_size_t, c_void_p, c_float, c_size_t, c_size_t, c_void_p]
    return lib


def sample(windows, crop, framing):
    """windows uint8 [n,side,side,3], crop f32 [n,4] in their pixels -> f32 [n,3,height,width] in 0..1, as
    sequences.sample_crops."""
    windows, crop = np.ascontiguousarray(windows), crop.float().contiguous()
    out = torch.empty(len(windows), 3, framing.height, framing.width)
    native().sample_crops_u8(windows.ctypes.data, len(windows), windows.shape[1], crop.data_ptr(),
                             framing.pixels_per_crop, framing.height, framing.width, out.data_ptr())
    return out
