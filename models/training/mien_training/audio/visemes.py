"""Phonemes with times to curves of the 18 speech controls, with coarticulation.

Each phoneme pulls each control towards its value. The weight decreases with the time from its centre, and the curve is
the weighted mean (dominance functions: Cohen and Massaro 1993, "Modeling coarticulation in synthetic visual speech").
Lips that close or touch the teeth dominate the controls they need and leave the others to their neighbours.

The values follow the visemes of ARKit-like rigs; jawOpen is close to the video teacher's median at the centre of each
phoneme of the training clips (on the scale of teacher.py), except where lips or teeth must meet.
"""
import numpy as np

from mien_training.audio import phonemes
from mien_training.audio.audio_net import SPEECH_CONTROLS

INDEX = {name: i for i, name in enumerate(SPEECH_CONTROLS)}
SHORT = {"jaw": ["jawOpen"], "forward": ["jawForward"], "close": ["mouthClose"], "funnel": ["mouthFunnel"],
         "pucker": ["mouthPucker"],
         "roll_lower": ["mouthRollLower"], "roll_upper": ["mouthRollUpper"], "shrug_lower": ["mouthShrugLower"],
         "shrug_upper": ["mouthShrugUpper"], "press": ["mouthPressLeft", "mouthPressRight"],
         "stretch": ["mouthStretchLeft", "mouthStretchRight"], "lower": ["mouthLowerDownLeft", "mouthLowerDownRight"],
         "upper": ["mouthUpperUpLeft", "mouthUpperUpRight"], "tongue": ["tongueOut"]}

VISEMES = {
    "sil": {},
    "p": dict(jaw=0.02, close=0.45, press=0.3, roll_upper=0.15, roll_lower=0.2, shrug_lower=0.1),
    "f": dict(jaw=0.12, roll_lower=0.45, upper=0.15, shrug_lower=0.1),
    "th": dict(jaw=0.17, tongue=0.35, lower=0.1),
    "t": dict(jaw=0.27, lower=0.1, stretch=0.05),
    "s": dict(jaw=0.22, forward=0.05, stretch=0.15, lower=0.15),
    "sh": dict(jaw=0.22, forward=0.1, funnel=0.5, pucker=0.25, lower=0.1, upper=0.1),
    "l": dict(jaw=0.29, lower=0.1),
    "r": dict(jaw=0.18, funnel=0.3, pucker=0.2),
    "w": dict(jaw=0.12, funnel=0.35, pucker=0.75),
    "k": dict(jaw=0.3, lower=0.05),
    "y": dict(jaw=0.25, stretch=0.2, lower=0.1),
    "aa": dict(jaw=0.6, lower=0.1, upper=0.05),
    "ae": dict(jaw=0.5, stretch=0.12, lower=0.2, upper=0.1),
    "ah": dict(jaw=0.36, lower=0.08),
    "ao": dict(jaw=0.42, funnel=0.5, pucker=0.2),
    "eh": dict(jaw=0.44, stretch=0.12, lower=0.15, upper=0.05),
    "er": dict(jaw=0.26, funnel=0.3, pucker=0.15),
    "ih": dict(jaw=0.28, stretch=0.12, lower=0.1),
    "iy": dict(jaw=0.28, stretch=0.28, lower=0.15),
    "oh": dict(jaw=0.32, funnel=0.55, pucker=0.35),
    "uh": dict(jaw=0.25, funnel=0.35, pucker=0.4),
    "uw": dict(jaw=0.16, funnel=0.4, pucker=0.75),
}
SAME = {"b": "p", "m": "p", "v": "f", "dh": "th", "d": "t", "n": "t", "z": "s", "zh": "sh", "ch": "sh", "jh": "sh",
        "g": "k", "ng": "k", "hh": "k"}
DIPHTHONGS = {"aw": ("aa", "uh"), "ay": ("aa", "ih"), "ey": ("eh", "iy"), "ow": ("oh", "uw"), "oy": ("ao", "ih")}
# The dominance of a viseme for the controls that it requires; a vowel has 1, and INDIFFERENT leaves a control to the
# neighbours.
INDIFFERENT = 0.35
NEEDS = {"p": dict(jaw=6, close=6, press=3, roll_upper=3, roll_lower=3, funnel=0.6, pucker=0.15),
         "f": dict(jaw=3, roll_lower=4, upper=2),
         "s": dict(jaw=2, forward=1), "sh": dict(jaw=1.5, funnel=2, pucker=1, forward=1), "th": dict(tongue=3, jaw=1),
         "w": dict(pucker=3, funnel=2, jaw=1.5), "uw": dict(pucker=2, funnel=1.5), "sil": {}}
VOWELS = set("aa ae ah ao eh er ih iy oh uh uw".split())
AHEAD, AFTER = 0.045, 0.04  # seconds in which dominance falls to 1/e before and after a phoneme's edge
LIPS_SOONER = 1.6           # rounding begins that much earlier (Perkell, Matthies 1992)
PAUSE = 0.15                # silences shorter than that do not bring the mouth to rest


def _tables():
    """{viseme: (targets [18], dominances [18])}"""
    tables = {}
    for name, values in VISEMES.items():
        target = np.zeros(len(INDEX), np.float32)
        dominance = np.full(len(INDEX), 1.0 if name in VOWELS or name == "sil" else INDIFFERENT, np.float32)
        for table, rows in ((target, values), (dominance, NEEDS.get(name, {}))):
            for short, value in rows.items():
                table[[INDEX[c] for c in SHORT[short]]] = value
        tables[name] = target, dominance
    return tables


TABLES = _tables()
SOONER = np.ones(len(INDEX), np.float32)
SOONER[[INDEX["mouthPucker"], INDEX["mouthFunnel"]]] = LIPS_SOONER


def _segments(spoken):
    """(viseme, start, end) of each phoneme; diphthongs are two."""
    for label, start, end in zip(spoken.labels, spoken.starts, [*spoken.starts[1:], spoken.end]):
        name = phonemes.NAMES[label]
        parts = DIPHTHONGS.get(name, (SAME.get(name, name),))
        for k, part in enumerate(parts):
            yield part, start + (end - start) * k / len(parts), start + (end - start) * (k + 1) / len(parts)


def curves(spoken, times):
    """f32 [times, 18]"""
    rows = [(v, a, b) for v, a, b in _segments(spoken) if v != "sil" or b - a >= PAUSE]
    if not rows:
        return np.zeros((len(times), len(INDEX)), np.float32)
    targets, strengths = (np.stack([TABLES[v][k] for v, _, _ in rows]) for k in (0, 1))
    starts, ends = (np.float32([r[k] for r in rows]) for k in (1, 2))
    times = np.float32(times)[:, None]
    before, after = np.maximum(starts - times, 0)[..., None], np.maximum(times - ends, 0)[..., None]
    inside = np.maximum(np.minimum(times - starts, ends - times), 0)[..., None]
    # 1 at the edges, up to 1 + inside/AFTER in the middle, where neighbours have less influence.
    dominance = strengths * (np.exp(-before / (AHEAD * SOONER) - after / AFTER) * (1 + inside / AFTER)) + 1e-9
    return (dominance * targets).sum(1) / dominance.sum(1)
