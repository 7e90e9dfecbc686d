"""Losses of phonemes and of the decoders."""
import torch
import torch.nn.functional as F

from mien_training.audio.audio_net import SPEECH_CONTROLS

BETA, SPEED_BETA = 0.05, 0.01  # larger errors count linearly
VELOCITY = 1.0                 # weight of differences between steps


def phoneme_losses(sequence, frame, frames, said, lengths):
    """(CTC per phoneme, cross entropy of the phoneme at each step)"""
    steps = torch.full((len(sequence),), sequence.shape[1], dtype=torch.long)
    ctc = F.ctc_loss(sequence.transpose(0, 1), said, steps, lengths, reduction="sum",
                     zero_infinity=True) / lengths.sum()
    return ctc, F.cross_entropy(frame.flatten(0, 1), frames.flatten(), label_smoothing=0.05)


def controls_loss(said, controls, weights, importance):
    """Smooth L1 of position and of the difference between steps, each control relative to its spread."""
    weight = weights * importance
    position = F.smooth_l1_loss(said, controls, beta=BETA, reduction="none")
    speed = F.smooth_l1_loss(said.diff(dim=1), controls.diff(dim=1), beta=SPEED_BETA, reduction="none")
    return (weight * position).mean() + VELOCITY * (weight[:, 1:] * speed).mean()


def importance_of(controls):
    """1/spread of each control, at most 20; jawOpen, the most visible, three times."""
    out = 1 / controls.flatten(0, -2).std(0).clamp(min=0.05)
    out[SPEECH_CONTROLS.index("jawOpen")] *= 3
    return out / out.mean()


def activity_loss(scores, speech):
    return F.cross_entropy(scores.flatten(0, 1), speech.flatten())
