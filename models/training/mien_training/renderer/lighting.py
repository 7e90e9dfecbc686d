"""Light from environments and lamps, in camera space."""
import functools

import cv2
import numpy as np

from mien_training.paths import data
from mien_training.renderer import native
from mien_training.renderer.assets import names

PROBES = 96       # normals at which an environment's irradiance is known
COLOURFUL = 0.6   # share of an environment's colour that is kept: cameras balance their white


@functools.lru_cache
def sphere(count):
    """Evenly spread unit vectors [count,3] (Fibonacci)."""
    z = 1 - (2 * np.arange(count) + 1) / count
    turn = np.pi * (3 - np.sqrt(5)) * np.arange(count)
    radius = np.sqrt(1 - z * z)
    return np.stack([radius * np.cos(turn), z, radius * np.sin(turn)], 1).astype(np.float32)


@functools.lru_cache
def irradiance(name):
    """Irradiance f32 [PROBES,3] (RGB) of an environment on surfaces facing sphere(PROBES), mean 1."""
    hdr = cv2.imread(str(data() / "environments" / f"{name}.hdr"), cv2.IMREAD_UNCHANGED)[..., ::-1]
    hdr = cv2.resize(hdr, (64, 32), interpolation=cv2.INTER_AREA)
    polar, around = np.meshgrid((np.arange(32) + 0.5) / 32 * np.pi, (np.arange(64) + 0.5) / 64 * 2 * np.pi,
                                indexing="ij")
    towards = np.stack([np.sin(polar) * np.sin(around), np.cos(polar), np.sin(polar) * np.cos(around)], -1)
    radiance = (hdr * np.sin(polar)[..., None]).reshape(-1, 3)
    found = np.clip(sphere(PROBES) @ towards.reshape(-1, 3).T, 0, None) @ radiance
    grey = found.mean(1, keepdims=True)
    return np.float32((grey + COLOURFUL * (found - grey)) / grey.mean())


def basis(n):
    x, y, z = n.T
    return np.stack([x * x, y * y, z * z, x * y, x * z, y * z, x, y, z, np.ones_like(x)], 1)


def turned(rng):
    """Environment frame -> camera frame: any turn about the vertical, a slight tilt."""
    turn, tilt = rng.uniform(0, 2 * np.pi), rng.normal(0, 0.15)
    c, s = np.cos(turn), np.sin(turn)
    about_y = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    c, s = np.cos(tilt), np.sin(tilt)
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]]) @ about_y


def sample_lamp(rng, hard):
    """Direction and colour of a lamp; a hard one stands to the side."""
    direction = rng.normal(size=3) * [1, 0.6, 0.6] + [0, 0.3, 0.5]
    if hard:
        direction = np.array([rng.choice([-1, 1]) * rng.uniform(0.6, 1), rng.uniform(-0.2, 0.9),
                              rng.uniform(-0.1, 0.8)])
    warmth = rng.normal(0, 0.12)
    strength = rng.uniform(0.6, 2.0) if hard else rng.uniform(0.1, 0.9)
    return direction / np.linalg.norm(direction), strength * np.array([1 + warmth, 1, 1 - warmth])


def sample(rng, environment):
    """A native.Light: an environment and up to three lamps, exposed for a face towards the camera."""
    light = native.Light()
    normals = sphere(PROBES) @ turned(rng).T
    coefficients = np.linalg.lstsq(basis(normals), irradiance(environment), rcond=None)[0] * rng.uniform(0.25, 1)
    hard = rng.random() < 0.35
    lamps = [sample_lamp(rng, hard and k == 0) for k in range(rng.integers(1 if hard else 0, 4))]
    light.irradiance[:] = coefficients.T.ravel()
    light.lamps = len(lamps)
    light.shadow = int(bool(lamps) and (hard or rng.random() < 0.3))
    front = np.array([[0, 0, 1], [0.6, 0, 0.8], [-0.6, 0, 0.8]])
    found = (basis(front) @ coefficients).mean(1)
    for k, (direction, colour) in enumerate(lamps):
        light.direction[3 * k:3 * k + 3], light.colour[3 * k:3 * k + 3] = direction, colour
        found = found + np.clip(front @ direction, 0, None) * colour.mean()
    light.exposure = rng.lognormal(-0.25, 0.3) / max(found.mean(), 0.05)
    return light


def sample_environment(rng, split):
    choice = names("environments", split)
    return choice[rng.integers(len(choice))]
