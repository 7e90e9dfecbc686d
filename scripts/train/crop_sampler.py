"""Crops of stored windows as a network sees them, at once from 8-bit pixels. Run as a program it tests itself."""
import ctypes
import functools
from ctypes import c_float, c_size_t, c_void_p
from pathlib import Path

import numpy as np
import torch

from native_build import library


@functools.lru_cache
def native():
    lib = ctypes.CDLL(str(library(Path(__file__).resolve().parent / "crop_sampler.cpp")))
    lib.sample_crops_u8.argtypes = [c_void_p, c_size_t, c_size_t, c_void_p, c_float, c_size_t, c_size_t, c_void_p]
    return lib


def sample(windows, crop, framing):
    """windows uint8 [n,side,side,3], crop f32 [n,4] in their pixels -> f32 [n,3,height,width] in 0..1, as sequences.sample_crops."""
    windows, crop = np.ascontiguousarray(windows), crop.float().contiguous()
    out = torch.empty(len(windows), 3, framing.height, framing.width)
    native().sample_crops_u8(windows.ctypes.data, len(windows), windows.shape[1], crop.data_ptr(), framing.pixels_per_crop,
                             framing.height, framing.width, out.data_ptr())
    return out


def self_test():
    from framing import FRAMINGS
    from sequences import sample_crops
    rng, generator = np.random.default_rng(1), torch.Generator().manual_seed(1)
    for framing in FRAMINGS.values():
        windows = rng.integers(0, 256, (7, framing.window, framing.window, 3), np.uint8)
        windows[:, 1:] = windows[:, 1:] // 4 + windows[:, :-1] // 4 * 3
        crop = torch.tensor(framing.middle) + torch.randn(7, 4, generator=generator) * torch.tensor([20.0, 20, 9, 0.5])
        floats = torch.from_numpy(windows.transpose(0, 3, 1, 2).copy()).float() / 255
        assert float((sample(windows, crop, framing) - sample_crops(floats, crop, framing, taps=1)).abs().max()) < 0.01
    print("crop_sampler: ok")


if __name__ == "__main__":
    self_test()
