"""Input features of AudioNet for whole recordings, as in audio/ (front_end.h and mfcc.h cite the sources)."""
import functools

import numpy as np
from scipy.fft import dct, rfft
from scipy.signal import lfilter

RATE, WINDOW, BANDS, WINDOWS = 16000, 256, 26, 5
FEATURES = WINDOWS * BANDS
STEP = WINDOW / RATE  # seconds
WARPED = 4800  # Hz
HIGH_PASS = 1 - 2 * np.pi * 20 / RATE


def seconds_of_steps(steps):
    """Time of each of the first `steps` steps: the centre of its five windows."""
    return (np.arange(steps) - 1.5) * STEP


def mel(hz):
    return 2595 * np.log10(1 + hz / 700)


@functools.lru_cache(None)
def tables(warp=1.0):
    """Hamming window; triangles [bins, bands], 1/WINDOW included; liftered cosines [bands, coefficients]."""
    hertz = 700 * (10 ** (np.linspace(mel(60), mel(7600), BANDS + 2) / 2595) - 1)
    # Warped up to where little of a voice is left; from there straight to the same end.
    edges = np.interp(hertz, [0, WARPED, hertz[-1]], [0, WARPED * warp, hertz[-1]])
    bins = np.fft.rfftfreq(WINDOW, 1 / RATE)
    bands = np.stack([np.interp(bins, edges[k:k + 3], [0, 1, 0], left=0, right=0) for k in range(BANDS)])
    cosines = dct(np.eye(BANDS), type=2, norm="ortho") * (1 + 11 * np.sin(np.pi * np.arange(BANDS) / 22))
    return np.float32(np.hamming(WINDOW)), np.float32(bands.T / WINDOW), np.float32(cosines)


def without_offset(sound):
    return lfilter(np.float32([1, -1]), np.float32([1, -HIGH_PASS]), sound).astype(np.float32)


def log_mel(sound, warp=1.0):
    """f32 [..., samples] -> f32 [..., windows, 26]: logarithms of the mel bands; an incomplete window is left out."""
    sound = np.float32(sound)[..., :sound.shape[-1] // WINDOW * WINDOW]
    before = np.concatenate([np.zeros_like(sound[..., :1]), sound[..., :-1]], -1)
    window, bands, _ = tables(warp)
    shaped = (sound - np.float32(0.97) * before).reshape(*sound.shape[:-1], -1, WINDOW) * window
    spectrum = rfft(shaped)
    power = spectrum.real ** 2 + spectrum.imag ** 2
    return np.log(np.maximum(power @ bands, np.float32(1e-8)))


def mfcc(sound, warp=1.0):
    """f32 [..., samples] -> f32 [..., windows, 26]"""
    return log_mel(sound, warp) @ tables(warp)[2]


def packed(coefficients):
    """[..., steps, 26] -> [..., steps, 130]: five windows, oldest first; before the first one there was silence."""
    silence = np.broadcast_to(mfcc(np.zeros(WINDOW, np.float32)), (*coefficients.shape[:-2], WINDOWS - 1, BANDS))
    padded = np.concatenate([silence, coefficients], -2)
    steps = coefficients.shape[-2]
    return np.concatenate([padded[..., k:k + steps, :] for k in range(WINDOWS)], -1)


def features(sound, warp=1.0):
    """f32 [..., samples] in -1..1 at 16 kHz -> f32 [..., steps, 130]

    `warp`, for training: length of the vocal tract relative to the speaker's (VTLP: Jaitly, Hinton 2013).
    """
    return packed(mfcc(without_offset(np.clip(sound, -1, 1)), warp))
