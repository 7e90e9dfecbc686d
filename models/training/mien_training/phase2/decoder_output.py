"""The tracker's post-processing of the controls decoder without smoothing: clamping and symmetrization.

See tracker/decoders/controls_decoder.cpp and sides.cpp.
"""
import torch

from mien_training.data.expressions import CONTROLS, PAIRED

SYMMETRY_THRESHOLD = 0.05  # sides.h
SIDED = [n for n in PAIRED if n not in ("jaw", "mouth", "eyeLookIn", "eyeLookOut")]
LEFT, RIGHT = ([CONTROLS.index(n + side) for n in SIDED] for side in ("Left", "Right"))


def output_controls(answers):
    """Controls f32 [...,52], within 0..1 and with sides that are hardly apart brought together."""
    controls = answers.clamp(0, 1)
    left, right = controls[..., LEFT], controls[..., RIGHT]
    middle, apart = (left + right) / 2, left - right
    half = apart * torch.clamp(apart.abs() / SYMMETRY_THRESHOLD, max=1) / 2
    controls[..., LEFT], controls[..., RIGHT] = middle + half, middle - half
    return controls
