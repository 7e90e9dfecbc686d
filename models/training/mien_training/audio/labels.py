"""Phonemes with times of each group of recordings: $MIEN_CACHE/voice/GROUP.phonemes.json."""
import json
from dataclasses import asdict, dataclass

import numpy as np

from mien_training.audio import corpus, phonemes
from mien_training.audio.features import seconds_of_steps


@dataclass
class Spoken:
    labels: list   # phonemes, as in phonemes.py
    starts: list   # of the phonemes, in seconds; each lasts until the next
    end: float     # of the last

    def between(self, start, end, speed=1.0):
        """The part from `start` to `end`, its times from `start` on, played `speed` times as fast."""
        stops = [*self.starts[1:], self.end]
        kept = [(label, max(a, start)) for label, a, b in zip(self.labels, self.starts, stops) if b > start and a < end]
        return Spoken([k[0] for k in kept], [(k[1] - start) / speed for k in kept], (min(end, self.end) - start)
                      / speed)

    def at(self, times):
        """The phoneme at each of `times`; silence outside."""
        row = np.searchsorted(self.starts, times, "right") - 1
        inside = (row >= 0) & (times < self.end)
        return np.where(inside, np.asarray([*self.labels, phonemes.SILENCE])[row], phonemes.SILENCE)

    def of_steps(self, steps):
        return self.at(seconds_of_steps(steps))

    def sequence(self):
        """Targets of CTC, without silence. Repeated phonemes are kept."""
        return [p for p in self.labels if p != phonemes.SILENCE]


def path(group):
    return corpus.folder() / f"{group}.phonemes.json"


def write(group, spoken):
    rows = {name: {**asdict(s), "labels": [int(p) for p in s.labels], "starts": [round(float(t), 4) for t in s.starts]}
            for name, s in spoken.items()}
    path(group).write_text(json.dumps(rows))


def read(group):
    if not path(group).exists():
        return {}
    return {name: Spoken(**row) for name, row in json.loads(path(group).read_text()).items()}
