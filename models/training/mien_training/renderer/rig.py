"""The head rig: 100 identity and 58 expression shapes over 26,719 vertices, and the landmarks on it.

Head frame: centimetres, x to the subject's left, y up, z out of the face, origin between the ears.
"""
import numpy as np

from mien_training.data.expressions import CONTROLS, INDEX
from mien_training.paths import ROOT, data
from mien_training.renderer import camera, native

EYEBALL = 3.116, 3.602, 7.982  # centre of the left one
# Degrees (yaw, pitch) of the left eye at a control of 1: a line through an iPhone's angles (arkit_curves; R^2 0.998).
GAZE = {"In": (-35.6, 0), "Out": (32.7, 0), "Up": (0, -27.0), "Down": (0, 35.2)}
# The pupil's distance from the centre of rotation relative to the rig's: 1.05 cm of 1.5 cm. Atchison and Smith, Optics
# of the Human Eye, 2000: the centre lies 1.35 cm behind the cornea, the entrance pupil 0.3 cm.
PUPIL_DISTANCE = 0.7


def blocked(shapes):
    """Shapes [k,n] as native.blend_shapes reads them: f32 [blocks,k,native.BLOCK], n rounded up."""
    k, n = shapes.shape
    out = np.zeros((k, -(-n // native.BLOCK) * native.BLOCK), np.float32)
    out[:, :n] = shapes
    return np.ascontiguousarray(out.reshape(k, -1, native.BLOCK).transpose(1, 0, 2))


def turn_eyeballs(shapes, neutral, regions):
    """Adds the rotation of the eyeballs to the shapes [52,26719,3] of gaze, which in the data pack only move the
    lids."""
    for side, mirror in (("Left", 1), ("Right", -1)):
        ball = np.r_[regions[f"sclera_{side.lower()}"], regions[f"iris_{side.lower()}"]]
        from_centre = neutral[ball] - np.float32(EYEBALL) * (mirror, 1, 1)
        for direction, (yaw, pitch) in GAZE.items():
            turn = camera.rotation(*np.arcsin(PUPIL_DISTANCE * np.sin(np.radians([mirror * yaw, pitch]))), 0)
            shapes[INDEX[f"eyeLook{direction}{side}"], ball] += from_centre @ turn.T - from_centre


class Rig:
    def __init__(self):
        rig = np.load(data() / "rig/rig.npz")
        self.neutral = rig["v0"].astype(np.float32)
        self.identity_shapes = blocked(rig["ids"].reshape(100, -1))
        order = [[str(n) for n in rig["arkit_names"]].index(name) for name in CONTROLS]
        shapes = rig["ex"].astype(np.float32).reshape(len(rig["ex_names"]), -1)
        shapes = rig["arkit_map"].astype(np.float32)[order] @ shapes
        regions = {str(n): slice(*span) for n, span in zip(rig["region_names"], rig["region_range"])}
        turn_eyeballs(shapes.reshape(len(shapes), *self.neutral.shape), self.neutral, regions)
        self.control_shapes = blocked(shapes)
        self.corner_position = rig["gpu_pos"].astype(np.int32)[rig["gpu_f"].astype(np.int32)]
        self.corner_uv, self.uv = rig["gpu_f"].astype(np.int32), rig["gpu_uv"].astype(np.float32)
        self.materials = {str(n): (int(a), int(b)) for n, (a, b) in zip(rig["mat_names"], rig["mat_range"])}
        self.ibug68 = rig["landmarks68"].astype(np.int64)
        landmarks = np.load(ROOT / "models/training/mien_training/data/rig_landmarks.npz")
        self.landmark_vertices, self.landmark_weights = landmarks["vertices"], landmarks["weights"]

    def identity(self, coefficients):
        """Heads at rest f32 [n,26719,3] from coefficients f32 [n,100]."""
        return self.combine(coefficients, self.identity_shapes) + self.neutral

    def expression(self, controls):
        """Offsets of controls f32 [n,52] from the head at rest, f32 [n,26719,3]."""
        return self.combine(controls, self.control_shapes)

    def combine(self, weights, shapes):
        whole = native.blend_shapes(weights, shapes)[:, :self.neutral.size]
        return whole.reshape(-1, *self.neutral.shape)

    def landmark_shapes(self, shapes):
        """How each of the blocked shapes moves the landmarks, f32 [k,175,3]."""
        return self.landmarks(self.combine(np.eye(shapes.shape[1], dtype=np.float32), shapes))

    def landmarks(self, vertices):
        """Landmarks f32 [...,175,3] of vertices [...,26719,3]."""
        corners = vertices[..., self.landmark_vertices, :]
        return (corners * self.landmark_weights[..., None]).sum(-2)
