#!/usr/bin/env python3
"""Writes held-out speech in held-out noise, as in docs/results/audio.md, for voice_scores.py.

usage: voice_sets.py OUT_DIR
Writes voice_RATIO.npz: sound_I, f32 at 16 kHz, and truth_I, bool of each window of 16 ms. Decodes the recordings first
if necessary.
"""
import sys
from pathlib import Path

import numpy as np

from mien_training.audio import corpus
from mien_training.evaluate import audio_activity

RATIOS = {"clean": None, "20": 20, "5": 5}


def main():
    for group in ("librispeech", "commands", "noise"):
        if not (corpus.folder() / f"{group}.json").exists():
            corpus.decode_group(group)
    for name, ratio in RATIOS.items():
        arrays = {}
        for i, (sound, truth) in enumerate(audio_activity.heard(ratio)):
            arrays[f"sound_{i:03}"], arrays[f"truth_{i:03}"] = np.float32(sound), truth
        np.savez(Path(sys.argv[1]) / f"voice_{name}.npz", **arrays)


if __name__ == "__main__":
    main()
