"""Curves of people who speak: targets of the controls decoder, in addition to visemes.

`av` and `people` have blendshapes of the video teacher, `animated` those of animators. People open their jaws
differently, and the teacher has another scale for each of them, so each speaker's jaw is scaled to the same opening:
the decoder learns the shape of the curve. The mix with video, or the strength that the user sets, decides the
amplitude.
"""
import functools
from dataclasses import dataclass

import numpy as np

from mien_training.audio import corpus
from mien_training.audio.audio_net import JAW, SPEECH_CONTROLS
from mien_training.paths import data

FPS = 25
FOLDERS = {"av": "av", "people": "av/people", "animated": "av/animated"}
WIDE, WIDE_SHARE = 0.6, 98  # jawOpen to which this percentile of each speaker is scaled
REST = 10  # percentile of a clip's curve that counts as the mouth at rest, which audio cannot tell
# Controls whose curves by the teacher follow phonemes. Others hardly leave zero (the data's README) or follow something
# else, such as mouthPress; for some speakers mouthPucker depends on the lips at rest. Visemes are the labels of these.
RESPONDING = {"av": ["jawOpen", "mouthRollUpper"], "people": ["jawOpen"]}
# Controls from the animators' rig, by name; `oh` and `oo` are shapes of the whole mouth.
BOTH = lambda name, weight=1.0: {f"{name}_l": weight / 2, f"{name}_r": weight / 2}
ANIMATED = {
    "jawOpen": {"mouth_stretch_c": 1, "tooth_d_d": 1},
    "mouthFunnel": {"mouth_funnel_dl": 0.25, "mouth_funnel_dr": 0.25, "mouth_funnel_ul": 0.25, "mouth_funnel_ur": 0.25,
                    "mouth_oh_c": 0.4},
    "mouthPucker": {**BOTH("mouth_pucker"), "mouth_oo_c": 0.7},
    "mouthRollLower": {"mouth_suck_dl": 0.5, "mouth_suck_dr": 0.5},
    "mouthRollUpper": {"mouth_suck_ul": 0.5, "mouth_suck_ur": 0.5},
    "mouthPressLeft": {"mouth_press_l": 1}, "mouthPressRight": {"mouth_press_r": 1},
    "mouthLowerDownLeft": {"mouth_lowerLipDepress_l": 1}, "mouthLowerDownRight": {"mouth_lowerLipDepress_r": 1},
    "mouthUpperUpLeft": {"mouth_upperLipRaise_l": 1}, "mouthUpperUpRight": {"mouth_upperLipRaise_r": 1},
}


@dataclass
class Curve:
    values: np.ndarray    # f32 [frames,18]
    known: np.ndarray     # bool [18]: controls with values
    fps: int

    def at(self, times):
        """f32 [times,18] at `times` in seconds, linear between frames."""
        return at(self.values, times, self.fps)


def columns(names):
    """Columns of the speech controls in a table of blendshapes; -1 for those that the teacher lacks."""
    names = [str(n) for n in names]
    return [names.index(c) if c in names else -1 for c in SPEECH_CONTROLS]


def speech_controls(table, names):
    """f32 [n,18]"""
    return np.stack([np.float32(table[:, k]) if k >= 0 else np.zeros(len(table), np.float32) for k in columns(names)],
                    1)


def animated_controls(table, names):
    """f32 [n,18]"""
    names, out = [str(n) for n in names], np.zeros((len(table), len(SPEECH_CONTROLS)), np.float32)
    for control, parts in ANIMATED.items():
        out[:, SPEECH_CONTROLS.index(control)] = sum(weight * np.float32(table[:, names.index(n)])
                                                     for n, weight in parts.items())
    return np.clip(out, 0, 1)


@functools.lru_cache(None)
def clips(group="av"):
    """{clip: curves f32 [frames,18], from the mouth's rest}, of clips in which the face was always found."""
    d = np.load(data() / FOLDERS[group] / "curves.npz", allow_pickle=True)
    animated = group == "animated"
    table = animated_controls(d["controls"], d["control_names"]) if animated else speech_controls(d["blendshapes"],
                                                                                                  d["blendshape_names"])
    out = {}
    for name, a, b in zip(d["clip"], d["offset"][:-1], d["offset"][1:]):
        if animated or d["found"][a:b].all():
            out[str(name)] = table[a:b] - np.percentile(table[a:b], REST, axis=0).astype(np.float32)
    return out


@functools.lru_cache(None)
def curves(group):
    """{clip: Curve} of a group for training: the jaw on one scale, within 0..1. Empty for groups without video."""
    if group not in FOLDERS:
        return {}
    speaker = {s.name: s.speaker for s in corpus.Group(group).sounds}
    jaws = {}
    for name, table in clips(group).items():
        jaws.setdefault(speaker[name], []).append(table[:, JAW])
    widest = {who: max(np.percentile(np.concatenate(parts), WIDE_SHARE), 0.05) for who, parts in jaws.items()}
    known, fps = mask(ANIMATED if group == "animated" else RESPONDING[group]), 30 if group == "animated" else FPS
    out = {}
    for name, table in clips(group).items():
        values = table.copy()
        values[:, JAW] *= WIDE / widest[speaker[name]]
        out[name] = Curve(np.clip(values, 0, 1), known, fps)
    return out


def at(curve, times, fps=FPS):
    """The curve [frames,n] at `times` in seconds, linear between frames."""
    frames = np.arange(len(curve)) / fps
    return np.stack([np.interp(times, frames, c) for c in curve.T], 1).astype(np.float32)


def mask(names):
    """bool [18]"""
    return np.array([c in names for c in SPEECH_CONTROLS])
