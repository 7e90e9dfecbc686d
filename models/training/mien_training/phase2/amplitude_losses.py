"""Losses that do not reward small motion.

The squared error has its minimum at the mean of the possible values, so an uncertain decoder predicts less than the
truth. Concordance (Lin 1989) has its maximum where predicted and true values agree and have the same variance, so an
uncertain decoder keeps the amplitude.
"""

FLOOR = 2e-4  # variance of a control below which its concordance is ignored


def centred(values, weight):
    """Values [streams,frames,c] minus the mean of their stream; weights are of the same shape."""
    return values - (weight * values).sum(1, keepdim=True) / weight.sum(1, keepdim=True).clamp(min=1e-6)


def discordance(predicted, target, weight):
    """1 - concordance correlation [c] of predicted and target [streams,frames,c], pooled over all that is given."""
    total = weight.sum((0, 1)).clamp(min=1e-6)
    mean = lambda x: (weight * x).sum((0, 1)) / total
    p, t = mean(predicted), mean(target)
    off = mean((predicted - target) ** 2)
    spread = mean((predicted - p) ** 2) + mean((target - t) ** 2) + (p - t) ** 2
    return off / (spread + FLOOR)


def discordance_within(predicted, target, weight):
    """The same for the differences between frames of one person."""
    p, t = centred(predicted, weight), centred(target, weight)
    total = weight.sum((0, 1)).clamp(min=1e-6)
    off, spread = (weight * (p - t) ** 2).sum((0, 1)), (weight * (p * p + t * t)).sum((0, 1))
    return (off / total) / (spread / total + FLOOR)
