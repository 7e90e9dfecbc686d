"""Degradations of speech: noise, rooms, other voices, levels, codecs, bad microphones.

Audio is float32 at 16 kHz, full scale 1.
"""
import audioop
import functools

import numpy as np
from scipy.signal import butter, fftconvolve, lfilter

from mien_training.audio import corpus, opus
from mien_training.audio.features import RATE


def played(sound, speed):
    """Resampled to `speed` times the speed: pitch and formants change as well, as for a smaller person."""
    count = int(len(sound) / speed)
    return np.interp(np.arange(count) * speed, np.arange(len(sound)), sound).astype(np.float32)


def power(sound):
    return float(np.mean(sound ** 2)) + 1e-12


def speech_power(sound):
    """Power of the windows within 20 dB of the loudest, so that pauses do not count."""
    windows = sound[:len(sound) // 400 * 400].reshape(-1, 400)
    powers = np.mean(windows ** 2, 1) if len(windows) else np.array([power(sound)])
    return float(powers[powers >= 0.01 * powers.max()].mean()) + 1e-12


def mixed(sound, noise, decibels):
    """The sound with noise at this signal-to-noise ratio in dB."""
    return sound + noise * np.sqrt(speech_power(sound) / power(noise) * 10 ** (-decibels / 10))


SHORTEST_RESPONSE = 256  # samples


@functools.lru_cache(None)
def rooms(split):
    """Impulse responses of energy 1 that start with the direct sound."""
    group = corpus.Group("rooms")
    out = []
    for s in group.of(split):
        if s.length < SHORTEST_RESPONSE:
            continue  # some files are empty
        response = np.float32(group.samples(s)) / 32768
        response = response[np.argmax(np.abs(response)):][:RATE]
        out.append(response / np.sqrt(np.sum(response ** 2)))
    return out


def in_room(sound, response):
    return fftconvolve(sound, response)[:len(sound)].astype(np.float32)


@functools.lru_cache(None)
def noises(split):
    group = corpus.Group("noise")
    return group, group.of(split)


def recorded_noise(rng, split, count):
    group, sounds = noises(split)
    sound = sounds[rng.integers(len(sounds))]
    samples = group.samples(sound)
    at = rng.integers(max(len(samples) - count, 0) + 1)
    return np.float32(np.resize(samples[at:at + count], count)) / 32768


def coloured_noise(rng, count):
    """White to brown."""
    return lfilter([1], [1, -rng.choice([0, 0.5, 0.9, 0.98])], rng.standard_normal(count)).astype(np.float32)


def music(rng, count):
    """Chords of harmonic tones and occasional drums, with the spectrum of music."""
    out, beat = np.zeros(count, np.float32), rng.uniform(0.15, 0.7)
    for first in np.arange(0, count, int(beat * RATE)):
        t = np.arange(min(count - first, RATE), dtype=np.float32) / RATE
        note, decay, root = np.zeros(len(t), np.float32), rng.uniform(1, 8), 55 * 2 ** (rng.integers(0, 36) / 12)
        for interval in rng.choice([0, 3, 4, 7, 10, 12], rng.integers(1, 4), replace=False):
            pitch, slope = root * 2 ** (interval / 12), rng.uniform(0.5, 2.5)
            for k in range(1, int(rng.integers(2, 8))):
                note += np.sin(np.float32(2 * np.pi * k * pitch) * t) / np.float32(k ** slope)
        note *= np.exp(-decay * t)
        if rng.random() < 0.5:
            note += np.float32(np.exp(-t * rng.uniform(15, 60)) * rng.standard_normal(len(t)) * rng.uniform(0.5, 3))
        out[first:first + len(t)] += note
    return out


TUNES, TUNE_SECONDS = [], 10


def part_of_tune(rng, count, most=60):
    """A random part of one of `most` tunes, which are cached because they take long to create."""
    if len(TUNES) < most:
        TUNES.append(music(rng, TUNE_SECONDS * RATE))
    tune = TUNES[rng.integers(len(TUNES))]
    return np.resize(np.roll(tune, -rng.integers(len(tune))), count)


def impulses(rng, count):
    """Clicks, knocks, claps, and puffs of air."""
    out = np.zeros(count, np.float32)
    for _ in range(rng.integers(1, 8)):
        at, length = rng.integers(count), int(RATE * rng.uniform(0.002, 0.15 if rng.random() < 0.75 else 0.7))
        t = np.arange(min(length, count - at)) / RATE
        body = rng.standard_normal(len(t)) if rng.random() < 0.6 else np.sin(2 * np.pi * rng.uniform(80, 3000) * t)
        out[at:at + len(t)] += rng.uniform(0.2, 1) * np.exp(-t * 5 * RATE / length) * body
    return out


def gliding_tone(rng, count):
    """Harmonics of a pitch that glides and trembles, as of animals, hinges and sirens."""
    t = np.arange(count, dtype=np.float32) / count
    octaves = rng.uniform(-1, 1) * t + rng.uniform(-0.7, 0.7) * np.sin(np.pi * t)
    octaves += rng.uniform(0, 0.05) * np.sin(2 * np.pi * rng.uniform(3, 12) * t * count / RATE)
    pitch = np.exp(rng.uniform(np.log(150), np.log(2500))) * 2 ** octaves
    phase, slope = 2 * np.pi * np.cumsum(pitch) / RATE, rng.uniform(0, 2)
    out = np.zeros(count)
    for k in range(1, int(rng.integers(2, 16))):
        out += np.sin(k * phase) * (k * pitch < RATE / 2) * rng.uniform(0.2, 1) / k ** slope
    rough = 1 + rng.uniform(0, 0.6) * np.sin(2 * np.pi * rng.uniform(15, 70) * t * count / RATE)
    return np.float32(out * rough * np.minimum(1, np.minimum(t, 1 - t) / rng.uniform(0.02, 0.5)))


def gliding_tones(rng, count):
    out = np.zeros(count, np.float32)
    for _ in range(rng.integers(1, 4)):
        at, length = rng.integers(count), int(RATE * rng.uniform(0.15, 1.5))
        out[at:at + length] += rng.uniform(0.3, 1) * gliding_tone(rng, length)[:count - at]
    return out


def varied_noise(rng, split, count):
    """Recorded noise at another speed or backwards, and sometimes two of them, because there are few recordings."""
    speed = np.exp(rng.uniform(np.log(0.6), np.log(1.7)))
    noise = np.resize(played(recorded_noise(rng, split, int(count * speed) + 2), speed), count)
    if rng.random() < 0.2:
        noise = noise[::-1]
    if rng.random() < 0.2:
        other = recorded_noise(rng, split, count)
        noise = noise + other * np.float32(np.sqrt(power(noise) / power(other)) * rng.uniform(0.3, 1))
    return noise


RECORDED = 0.5  # share of noises; of the others:
MADE_NOISES = {coloured_noise: 0.36, part_of_tune: 0.28, gliding_tones: 0.2, impulses: 0.16}


def some_noise(rng, split, count):
    if rng.random() < RECORDED:
        return varied_noise(rng, split, count)
    return rng.choice(list(MADE_NOISES), p=list(MADE_NOISES.values()))(rng, count)


def band_limited(rng, sound):
    """A telephone, a small loudspeaker, a cheap microphone."""
    if rng.random() < 0.6:
        sound = lfilter(*butter(2, rng.uniform(2500, 7000) / (RATE / 2)), sound)
    if rng.random() < 0.6:
        sound = lfilter(*butter(1, rng.uniform(60, 400) / (RATE / 2), "high"), sound)
    return np.float32(sound)


def mu_law(sound, bits=8):
    """Companding by the curve of ITU-T G.711."""
    levels = 2 ** (bits - 1)
    bent = np.sign(sound) * np.log1p(255 * np.abs(sound)) / np.log(256)
    steps = np.rint(bent * levels) / levels
    return np.float32(np.sign(steps) * (256 ** np.abs(steps) - 1) / 255)


def adpcm(sound):
    """IMA ADPCM of 4 bits, as in small recorders and old radios."""
    packed, _ = audioop.lin2adpcm(np.int16(np.clip(sound, -1, 1) * 32767).tobytes(), 2, None)
    return np.float32(np.frombuffer(audioop.adpcm2lin(packed, 2, None)[0], np.int16)) / 32768


def coded(rng, sound):
    """The sound after one of three codecs."""
    kind = rng.random()
    if kind < 0.4:
        return opus.coded(np.clip(sound, -1, 1), int(rng.integers(6000, 20000)))
    return adpcm(sound) if kind < 0.7 else mu_law(np.clip(sound, -1, 1), int(rng.integers(6, 9)))


def clipped(sound, share):
    """Clips the sound at this share of its peak."""
    limit = share * np.abs(sound).max() + 1e-6
    return np.clip(sound, -limit, limit)


def at_level(sound, decibels):
    """Scales speech to this level relative to full scale."""
    return sound * np.float32(np.sqrt(10 ** (decibels / 10) / speech_power(sound)))


def spoiled(rng, sound, split, hard=1.0):
    """Random degradations as of microphones; `hard` scales their frequency. Speech then has -45 to -12 dBFS."""
    if rng.random() < 0.3 * hard:
        response = rooms(split)[rng.integers(len(rooms(split)))]
        wet = rng.uniform(0.2, 1)
        sound = (1 - wet) * sound + wet * at_level(in_room(sound, response), 10 * np.log10(speech_power(sound)))
    if rng.random() < 0.2 * hard:
        sound = band_limited(rng, sound)
    if rng.random() < 0.7 * hard:
        sound = mixed(sound, some_noise(rng, split, len(sound)), rng.uniform(-5, 30))
    sound = at_level(sound, rng.uniform(-45, -12))
    if rng.random() < 0.06 * hard:
        sound = clipped(sound, rng.uniform(0.1, 0.6))
    if rng.random() < 0.12 * hard:
        sound = coded(rng, sound)
    if rng.random() < 0.5:
        sound = sound + np.float32(rng.uniform(-0.02, 0.02)) * (rng.random() < 0.3)
        sound = sound + np.float32(10 ** rng.uniform(-5, -3)) * rng.standard_normal(len(sound)).astype(np.float32)
    return np.clip(np.float32(sound), -1, 1)
