"""Opus (RFC 6716) through its C library: encodes and decodes speech."""
import ctypes
import functools

import numpy as np

from mien_training.audio.features import RATE

VOIP = 2048
SET_BITRATE, SET_COMPLEXITY, GET_LOOKAHEAD = 4002, 4010, 4027
FRAME = RATE // 50
MAX_BYTES = 1500


@functools.lru_cache(None)
def library():
    opus = ctypes.CDLL("libopus.so.0")
    for function in (opus.opus_encoder_create, opus.opus_decoder_create):
        function.restype = ctypes.c_void_p
    return opus


@functools.lru_cache(None)
def coder():
    """(encoder, decoder), one of each per process."""
    opus, error = library(), ctypes.c_int()
    encoder = ctypes.c_void_p(opus.opus_encoder_create(RATE, 1, VOIP, ctypes.byref(error)))
    decoder = ctypes.c_void_p(opus.opus_decoder_create(RATE, 1, ctypes.byref(error)))
    opus.opus_encoder_ctl(encoder, SET_COMPLEXITY, ctypes.c_int(2))
    return encoder, decoder


def pointer(array, kind):
    return array.ctypes.data_as(ctypes.POINTER(kind))


def coded(sound, bits_per_second):
    """f32 [samples] at 16 kHz through encoder and decoder, without their delay."""
    opus, (encoder, decoder), delay = library(), coder(), ctypes.c_int()
    opus.opus_encoder_ctl(encoder, SET_BITRATE, ctypes.c_int(bits_per_second))
    opus.opus_encoder_ctl(encoder, GET_LOOKAHEAD, ctypes.byref(delay))
    frames = -(-(len(sound) + delay.value) // FRAME)
    given = np.zeros(frames * FRAME, np.float32)
    heard = np.zeros(frames * FRAME, np.float32)
    packet = np.zeros(MAX_BYTES, np.uint8)
    given[:len(sound)] = sound
    for at in range(0, len(given), FRAME):
        size = opus.opus_encode_float(encoder, pointer(given[at:], ctypes.c_float), FRAME,
                                      pointer(packet, ctypes.c_ubyte), MAX_BYTES)
        if size < 0 or opus.opus_decode_float(decoder, pointer(packet, ctypes.c_ubyte), size,
                                              pointer(heard[at:], ctypes.c_float), FRAME, 0) < 0:
            raise RuntimeError("Opus refused a frame")
    return heard[delay.value:delay.value + len(sound)]
