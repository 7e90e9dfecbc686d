"""Sequences of landmarks without images: identity, expression and head pose move the 175 landmarks of the rig.

A stream never repeats. A sequence of 90 frames takes about 5 ms of one core. The decoder of true landmarks learns from
it (evaluate_yardstick.py).
"""

import numpy as np
import torch

from mien_training.data import expressions, head_pose
from mien_training.data import landmark_points as lp
from mien_training.data.face_batches import to_crop
from mien_training.renderer import camera, look, motion
from mien_training.renderer.rig import Rig

KNOWN = 2 * len(lp.TEACHER) + 9  # landmarks in crop coordinates and the pose


class PointRig:
    """The rig at its landmarks alone."""

    def __init__(self, rig=None):
        rig = rig or Rig()
        self.neutral = rig.landmarks(rig.neutral)
        self.identity_shapes, self.control_shapes = (
            rig.landmark_shapes(shapes).reshape(shapes.shape[1], -1)
            for shapes in (rig.identity_shapes, rig.control_shapes))

    def moved(self, identity, controls):
        """Landmarks at rest f32 [175,3] and with controls [frames,52], [frames,175,3], in the head's frame, cm."""
        rest = self.neutral + (identity @ self.identity_shapes).reshape(self.neutral.shape)
        return rest, rest + (controls @ self.control_shapes).reshape(-1, *self.neutral.shape)


def sequence(rig, rng, frames, perform):
    """One performance of a new person before a new camera, as labels of make_synthetic.py name it."""
    controls = perform(rng, frames)
    rest, points = rig.moved(look.sample_identity(rng), controls)
    filmed_by = camera.sample_camera(rng)
    rotation, translation, _ = motion.head_poses(rng, filmed_by, rest, frames)
    seen_at = filmed_by.project(points @ rotation.transpose(0, 2, 1) + translation[:, None])
    return dict(controls=controls, landmarks=seen_at, crop=camera.fit_crop(seen_at), rotation=rotation,
                translation=translation / 100,
                f_px=np.full(frames, filmed_by.f_px),
                camera_wh=np.tile([filmed_by.width, filmed_by.height], (frames, 1)))


def template():
    return torch.tensor(lp.template(), dtype=torch.float32)


def known(labels):
    """Input of a decoder of true landmarks: f32 [...,KNOWN] from landmarks, crop, rotation, translation, f_px and
    camera_wh."""
    crops, points = labels["crop"].float(), labels["landmarks"].float()
    inside = to_crop(crops.flatten(0, 1), points.flatten(0, 1)).view_as(points) - template()
    pose = head_pose.to_crop(*(labels[k].float() for k in ("rotation", "translation", "f_px", "camera_wh")), crops)
    return torch.cat([inside.flatten(2), pose], -1)


def batch(rig, rng, count, frames, perform=expressions.sample_sequence):
    """Features f32 [count,frames,KNOWN] and controls [count,frames,52] of new people; `perform` makes the controls of a
    sequence."""
    rows = [sequence(rig, rng, frames, perform) for _ in range(count)]
    labels = {k: torch.from_numpy(np.stack([row[k] for row in rows])) for k in rows[0]}
    return known(labels), labels["controls"].float()
