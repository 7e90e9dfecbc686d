"""Losses that do not reward a decoder for moving less than the face does.

A squared error is smallest for the mean of what may be: a decoder that is not sure answers less than the truth. Concordance (Lin 1989) is
largest where predicted and true values agree and vary as much as each other, so that an uncertain decoder keeps the amplitude.
"""
import torch

FLOOR = 2e-4  # variance of a control below which its concordance counts for nothing


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
    """The same of what differs from frame to frame of one person."""
    p, t = centred(predicted, weight), centred(target, weight)
    total = weight.sum((0, 1)).clamp(min=1e-6)
    off, spread = (weight * (p - t) ** 2).sum((0, 1)), (weight * (p * p + t * t)).sum((0, 1))
    return (off / total) / (spread / total + FLOOR)


def self_test():
    torch.manual_seed(0)
    truth, weight = torch.rand(20, 50, 3), torch.ones(20, 50, 3)
    assert discordance(truth, truth, weight).max() < 1e-6 and discordance_within(truth, truth, weight).max() < 1e-6
    # Of guesses that explain half of the variance, concordance is best at the truth's amplitude, a squared error at half of it.
    noisy = truth - 0.5 + torch.randn_like(truth) * truth.std()
    gains = torch.linspace(0.3, 1.5, 25)
    best = lambda loss: gains[torch.stack([loss(g * noisy + 0.5) for g in gains]).argmin()]
    ratio = lambda g: float(g * noisy.std() / truth.std())
    assert abs(ratio(best(lambda p: discordance(p, truth, weight).mean())) - 1) < 0.1
    assert abs(ratio(best(lambda p: discordance_within(p, truth, weight).mean())) - 1) < 0.1
    assert ratio(best(lambda p: ((p - truth) ** 2).mean())) < 0.8
    shifted = truth + torch.rand(20, 1, 3)
    assert discordance_within(shifted, truth, weight).max() < 1e-6 < 0.1 < discordance(shifted, truth, weight).min()
    # What is not seen counts for nothing.
    weight[:, 25:] = 0
    spoilt = truth.clone()
    spoilt[:, 25:] = 0
    assert discordance(spoilt, truth, weight).max() < 1e-6 and discordance_within(spoilt, truth, weight).max() < 1e-6
    print("amplitude_losses: ok")


if __name__ == "__main__":
    self_test()
