"""Features made independent of each other and of one size, so that a decoder learns from the small ones as fast as from the large ones.

The map is linear, and afterwards becomes a part of the decoder's first layer (`fold`).
"""
import torch

from networks import TemporalDecoder

FLOOR = 3e-5  # of the mean variance: what varies less than this is not magnified further


class Whitening:
    """x -> (x - mean) @ matrix."""

    def __init__(self, mean, matrix):
        self.mean, self.matrix = mean, matrix

    @classmethod
    def of(cls, samples, floor=FLOOR):
        """Principal axes of samples [n,features], each at unit deviation."""
        x = samples.double()
        mean, deviation = x.mean(0), x.std(0) + 1e-6
        x = (x - mean) / deviation
        variances, axes = torch.linalg.eigh(x.T @ x / len(x))
        scale = (variances.clamp(min=0) + floor * variances.mean()).rsqrt()
        return cls(mean.float(), (axes * scale / deviation[:, None]).float())

    def __call__(self, x):
        return (x - self.mean) @ self.matrix

    def start(self, decoder, count):
        """The state of `count` streams of a decoder of whitened features: before its first frame a decoder sees zeros."""
        first, *others = decoder.convolutions
        before = self(torch.zeros(1, len(self.mean))).expand(count, -1).unsqueeze(2)
        return [before, *(torch.zeros(count, c.in_channels, 1) for c in others)], None

    @torch.no_grad()
    def fold(self, state):
        """The state of a TemporalDecoder of features out of that of one of whitened features."""
        weight, bias = state["convolutions.0.weight"], state["convolutions.0.bias"]
        plain = torch.einsum("oik,fi->ofk", weight, self.matrix)
        return {**state, "convolutions.0.weight": plain, "convolutions.0.bias": bias - torch.einsum("ofk,f->o", plain, self.mean)}

    @torch.no_grad()
    def unfold(self, state):
        """The other way round."""
        weight, bias = state["convolutions.0.weight"], state["convolutions.0.bias"]
        white = torch.einsum("ofk,fi->oik", weight, torch.linalg.inv(self.matrix.double()).T.float())
        return {**state, "convolutions.0.weight": white, "convolutions.0.bias": bias + torch.einsum("ofk,f->o", weight, self.mean)}


def self_test():
    torch.manual_seed(0)
    samples = torch.randn(2000, 12) @ torch.randn(12, 12) * torch.logspace(-2, 2, 12) + 3
    whitening = Whitening.of(samples)
    white = whitening(samples)
    assert (white.T @ white / len(white) - torch.eye(12)).abs().max() < 0.05
    decoder = TemporalDecoder([8, 8, 8], 5, 12)
    twin = TemporalDecoder([8, 8, 8], 5, 12)
    twin.load_state_dict(whitening.fold(decoder.state_dict()))
    x = samples[:60].view(4, 15, 12)
    apart = (twin(x)[0] - decoder(whitening(x), whitening.start(decoder, 4))[0]).abs().max()
    assert apart < 1e-3, apart
    again = whitening.unfold(twin.state_dict())
    assert all(torch.allclose(again[k], v, atol=1e-3) for k, v in decoder.state_dict().items())
    print("whitening: ok")


if __name__ == "__main__":
    self_test()
