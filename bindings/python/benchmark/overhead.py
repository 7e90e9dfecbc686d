#!/usr/bin/env python3
"""Measures the additional time of a frame in Python: Tracker.track compared with push_video and get_result in a loop in C, with the same
library, tracker and frames (640x480 BGR of the demo clip), in interleaved rounds. Uses the fastest round of each frame.

usage: overhead.py CLIP [--rounds N] [--lod N]      Needs mien, cc and ffmpeg.
"""
import argparse
import ctypes
import platform
import subprocess
import tempfile
import time
from pathlib import Path

import mien
import numpy as np
from mien import _library
from mien.tracker import Tracker

LOOP = """
#include <stdint.h>
#include <time.h>
typedef int (*push_video)(void*, const void*, int64_t);
typedef int (*get_result)(void*, void*);
static int64_t now(void) { struct timespec t; clock_gettime(CLOCK_MONOTONIC, &t); return t.tv_sec * 1000000000LL + t.tv_nsec; }
int loop(push_video push, get_result get, void* tracker, void* image, void** plane, char** frames, int n, void* result, int64_t* ns) {
  for (int i = 0; i < n; ++i) {
    const int64_t begin = now();
    *plane = frames[i];
    if (push(tracker, image, i * 33333333LL) != 0 || get(tracker, result) != 0) return 1;
    ns[i] = now() - begin;
  }
  return 0;
}
"""


def c_loop(folder):
    source = Path(folder) / "loop.c"
    source.write_text(LOOP)
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", str(source), "-o", str(source.with_suffix(".so"))], check=True)
    return ctypes.CDLL(str(source.with_suffix(".so"))).loop


def frames_of(clip, count):
    command = ["ffmpeg", "-v", "error", "-i", clip, "-vf", "scale=640:480", "-frames:v", str(count), "-f", "rawvideo", "-pix_fmt", "bgr24", "-"]
    data = subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout
    return np.frombuffer(data, np.uint8).reshape(-1, 480, 640, 3)


def in_c(loop, tracker, frames):
    tracker.reset()
    image = tracker._image
    image.format, image.width, image.height, image.row_stride_bytes = 2, 640, 480, (640 * 3, 0, 0)
    places = (ctypes.c_void_p * len(frames))(*[frame.ctypes.data for frame in frames])
    result = _library.TrackerResult(ctypes.sizeof(_library.TrackerResult))
    ns = np.zeros(len(frames), np.int64)
    address = {name: ctypes.cast(getattr(_library.LIBRARY, name), ctypes.c_void_p) for name in ("mien_tracker_push_video", "mien_tracker_get_result")}
    plane = ctypes.c_void_p(ctypes.addressof(image) + _library.Image.planes.offset)
    failed = loop(address["mien_tracker_push_video"], address["mien_tracker_get_result"], tracker._handle, ctypes.byref(image), plane,
                  places, len(frames), ctypes.byref(result), ns.ctypes.data_as(ctypes.c_void_p))
    assert not failed
    return ns


def in_python(tracker, frames, read):
    tracker.reset()
    ns = np.zeros(len(frames), np.int64)
    for i, frame in enumerate(frames):
        begin = time.perf_counter_ns()
        result = tracker.track(frame, i / 30)
        if read:
            _ = result.controls.array, result.controls["jawOpen"], result.landmarks, result.pose
        ns[i] = time.perf_counter_ns() - begin
    return ns


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("clip")
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--lod", type=int, default=1)
    options = parser.parse_args()
    frames = frames_of(options.clip, 60)
    with tempfile.TemporaryDirectory() as folder, Tracker(options.lod, sound=False) as tracker:
        loop = c_loop(folder)
        ways = {"C": lambda: in_c(loop, tracker, frames), "Python, track": lambda: in_python(tracker, frames, False),
                "Python, track and read": lambda: in_python(tracker, frames, True)}
        least = {name: np.min([way() for _ in range(2)], 0) for name, way in ways.items()}
        for _ in range(options.rounds):
            for name, way in ways.items():
                least[name] = np.minimum(least[name], way())
    print(f"Python {platform.python_version()}, NumPy {np.__version__}, mien {mien.__version__}, level {options.lod}, "
          f"{len(frames)} frames, {options.rounds} rounds")
    for name, ns in least.items():
        extra = ns - least["C"]
        print(f"{name:24} {ns.mean() / 1e3:8.1f} us a frame, {extra.mean() / 1e3:6.1f} us more than C (median {np.median(extra) / 1e3:.1f}, "
              f"largest {extra.max() / 1e3:.1f})")


if __name__ == "__main__":
    main()
