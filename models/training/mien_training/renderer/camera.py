"""Cameras, head poses, crops and windows in numpy, one at a time; camera space as in head_pose.py."""
import functools
from dataclasses import dataclass

import numpy as np

from mien_training.data import landmark_points as lp
from mien_training.renderer import native

SPREAD = np.radians([25, 13, 10])     # of yaw, pitch, roll relative to the line of sight
LIMIT = np.radians([70, 45, 50])
FAR = np.radians([35, 70])            # yaw of a head that does


@dataclass
class Camera:
    width: int
    height: int
    f_px: float

    @property
    def centre(self):
        return np.array([self.width / 2, self.height / 2])

    def project(self, points):
        """Pixels [...,2] of camera-space points [...,3]."""
        scale = self.f_px / -points[..., 2:]
        return self.centre + points[..., :2] * scale * [1, -1]

    def ray(self, pixel):
        """Point at depth 1 on the line of sight through a pixel."""
        x, y = (pixel - self.centre) / self.f_px
        return np.array([x, -y, -1.0])

    def view(self, x0, y0, side, width, height):
        """Image of width x height pixels whose left upper corner is (x0, y0) and whose width spans `side` camera
        pixels."""
        return native.View(self.f_px, *self.centre, x0, y0, width / side, width, height)


def sample_camera(rng):
    width, height = (640, 480) if rng.random() < 0.7 else (480, 640)
    fov = np.radians(rng.uniform(30, 75))
    return Camera(width, height, width / 2 / np.tan(fov / 2))


def rotation(yaw, pitch, roll):
    """Rotations [...,3,3] of angles [...]."""
    (cy, cp, cr), (sy, sp, sr) = np.cos([yaw, pitch, roll]), np.sin([yaw, pitch, roll])
    zero, one = np.zeros_like(cy), np.ones_like(cy)
    matrix = lambda *rows: np.stack([np.stack(row, -1) for row in rows], -2)
    about_y = matrix((cy, zero, sy), (zero, one, zero), (-sy, zero, cy))
    about_x = matrix((one, zero, zero), (zero, cp, -sp), (zero, sp, cp))
    about_z = matrix((cr, -sr, zero), (sr, cr, zero), (zero, zero, one))
    return about_y @ about_x @ about_z


def towards(ray):
    """Shortest rotation from (0,0,-1) to a line of sight."""
    x, y, z = ray / np.linalg.norm(ray)
    k = 1 / (1 - z)
    return np.array([[1 - k * x * x, -k * x * y, -x], [-k * x * y, 1 - k * y * y, -y], [x, y, -z]])


def sample_angles(rng, turned=0):
    """Yaw, pitch and roll; a share looks far to one side, where half of the face is hidden."""
    angles = np.clip(rng.normal(0, SPREAD), -LIMIT, LIMIT)
    if turned and rng.random() < turned:
        angles[0] = rng.choice([-1, 1]) * rng.uniform(*FAR)
    return angles


def sample_place(rng, camera):
    """Where the face is: centre in pixels and crop side in pixels, nowhere nearer than 28 cm."""
    side = np.exp(rng.uniform(np.log(60), np.log(420)))
    side = min(side, 0.22 * camera.f_px / 0.28)
    size = np.array([camera.width, camera.height])
    margin = np.minimum(0.45 * side, 0.45 * size)
    return rng.uniform(margin, size - margin), side


@functools.lru_cache
def centred_template():
    """Mean of the template's points relative to the centre of a crop, and the weights [175] that give rotation and
    scale of a face."""
    source = (lp.template() - 0.5) @ [1, 1j]
    s = source - source.mean()
    return source.mean(), s.conj() / (np.abs(s) ** 2).sum()


def fit_crop(points):
    """Crops [...,4] (cx, cy, side, roll) of landmarks [...,175,2]: least-squares similarity from the template (Umeyama
    1991)."""
    mean, conjugate = centred_template()
    target = points[..., 0] + 1j * points[..., 1]
    middle = target.mean(-1)
    a = (target - middle[..., None]) @ conjugate
    centre = middle - a * mean
    return np.stack([centre.real, centre.imag, np.abs(a), np.angle(a)], -1)


def pose_at(camera, landmarks, angles, place, rounds=3):
    """Pose (rotation [3,3], translation [3] cm) that puts landmarks [175,3] of the head at `place` (centre, side)."""
    centre, side = place
    turn = towards(camera.ray(centre)) @ rotation(*angles)
    depth = camera.f_px * 21 / side
    shift = camera.ray(centre) * depth - turn @ landmarks.mean(0)
    for _ in range(rounds):
        crop = fit_crop(camera.project(landmarks @ turn.T + shift))
        depth = -(turn @ landmarks.mean(0) + shift)[2]
        deeper = depth * (crop[2] / side - 1)
        shift = shift + camera.ray(centre) * deeper
        off = (centre - crop[:2]) * (depth + deeper) / camera.f_px
        shift = shift + [off[0], -off[1], 0]
    return turn, shift
