"""Training data of the jaw decoder: features and jawOpen of whole clips, cached beside the audio (jaw_train.npz).

Clips of GRID and takes of the animated voice, clean and degraded (effects.py); synthetic voices with the jaw of the
controls decoder; noise alone with a closed jaw. Test speakers are not in it: s5 of av/people and the people of the
clips.
"""
from dataclasses import dataclass, replace

import numpy as np
import torch

from mien_training.audio import corpus, effects, golden_outputs, jaw, teacher
from mien_training.audio.audio_net import JAW
from mien_training.audio.features import RATE, WINDOW, features, seconds_of_steps
from mien_training.networks import weight_reader

STEPS = 203                      # of a row: 3 s, and 0.25 s of silence
SAMPLES = STEPS * WINDOW
SECONDS = 3.0
TEST_SPEAKERS = ("s5",)
MAIN_SHARE = 0.4                 # share of s1, who has ten times as many clips as all others
NOISES, VOICES = 60, 120         # rows
HARD = 0.8                       # frequency of degradations
SEEN, SYNTHETIC, NOISE = range(3)


@dataclass
class Row:
    sound: np.ndarray   # f32 [SAMPLES]
    name: str
    speaker: str
    kind: int
    curve: np.ndarray   # jawOpen of video frames, as measured; empty where no face was detected
    fps: int = teacher.FPS


def whole_row(samples):
    sound = np.zeros(SAMPLES, np.float32)
    sound[:min(len(samples), SAMPLES)] = np.float32(samples[:SAMPLES]) / 32768
    return sound


def seen_rows(rng, split):
    for group in ("people", "av", "animated"):
        sounds, fps = corpus.Group(group), 30 if group == "animated" else teacher.FPS
        frames = int(SECONDS * fps)
        for sound in sounds.of(split):
            curve = teacher.clips(group).get(sound.name)
            if curve is None or sound.speaker in TEST_SPEAKERS:
                continue
            if group == "av" and split == "train" and rng.random() > MAIN_SHARE:
                continue
            samples = sounds.samples(sound)
            for first in range(0, len(curve) - frames + 1, frames):
                part, seen = samples[round(first / fps * RATE):], curve[first:first + frames, JAW]
                yield Row(whole_row(part), f"{sound.name}_{first}", sound.speaker, SEEN, seen, fps)


def other_rows(rng, split):
    voices = corpus.Group("synthetic")
    for sound in voices.of(split)[:VOICES]:
        spoken = effects.at_level(whole_row(voices.samples(sound)), -23)
        yield Row(spoken, sound.name, sound.speaker, SYNTHETIC, np.zeros(0, np.float32))
    for k in range(NOISES):
        noise = effects.at_level(effects.some_noise(rng, split, SAMPLES), rng.uniform(-60, -12))
        yield Row(np.clip(noise, -1, 1), f"noise{k}", "noise", NOISE, np.zeros(0, np.float32))


def spoiled(rng, row, split):
    return replace(row, sound=effects.spoiled(rng, row.sound, split, HARD), name=row.name + "_spoiled")


@torch.no_grad()
def answers(networks, sounds):
    """Embedding [n,t,80] and jawOpen [n,t] of the controls decoder."""
    x = torch.from_numpy(np.float32(np.stack([features(s) for s in sounds])))
    embedding = golden_outputs.run(networks["encoder"], x)
    controls = golden_outputs.run(networks["controls_decoder"], embedding).clamp(0, 1)
    return embedding.numpy(), controls[..., JAW].numpy()


def target(row, answered):
    """jawOpen of the steps, and where it is known."""
    times = seconds_of_steps(STEPS)
    if row.kind == SEEN:
        seconds = np.arange(len(row.curve)) / row.fps
        return np.interp(times, seconds, row.curve), (times >= 0) & (times <= seconds[-1])
    return answered * (row.kind == SYNTHETIC), np.ones(STEPS, bool)


def wide(rows):
    """{speaker: factor}, with which each speaker's jaw opens equally far (teacher.py)."""
    jaws = {}
    for row in rows:
        if row.kind == SEEN:
            jaws.setdefault(row.speaker, []).append(row.curve)
    widest = {who: np.percentile(np.concatenate(parts), teacher.WIDE_SHARE) for who, parts in jaws.items()}
    return {who: teacher.WIDE / max(jaw_open, 0.05) for who, jaw_open in widest.items()}


def made(model, split="train", seed=1, batch=64):
    """{array name: values}, a row per clip."""
    rng, networks = np.random.default_rng(seed), weight_reader.networks(model)
    rows = [*seen_rows(rng, split), *other_rows(rng, split)]
    factors = wide(rows)
    rows += [spoiled(rng, row, split) for row in rows if row.kind != NOISE]
    out = {name: [] for name in ("inputs", "jaw", "known")}
    for first in range(0, len(rows), batch):
        part = rows[first:first + batch]
        for row, embedding, answered in zip(part, *answers(networks, [r.sound for r in part])):
            values, known = target(row, answered)
            energies = jaw.relative(jaw.energies(row.sound))
            out["inputs"].append(np.float16(np.concatenate([embedding, energies], 1)))
            out["jaw"].append(np.float32(np.clip(values * factors.get(row.speaker, 1), 0, 1)))
            out["known"].append(known)
    described = {name: np.array([getattr(row, name) for row in rows]) for name in ("speaker", "kind", "name")}
    return {name: np.stack(v) for name, v in out.items()} | described


def cached(model, split="train"):
    path = corpus.folder() / f"jaw_{split}.npz"
    if not path.exists():
        np.savez(path, **made(model, split))
    return np.load(path)
