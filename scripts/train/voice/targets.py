"""What the decoders are to answer to a scene: controls, how much each counts, and voice activity."""
import functools

import numpy as np

from voice import activity, corpus, phonemes, teacher, visemes
from voice.features import seconds_of_steps

TRUST = {"synthetic": 1.0, "av": 0.5}  # of visemes, by how sure the phonemes are; 0.3 for all other speech
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
    """By phonemes where their times are good; by energy elsewhere. GRID's noise is loud."""
    if part.group in TIMED:
        return activity.bridged(part.spoken.at(times - part.at) != phonemes.SILENCE)
    return activity.at(spoken_in(part.group, part.name), recorded)


def of_scene(scene, steps):
    """(controls [t,18], weights [t,18], speech [t]) of a scene."""
    times = seconds_of_steps(steps)
    speech = np.zeros(steps, bool)
    controls = visemes.curves(scene.spoken(), times)
    weights = np.ones_like(controls)
    for part in scene.parts:
        recorded, inside = part.recorded_at(times)
        speech |= inside & spoken_during(part, times, recorded)
        weights[inside] = TRUST.get(part.group, 0.3)
        curve = teacher.clips().get(part.name) if part.group == "av" else None
        if curve is not None:
            followed = teacher.mask() > 0
            rows = np.ix_(inside, followed)
            controls[rows] = np.clip(teacher.at(curve, recorded), 0, 1)[rows]
            weights[rows] = 1
    return controls, weights, speech
