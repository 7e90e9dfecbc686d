"""Motion of the head and of occluders, frame by frame."""
import numpy as np

from mien_training.data.expressions import min_jerk
from mien_training.renderer import camera
from mien_training.renderer.camera import LIMIT, SPREAD

NECK = np.array([0, -8, -3])  # the head turns about it, head frame, cm


def wander(rng, frames, spread, hold, ease):
    """Curves [frames,d]: rests and minimum-jerk moves between points of standard deviation `spread` [d]."""
    here = rng.normal(0, spread)
    rows, count = [], 0
    while count < frames:
        target = rng.normal(0, spread)
        still = np.repeat(here[None], rng.integers(*hold, endpoint=True), 0)
        move = here + min_jerk(rng.integers(*ease, endpoint=True))[:, None] * (target - here)
        rows += [still, move]
        count += len(still) + len(move)
        here = target
    start = rng.integers(count - frames + 1)
    return np.concatenate(rows)[start:start + frames]


def tremor(rng, frames, spread):
    """Smooth small motion [frames,d] of standard deviation `spread` [d]."""
    window = np.hanning(13)[1:-1]
    window /= np.sqrt((window ** 2).sum())
    noise = rng.normal(size=(frames + len(window) - 1, len(spread)))
    return np.stack([np.convolve(c, window, "valid") for c in noise.T], 1) * spread


def head_angles(rng, frames):
    """Yaw, pitch and roll [frames,3] in radians: slow mostly, fast turns and nods sometimes."""
    base = rng.normal(0, SPREAD * 0.6)
    ease = (5, 12) if rng.random() < 0.25 else (12, 45)
    moves = wander(rng, frames, SPREAD * rng.uniform(0.2, 0.9), (0, 40), ease)
    return np.clip(base + moves + tremor(rng, frames, np.radians([0.25, 0.25, 0.15])), -LIMIT, LIMIT)


def head_shift(rng, frames):
    """Shift of the head [frames,3] in cm, camera axes."""
    spread = np.array([2.5, 1.5, 3.0]) * rng.uniform(0.1, 1.2)
    return wander(rng, frames, spread, (0, 30), (10, 45)) + tremor(rng, frames, np.array([0.05, 0.05, 0.05]))


def sweep(rng, frames):
    """Shift of an occluder [frames,3] in cm: it enters from one side, stays for a while, and leaves."""
    away = rng.normal(size=3) * [1, 1, 0.05]
    away *= 30 / np.linalg.norm(away)
    come, stay = rng.integers(-20, frames), rng.integers(5, frames)
    ramp = min_jerk(rng.integers(6, 20))
    t = np.arange(frames)
    share = np.interp(t, come + np.arange(len(ramp)), 1 - ramp, left=1, right=0) + \
        np.interp(t, come + stay + np.arange(len(ramp)), ramp, left=0, right=1)
    return np.clip(share, 0, 1)[:, None] * away + tremor(rng, frames, np.array([0.2, 0.2, 0.1]))


def head_poses(rng, filmed_by, landmarks, frames):
    """How a head with landmarks [175,3] at rest moves before a camera: rotations [frames,3,3], translations [frames,3]
    in cm, and the sweep of an occluder [frames,3]."""
    angles, shift, passing = head_angles(rng, frames), head_shift(rng, frames), sweep(rng, frames)
    centre, side = camera.sample_place(rng, filmed_by)
    side = min(side, 0.22 * filmed_by.f_px / 0.36)  # room to move forwards
    ahead, rest = camera.pose_at(filmed_by, landmarks, (0, 0, 0), (centre, side))
    rotations = ahead @ camera.rotation(*angles.T)
    return rotations, rest + (ahead - rotations) @ NECK + shift, passing
