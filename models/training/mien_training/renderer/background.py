"""Backgrounds: parts of environments, studio walls, colour noise."""
import cv2
import numpy as np

from mien_training.renderer.assets import environment_picture

SHRINK = 2  # a backdrop has 1/SHRINK of the camera's pixels per axis


def piece(rng, name, width, height):
    """A random part of an environment's image, not only its horizon."""
    whole = environment_picture(name)
    h = int(rng.uniform(0.2, 0.7) * whole.shape[0])
    w = min(int(h * width / height), whole.shape[1])
    x, y = rng.integers(0, whole.shape[1] - w + 1), rng.integers(0, whole.shape[0] - h + 1)
    part = whole[y:y + h, x:x + w]
    if rng.random() < 0.5:
        part = np.ascontiguousarray(part[:, ::-1])
    return cv2.resize(part, (width, height), interpolation=cv2.INTER_AREA if w > width else cv2.INTER_LINEAR)


def colour(rng):
    return np.clip(rng.uniform(0, 255) * np.exp(rng.normal(0, 0.35, 3)), 0, 255)


def wall(rng, width, height):
    """From one colour to another along any direction, or one colour."""
    first = colour(rng)
    last = first if rng.random() < 0.4 else colour(rng)
    angle = rng.uniform(0, 2 * np.pi)
    y, x = np.mgrid[0:height, 0:width]
    t = (np.cos(angle) * x / width + np.sin(angle) * y / height)[..., None]
    return (first + (last - first) * (t - t.min()) / np.ptp(t)).astype(np.uint8)


def noise(rng, width, height):
    """Blotches of colour at a random scale."""
    cells = rng.integers(3, 60)
    small = np.clip(colour(rng) + rng.normal(0, 50, (cells, cells, 3)), 0, 255).astype(np.uint8)
    return cv2.resize(small, (width, height), interpolation=cv2.INTER_CUBIC)


def sample(rng, environment, camera):
    """A backdrop for the whole camera image, uint8 [height/SHRINK,width/SHRINK,3]."""
    width, height = camera.width // SHRINK, camera.height // SHRINK
    kind = rng.random()
    if kind < 0.75:
        out = piece(rng, environment, width, height)
        if rng.random() < 0.6:
            out = cv2.GaussianBlur(out, (0, 0), np.exp(rng.uniform(-0.7, 2)))
        return out
    return wall(rng, width, height) if kind < 0.93 else noise(rng, width, height)


def behind(backdrop, view):
    """The part of a backdrop that a view shows, uint8 [height,width,3]."""
    step = 1 / (view.scale * SHRINK)
    shift = lambda start: (start + 0.5 / view.scale) / SHRINK - 0.5
    matrix = np.array([[step, 0, shift(view.x0)], [0, step, shift(view.y0)]])
    return cv2.warpAffine(backdrop, matrix, (view.width, view.height), flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
                          borderMode=cv2.BORDER_REFLECT_101)
