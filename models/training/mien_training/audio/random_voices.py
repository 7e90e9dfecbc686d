"""Random variants for eSpeak NG: formants, tone and pitch.

Files as in https://github.com/espeak-ng/espeak-ng/blob/master/docs/voices.md. eSpeak's own variants are a few dozen,
too few to cover the differences between people.
"""
import ctypes.util
import shutil
from pathlib import Path

import numpy as np

from mien_training.audio import corpus

NAME = "made"  # of the current variant
FORMANTS = 9
MISSING = 0.08  # probability that an upper formant is missing


def formant(rng, number, size):
    """A line of a variant: frequency, strength and width in percent of the language's."""
    spread = {1: 0.22, 2: 0.13}.get(number, 0.1)
    frequency = 100 * size * np.exp(rng.normal(0, spread))
    strength = 100 * np.exp(rng.normal(0, 0.25))
    width = 100 * np.exp(rng.normal(0, 0.25))
    if number in (3, 4, 5) and rng.random() < MISSING:
        frequency = strength = width = 0
    frequency, strength, width = np.clip([frequency, strength, width], 0, [170, 200, 200])
    return f"formant {number} {frequency:.0f} {strength:.0f} {width:.0f}"


def variant(rng):
    low = rng.uniform(55, 190)
    size = np.exp(rng.normal(0.02, 0.14))  # of the head; small heads have high formants
    lines = ["language variant", f"name {NAME}", f"pitch {low:.0f} {low * rng.uniform(1.2, 1.8):.0f}"]
    lines += [formant(rng, number, size) for number in range(FORMANTS)]
    if rng.random() < 0.5:
        lines.append(f"tone 600 {rng.integers(100, 256)} 1200 {rng.integers(50, 256)} 2000 {rng.integers(10, 200)}")
    if rng.random() < 0.6:
        lines.append(f"voicing {rng.integers(60, 250)}")
    if rng.random() < 0.5:
        lines.append(f"consonants {rng.integers(60, 170)} {rng.integers(60, 190)}")
    if rng.random() < 0.5:
        lines += [f"flutter {rng.integers(0, 8)}", f"roughness {rng.integers(0, 4)}"]
    if rng.random() < 0.25:
        lines.append("breath " + " ".join(str(rng.integers(0, 5)) for _ in range(8)))
    if rng.random() < 0.25:
        lines.append(f"klatt {rng.integers(1, 6)}")
    return "\n".join(lines) + "\n"


def installed_data():
    """The folder espeak-ng-data of the system."""
    library = ctypes.util.find_library("espeak-ng")
    places = [*Path("/usr/lib").glob("*/espeak-ng-data"), *Path("/usr/share").glob("espeak-ng-data")]
    if not library or not places:
        raise FileNotFoundError("espeak-ng is not installed")
    return places[0]


def folder():
    """A copy of eSpeak NG's data with the random variants."""
    out = corpus.folder() / "espeak"
    if not (out / "espeak-ng-data").exists():
        shutil.rmtree(out, ignore_errors=True)
        shutil.copytree(installed_data(), out / "partial")
        (out / "partial/voices/!v" / NAME).write_text(variant(np.random.default_rng(1)))
        (out / "partial").rename(out / "espeak-ng-data")
    return out


def draw(rng):
    """Replaces the variant by a new random one; returns its name."""
    (folder() / "espeak-ng-data/voices/!v" / NAME).write_text(variant(rng))
    return NAME
