"""Decorrelates and scales features, so a decoder learns from small ones as fast as from large ones.

The map is linear and is later merged into the first layer of the decoder (`fold`).
"""
import torch

FLOOR = 3e-5  # of the mean variance: smaller ones are not magnified further


class Whitening:
    """x -> (x - mean) @ matrix."""

    def __init__(self, mean, matrix):
        self.mean, self.matrix = mean, matrix

    @classmethod
    def of(cls, samples):
        """Principal axes of samples [n,features], each at unit deviation."""
        x = samples.double()
        mean, deviation = x.mean(0), x.std(0) + 1e-6
        x = (x - mean) / deviation
        variances, axes = torch.linalg.eigh(x.T @ x / len(x))
        scale = (variances.clamp(min=0) + FLOOR * variances.mean()).rsqrt()
        return cls(mean.float(), (axes * scale / deviation[:, None]).float())

    def __call__(self, x):
        return (x - self.mean) @ self.matrix

    def start(self, decoder, count):
        """The state of `count` streams of a decoder of whitened features: before its first frame a decoder sees
        zeros."""
        first, *others = decoder.convolutions
        before = self(torch.zeros(1, len(self.mean))).expand(count, -1).unsqueeze(2)
        return [before, *(torch.zeros(count, c.in_channels, 1) for c in others)], None

    @torch.no_grad()
    def fold(self, state):
        """The state of a TemporalDecoder of features, from that of one of whitened features."""
        weight, bias = state["convolutions.0.weight"], state["convolutions.0.bias"]
        plain = torch.einsum("oik,fi->ofk", weight, self.matrix)
        return {**state, "convolutions.0.weight": plain,
                "convolutions.0.bias": bias - torch.einsum("ofk,f->o", plain, self.mean)}

    @torch.no_grad()
    def unfold(self, state):
        """The inverse."""
        weight, bias = state["convolutions.0.weight"], state["convolutions.0.bias"]
        white = torch.einsum("ofk,fi->oik", weight, torch.linalg.inv(self.matrix.double()).T.float())
        return {**state, "convolutions.0.weight": white,
                "convolutions.0.bias": bias + torch.einsum("ofk,f->o", weight, self.mean)}
