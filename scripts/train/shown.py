"""What the tracker makes of the answers of a controls decoder, smoothing aside: tracker/decoders/controls_decoder.cpp and sides.cpp."""
import torch

from expressions import CONTROLS, PAIRED

TOLD_APART = 0.05  # sides.h
SIDED = [n for n in PAIRED if n not in ("jaw", "mouth", "eyeLookIn", "eyeLookOut")]
LEFT, RIGHT = ([CONTROLS.index(n + side) for n in SIDED] for side in ("Left", "Right"))


def shown(answers):
    """Controls f32 [...,52], within 0..1 and with sides that are hardly apart brought together."""
    controls = answers.clamp(0, 1)
    left, right = controls[..., LEFT], controls[..., RIGHT]
    middle, apart = (left + right) / 2, left - right
    half = apart * torch.clamp(apart.abs() / TOLD_APART, max=1) / 2
    controls[..., LEFT], controls[..., RIGHT] = middle + half, middle - half
    return controls


def self_test():
    answers = torch.zeros(2, 3, 52)
    a, b, jaw = CONTROLS.index("browDownLeft"), CONTROLS.index("browDownRight"), CONTROLS.index("jawLeft")
    answers[..., a], answers[0, 0, b], answers[..., jaw] = 0.02, 1.5, 0.02
    controls = shown(answers)
    assert len(SIDED) == 16
    assert torch.allclose(controls[0, 0, [a, b, jaw]], torch.tensor([0.02, 1, 0.02]))
    assert torch.allclose(controls[1, 2, [a, b, jaw]], torch.tensor([0.014, 0.006, 0.02]))
    assert answers[0, 0, b] == 1.5, "what is given stays as it was"


if __name__ == "__main__":
    self_test()
