#!/usr/bin/env python3
"""Prints how well mien or Silero VAD detects the speech of voice_sets.py, and the time that Silero VAD takes, as JSON.

usage: voice_scores.py mien|silero DIR
MIEN_LIBRARY names mien's library, which uses the weights of models/; attack and release are off. Of shifts by some
windows against the truth, the best counts.
"""
import ctypes
import json
import sys
import time
from importlib.metadata import distribution, version
from pathlib import Path

import numpy as np

from mien_training.evaluate import metrics

ROOT = Path(__file__).resolve().parents[2]

RATE, WINDOW = 16000, 256
WINDOW_NS = WINDOW * 10 ** 9 // RATE
SHIFTS = range(-6, 7)  # windows


class Silero:
    """Its ONNX file in ONNX Runtime: 32 ms at a time, and the last 4 ms before them."""
    CHUNK, CONTEXT, RATE = 512, 64, np.array(RATE, np.int64)

    def __init__(self):
        import onnxruntime as ort
        options = ort.SessionOptions()
        options.intra_op_num_threads = options.inter_op_num_threads = 1
        self.file = distribution("silero-vad").locate_file("silero_vad/data/silero_vad.onnx")
        self.session = ort.InferenceSession(str(self.file), options, providers=["CPUExecutionProvider"])
        self.times = []

    def scores(self, sound):
        """One for each window."""
        state, context, predicted = np.zeros((2, 1, 128), np.float32), np.zeros(self.CONTEXT, np.float32), []
        for chunk in np.resize(np.pad(sound, (0, -len(sound) % self.CHUNK)), (-(-len(sound) // self.CHUNK),
                                                                              self.CHUNK)):
            heard = np.concatenate([context, chunk])[None]
            begin = time.perf_counter_ns()
            probability, state = self.session.run(None, {"input": heard, "state": state, "sr": self.RATE})
            self.times.append(time.perf_counter_ns() - begin)
            context = chunk[-self.CONTEXT:]
            predicted += [float(probability[0, 0])] * (self.CHUNK // WINDOW)
        return np.array(predicted)[:len(sound) // WINDOW]

    def report(self):
        us = np.array(self.times) / 1e3
        return {"version": version("silero-vad"), "bytes": self.file.stat().st_size,
                "second_min_us": float(us.min() * RATE / self.CHUNK),
                "second_median_us": float(np.median(us) * RATE / self.CHUNK)}


class Mien:
    def __init__(self):
        import mien
        from mien import _library
        self.library, self.function = _library, _library.function
        self.weights = mien.Weights(*(ROOT / "models" / f"{name}.mien" for name in ("basenet", "proposal", "audionet")))
        self.config = _library.TrackerConfig()
        self.function("mien_tracker_config_default")(ctypes.byref(self.config))
        self.config.weights = self.weights._handle
        self.config.voice_attack_ms = self.config.voice_release_ms = 0

    def call(self, name, *arguments):
        status = self.function(f"mien_{name}")(*arguments)
        if status != 0:
            sys.exit(f"voice_scores.py: mien_{name}: status {status}")

    def scores(self, sound):
        tracker, predicted = ctypes.c_void_p(), []
        self.call("tracker_create", ctypes.byref(self.config), ctypes.byref(tracker), None)
        audio, result = self.library.Audio(), self.library.TrackerResult()
        self.function("mien_audio_default")(ctypes.byref(audio))
        self.function("mien_result_default")(ctypes.byref(result))
        audio.sample_rate, audio.frames = RATE, WINDOW
        for k in range(len(sound) // WINDOW):
            audio.samples[0] = sound[k * WINDOW:].ctypes.data
            self.call("tracker_push_audio", tracker, ctypes.byref(audio), k * WINDOW_NS)
            self.call("tracker_advance", tracker, (k + 1) * WINDOW_NS)
            self.call("tracker_get_result", tracker, ctypes.byref(result))
            predicted.append(result.voice_activity)
        self.function("mien_tracker_destroy")(tracker)
        return np.array(predicted)

    def report(self):
        return {"bytes": (ROOT / "models/audionet.mien").stat().st_size}


def best_shift(predicted, truth):
    """(area under ROC, shift): shift n compares the prediction for window k with the truth at k - n."""
    areas = {}
    for n in SHIFTS:
        pairs = [(s[max(n, 0):len(s) + min(n, 0)], t[max(-n, 0):len(t) - max(n, 0)]) for s, t in zip(predicted, truth)]
        areas[n] = float(metrics.area_under_roc(*(np.concatenate(side) for side in zip(*pairs))))
    best = max(areas, key=areas.get)
    return areas[best], best


def main():
    who, directory = {"mien": Mien, "silero": Silero}[sys.argv[1]](), Path(sys.argv[2])
    heard = {}
    for ratio in ("clean", "20", "5"):
        data = np.load(directory / f"voice_{ratio}.npz")
        sounds, truths = ([data[name] for name in sorted(data.files) if name.startswith(kind)]
                          for kind in ("sound", "truth"))
        area, shift = best_shift([who.scores(s) for s in sounds], truths)
        heard[ratio] = {"area": area, "shift_ms": shift * WINDOW * 1000 / RATE, "seconds": sum(map(len, sounds)) / RATE}
    print(json.dumps({**who.report(), "heard": heard}))


if __name__ == "__main__":
    main()
