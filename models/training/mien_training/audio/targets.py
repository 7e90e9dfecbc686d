"""Targets of the decoders for an example: controls, their weights, and voice activity."""
import functools

import numpy as np

from mien_training.audio import activity, corpus, phonemes, teacher, visemes
from mien_training.audio.audio_net import SPEECH_CONTROLS
from mien_training.audio.features import seconds_of_steps

# of visemes, by how sure the phonemes are; else OTHERS
TRUST = {"synthetic": 1.0, "av": 0.5, "people": 0.5, "animated": 0.0}
OTHERS = 0.3
LIPS = [SPEECH_CONTROLS.index(name) for name in ("jawOpen", "mouthClose")]
MEET = 4.0  # lips that do not close for p, b and m are the most visible error
TIMED = ("synthetic", "av")


@functools.lru_cache(None)
def spoken_in(group, name):
    """Voice activity of the windows of a recording."""
    g = group_of(group)
    return activity.of_windows(np.float32(g.samples(g.by_name[name])) / 32768)


@functools.lru_cache(None)
def group_of(name):
    return corpus.Group(name)


def spoken_during(part, times, recorded):
    """From phonemes with reliable times, else from energy. GRID has loud noise."""
    if part.group in TIMED:
        return activity.bridged(part.spoken.at(times - part.at) != phonemes.SILENCE)
    return activity.at(spoken_in(part.group, part.name), recorded)


def of_scene(scene, steps):
    """(controls [t,18], weights [t,18], speech [t]) of a scene."""
    times = seconds_of_steps(steps)
    speech = np.zeros(steps, bool)
    spoken = scene.spoken()
    controls = visemes.curves(spoken, times)
    weights = np.ones_like(controls)
    closed = np.isin(spoken.at(times), list(phonemes.BILABIALS))
    for part in scene.parts:
        recorded, inside = part.recorded_at(times)
        speech |= inside & spoken_during(part, times, recorded)
        weights[inside] = TRUST.get(part.group, OTHERS)
        curve = teacher.curves(part.group).get(part.name)
        if curve is not None:
            rows = np.ix_(inside, curve.known)
            controls[rows] = curve.at(recorded)[rows]
            weights[rows] = 1
            closed = closed & ~(inside & curve.known[LIPS[0]])
    weights[np.ix_(closed, LIPS)] *= MEET
    return controls, weights, speech
