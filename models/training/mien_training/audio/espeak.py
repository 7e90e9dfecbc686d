"""eSpeak NG through its C library: audio with the time of each phoneme, and phonemes of a text."""
import ctypes
import functools
import re
from math import gcd

import numpy as np
from scipy.signal import resample_poly

from mien_training.audio import phonemes, random_voices
from mien_training.audio.features import RATE

SYNCHRONOUS, PHONEME_EVENTS, IPA_EVENTS = 2, 1, 2
UTF8, PHONEMES_IN_BRACKETS = 1, 0x100
EVENT_END, EVENT_PHONEME = 0, 7
SPEED, PITCH, RANGE = 1, 3, 4
WORD_GAP = 7
IPA_WITH_SEPARATOR = 0x02 | ord("_") << 8


class _Id(ctypes.Union):
    _fields_ = [("number", ctypes.c_int), ("name", ctypes.c_char_p), ("string", ctypes.c_char * 8)]


class _Event(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("unique", ctypes.c_uint), ("text_position", ctypes.c_int), ("length",
                                                                                                     ctypes.c_int),
                ("audio_position", ctypes.c_int), ("sample", ctypes.c_int), ("user_data", ctypes.c_void_p), ("id", _Id)]


_Callback = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.POINTER(ctypes.c_short), ctypes.c_int, ctypes.POINTER(_Event))


class _Espeak:
    """One per process: the library has one state."""

    def __init__(self):
        self.library = ctypes.CDLL("libespeak-ng.so.1")
        self.library.espeak_TextToPhonemes.restype = ctypes.c_char_p
        self.rate = self.library.espeak_Initialize(SYNCHRONOUS, 0, str(random_voices.folder()).encode(),
                                                   PHONEME_EVENTS | IPA_EVENTS)
        self.callback = _Callback(self._take)
        self.library.espeak_SetSynthCallback(self.callback)
        self.sound, self.events = [], []

    def _take(self, samples, count, events):
        if count > 0:
            self.sound.append(np.ctypeslib.as_array(samples, (count,)).copy())
        for i in range(1 << 20):
            event = events[i]
            if event.type == EVENT_END:
                break
            if event.type == EVENT_PHONEME:
                name = ctypes.string_at(ctypes.addressof(events[i].id), 8).split(b"\0")[0].decode("utf8", "ignore")
                self.events.append((event.sample / self.rate, name))
        return 0

    def voice(self, name):
        if self.library.espeak_SetVoiceByName(name.encode()) != 0:
            raise ValueError(f"espeak-ng has no voice {name}")

    def say(self, text, speed, pitch, pitch_range, word_gap):
        for parameter, value in ((SPEED, speed), (PITCH, pitch), (RANGE, pitch_range), (WORD_GAP, word_gap)):
            self.library.espeak_SetParameter(parameter, value, 0)
        self.sound, self.events = [], []
        encoded = text.encode()
        self.library.espeak_Synth(encoded, len(encoded) + 1, 0, 0, 0, UTF8 | PHONEMES_IN_BRACKETS, None, None)
        self.library.espeak_Synchronize()
        return (np.concatenate(self.sound) if self.sound else np.zeros(0, np.int16)), self.events


@functools.lru_cache(None)
def engine():
    return _Espeak()


def timed(events, seconds):
    """Phoneme labels and their start times. The phonemes of one event share its time evenly."""
    labels, starts = [], []
    for (start, name), end in zip(events, [e[0] for e in events[1:]] + [seconds]):
        parts = phonemes.of_ipa(name)
        if not parts and name not in ("", "ʔ"):
            continue  # a mark that continues the phoneme before
        for k, label in enumerate(parts or (phonemes.SILENCE,)):
            labels.append(label)
            starts.append(start + (end - start) * k / max(len(parts), 1))
    return labels, starts


def speak(voice, text, speed=175, pitch=50, pitch_range=50, word_gap=0):
    """(int16 samples at 16 kHz, phonemes, their starts in seconds)"""
    espeak = engine()
    espeak.voice(voice)
    sound, events = espeak.say(text, speed, pitch, pitch_range, word_gap)
    labels, starts = timed(events, len(sound) / espeak.rate)
    common = gcd(RATE, espeak.rate)
    sound = resample_poly(np.float32(sound), RATE // common, espeak.rate // common)
    return np.int16(np.clip(np.rint(sound), -32768, 32767)), labels, starts


@functools.lru_cache(None)
def words_to_phonemes(text, voice="en-us"):
    """Numbers of the phonemes of each word of a text: a list of tuples."""
    espeak = engine()
    espeak.voice(voice)
    pointer = ctypes.c_char_p(text.lower().encode())
    spoken = espeak.library.espeak_TextToPhonemes(ctypes.byref(pointer), UTF8, IPA_WITH_SEPARATOR)
    words = re.split(r"\s+", (spoken or b"").decode().strip())
    return [tuple(p for part in word.split("_") for p in phonemes.of_ipa(part)) for word in words]
