"""Training examples: a few seconds of degraded speech, or of noise only, with labels for each step."""
from dataclasses import dataclass

import numpy as np
import torch

from mien_training.audio import corpus, effects, labels, phonemes, targets
from mien_training.audio.features import FEATURES, RATE, features

SHARES = {"synthetic": 0.38, "librispeech_text": 0.23, "librispeech": 0.22, "commands": 0.09, "av": 0.08}
NOISE_ALONE = 0.12
SHORTEST_PART = 0.8  # seconds
WARPS = np.round(np.linspace(0.85, 1.17, 9), 3).tolist()  # of the frequency axis, as of other vocal tracts


@dataclass
class Part:
    """Speech in a scene."""
    sound: np.ndarray      # f32 [samples], clean
    spoken: labels.Spoken
    group: str
    name: str
    origin: float          # where in its recording it begins, seconds
    speed: float           # factor on its speed
    at: float = 0.0        # where in the scene it begins

    def recorded_at(self, times):
        """Times of the scene as times of the recording, and which of them are within the part."""
        since = times - self.at
        return self.origin + since * self.speed, (since >= 0) & (since < len(self.sound) / RATE)


@dataclass
class Scene:
    sound: np.ndarray      # f32 [samples]
    parts: list

    def spoken(self):
        ids, starts = [phonemes.SILENCE], [0.0]
        for part in self.parts:
            ids += [*part.spoken.labels, phonemes.SILENCE]
            starts += [*(t + part.at for t in part.spoken.starts), part.spoken.end + part.at]
        return labels.Spoken(ids, starts, len(self.sound) / RATE)


def some_warp(rng):
    return WARPS[rng.integers(len(WARPS))]


class Speech:
    """Utterances of a split, with phonemes and times; groups without labels are left out."""

    def __init__(self, split, shares=SHARES):
        self.groups, self.spoken, self.sounds, self.shares = {}, {}, {}, {}
        for name, share in shares.items():
            spoken = labels.read(name)
            group = corpus.Group(name)
            sounds = [s for s in group.of(split) if s.name in spoken]
            if sounds:
                self.groups[name], self.spoken[name], self.sounds[name], self.shares[
                    name] = group, spoken, sounds, share

    def pick(self, rng):
        names = list(self.shares)
        weights = np.array([self.shares[n] for n in names])
        name = names[rng.choice(len(names), p=weights / weights.sum())]
        sounds = self.sounds[name]
        return name, sounds[rng.integers(len(sounds))]

    def part(self, rng, seconds, speeds):
        """A part from the start of a phoneme to the end of another."""
        speed = float(np.exp(rng.uniform(*np.log(speeds))))
        while True:
            name, sound = self.pick(rng)
            spoken = self.spoken[name][sound.name]
            start, end = stretch(rng, spoken, seconds * speed)
            samples = self.groups[name].samples(sound)[int(start * RATE):int(end * RATE)]
            if len(samples) > SHORTEST_PART * RATE / 4:
                break
        played = effects.played(np.float32(samples) / 32768, speed)
        return Part(effects.at_level(faded(played), -20), spoken.between(start, end, speed), name, sound.name,
                    float(start), speed)


def stretch(rng, spoken, longest):
    """A range from the start of a phoneme to the end of another, at most `longest` seconds."""
    start = spoken.starts[rng.integers(len(spoken.starts))] if spoken.end > longest else 0.0
    stops = np.array([*spoken.starts[1:], spoken.end])
    fitting = stops[(stops > start) & (stops <= start + longest)]
    return start, fitting[-1] if len(fitting) else min(start + longest, spoken.end)


def faded(sound, samples=80):
    """Fades both ends, so that cut speech does not click."""
    out, ramp = sound.copy(), np.linspace(0, 1, samples, dtype=np.float32)
    if len(out) > 2 * samples:
        out[:samples] *= ramp
        out[-samples:] *= ramp[::-1]
    return out


def speech_scene(rng, speech, split, seconds, speeds=(0.8, 1.25), hard=1.0):
    """Concatenates parts of utterances, with or without pauses."""
    sound, parts, at = np.zeros(int(seconds * RATE), np.float32), [], 0.0
    while True:
        at += rng.uniform(0, 0.8) * (rng.random() < 0.6)
        if seconds - at < SHORTEST_PART:
            break
        part = speech.part(rng, seconds - at, speeds)
        first = int(at * RATE)
        part.at, part.sound = first / RATE, part.sound[:len(sound) - first]
        sound[first:first + len(part.sound)] = part.sound
        parts.append(part)
        at = part.at + part.spoken.end
    return Scene(effects.spoiled(rng, sound, split, hard), parts)


def noise_scene(rng, split, seconds):
    sound = effects.some_noise(rng, split, int(seconds * RATE))
    if rng.random() < 0.2:
        sound = effects.in_room(sound, effects.rooms(split)[rng.integers(len(effects.rooms(split)))])
    sound = effects.at_level(sound, rng.uniform(-60, -12)) if rng.random() < 0.95 else 0 * sound
    return Scene(np.clip(sound, -1, 1), [])


class Endless(torch.utils.data.IterableDataset):
    """Endless output of `make` from a seed, which differs between workers."""

    def __init__(self, seed):
        self.seed = seed

    def __iter__(self):
        worker = torch.utils.data.get_worker_info()
        rng = np.random.default_rng((self.seed, worker.id if worker else 0))
        while True:
            yield self.make(rng)


class PhonemeBatches(Endless):
    """(features [b,t,130], phoneme of each step [b,t], CTC targets, their lengths, controls and their weights [b,t,18],
    speech [b,t])."""

    def __init__(self, split, batch, seconds, seed, hard=1.0, shares=SHARES):
        super().__init__(seed)
        self.speech = Speech(split, shares)
        self.split = split
        self.batch = batch
        self.seconds = seconds
        self.hard = hard

    def make(self, rng):
        scenes = [noise_scene(rng, self.split, self.seconds) if rng.random() < NOISE_ALONE else
                  speech_scene(rng, self.speech, self.split, self.seconds, hard=self.hard) for _ in range(self.batch)]
        x = np.stack([features(s.sound, some_warp(rng)) for s in scenes])
        spoken = [s.spoken() for s in scenes]
        frames, sequences = np.stack([s.of_steps(x.shape[1]) for s in spoken]), [s.sequence() for s in spoken]
        controls, weights, speech = (np.stack(v) for v in zip(*(targets.of_scene(s, x.shape[1]) for s in scenes)))
        return (torch.from_numpy(np.float32(x)), torch.from_numpy(frames),
                torch.tensor([p for s in sequences for p in s]),
                torch.tensor([len(s) for s in sequences]), torch.from_numpy(controls), torch.from_numpy(weights),
                torch.from_numpy(np.int64(speech)))


def normalisation(batches=8, seed=7):
    """Mean and deviation of the features over training scenes."""
    data = PhonemeBatches("train", 32, 4.0, seed, shares={"synthetic": 0.5})
    rng = np.random.default_rng(seed)
    x = torch.cat([data.make(rng)[0].reshape(-1, FEATURES) for _ in range(batches)])
    return x.mean(0), x.std(0)
