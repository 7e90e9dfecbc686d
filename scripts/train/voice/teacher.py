"""The video teacher's curves of the audio-visual clips: what the controls decoder learns from real faces."""
import functools

import numpy as np

from paths import data
from voice.audio_net import SPEECH_CONTROLS

FPS = 25
# Where the teacher responds to what this speaker says. Elsewhere it hardly leaves zero (the data's README) or, as for mouthPress,
# moves with something else than phonemes; its mouthPucker is faint (90th percentile 0.05). There visemes decide.
RESPONDING = ["jawOpen", "mouthRollUpper"]
REST = 10  # percentile of a clip's curve that counts as the mouth at rest: sound cannot tell how lips rest


def columns(names):
    """Of the speech controls in a table of blendshapes; -1 where the teacher has none."""
    names = [str(n) for n in names]
    return [names.index(c) if c in names else -1 for c in SPEECH_CONTROLS]


def speech_controls(table, names):
    """f32 [n,18]"""
    return np.stack([np.float32(table[:, k]) if k >= 0 else np.zeros(len(table), np.float32) for k in columns(names)], 1)


@functools.lru_cache(None)
def clips():
    """{clip: curves f32 [frames,18], from the mouth's rest}"""
    d = np.load(data() / "av/curves.npz", allow_pickle=True)
    table = speech_controls(d["blendshapes"], d["blendshape_names"])
    out = {}
    for name, a, b in zip(d["clip"], d["offset"][:-1], d["offset"][1:]):
        if d["found"][a:b].all():
            out[str(name)] = table[a:b] - np.percentile(table[a:b], REST, axis=0).astype(np.float32)
    return out


def at(curve, times, fps=FPS):
    """The curve [frames,n] at `times` in seconds, straight between frames."""
    frames = np.arange(len(curve)) / fps
    return np.stack([np.interp(times, frames, c) for c in curve.T], 1).astype(np.float32)


def mask():
    """f32 [18]: 1 where the teacher has a say."""
    return np.float32([c in RESPONDING for c in SPEECH_CONTROLS])
