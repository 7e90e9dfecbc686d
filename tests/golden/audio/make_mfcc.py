#!/usr/bin/env python3
"""Golden MFCCs from the definition in audio/mfcc.h, in double, with SciPy's FFT and DCT, independent of the library.

usage: make_mfcc.py      writes mfcc_input.f32 [signals, samples] and mfcc_output.f32 [signals, windows, 26] beside it
"""
from pathlib import Path

import numpy as np
from scipy.fft import dct
from scipy.signal import lfilter

RATE, WINDOW, WINDOWS, BANDS = 16000, 256, 15, 26


def signals():
    """White noise, a vowel, silence, a square wave at full scale, and the noise 60 dB down; f32 [5, samples]."""
    n = WINDOW * WINDOWS
    rng, t = np.random.default_rng(1), np.arange(n) / RATE
    noise = np.clip(0.2 * rng.standard_normal(n), -1, 1)
    vowel = (np.arange(n) % 133 == 0).astype(float)  # pulses at 120 Hz through three formants
    for hz, width in ((730, 90), (1090, 110), (2440, 170)):
        radius = np.exp(-np.pi * width / RATE)
        vowel = lfilter([1 - radius], [1, -2 * radius * np.cos(2 * np.pi * hz / RATE), radius ** 2], vowel)
    square = np.where(np.sin(2 * np.pi * 440 * t) >= 0, 1.0, -1.0)
    return np.float32([noise, 0.8 * vowel / np.abs(vowel).max(), 0 * t, square, 1e-3 * noise])


def mel(hz):
    return 2595 * np.log10(1 + hz / 700)


def bands():
    """Weights [BANDS, bins]."""
    edges = 700 * (10 ** (np.linspace(mel(60), mel(7600), BANDS + 2) / 2595) - 1)
    bins = np.fft.rfftfreq(WINDOW, 1 / RATE)
    return np.stack([np.interp(bins, edges[k:k + 3], [0, 1, 0], left=0, right=0) for k in range(BANDS)])


def mfcc(signal):
    """[windows, 26]"""
    x = signal.astype(np.float64)
    x = x - 0.97 * np.concatenate([[0], x[:-1]])
    power = np.abs(np.fft.rfft(x.reshape(-1, WINDOW) * np.hamming(WINDOW))) ** 2 / WINDOW
    logs = np.log(np.maximum(power @ bands().T, 1e-8))
    return dct(logs, type=2, norm="ortho") * (1 + 11 * np.sin(np.pi * np.arange(BANDS) / 22))


def main():
    here, found = Path(__file__).parent, signals()
    found.tofile(here / "mfcc_input.f32")
    np.float32([mfcc(s) for s in found]).tofile(here / "mfcc_output.f32")


if __name__ == "__main__":
    main()
