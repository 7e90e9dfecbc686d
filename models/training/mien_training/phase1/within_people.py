"""A loss of the differences between faces of one person.

The level of a control depends on who the person is, and one image hardly shows it. An error of values makes the network
answer less than the truth where it is uncertain, for all of a person's faces; differences do not depend on the level.
"""
import torch

DECAY = 0.98
FLOOR = 2e-4  # variance of a control below which its concordance is ignored


def from_own_mean(values, weight, person):
    """Values [n,c] minus the weighted mean of the person's, whose number is in person int [n]."""
    _, row = person.unique(return_inverse=True)
    added = lambda x: torch.zeros_like(x).index_add(0, row, x)
    return values - (added(weight * values) / added(weight).clamp(min=1e-6))[row]


class Within:
    """1 - concordance (Lin 1989) of these differences, which has its minimum at the true amplitude. Batches have few
    people, so the variances are running means."""

    def __init__(self):
        self.moving_average = None  # means [2,c]: of the squared error, and of both variances together

    def loss(self, ours, truth, weight):
        """Of differences [n,c] with weights [n,c]: [c], up to a constant."""
        mean = lambda x: (weight * x).sum(0) / weight.sum(0).clamp(min=1)
        off, moved = mean((ours - truth) ** 2), mean(ours ** 2)
        now = torch.stack([off, moved + mean(truth ** 2)]).detach()
        if self.moving_average is None:
            self.moving_average = now
        self.moving_average = self.moving_average.lerp(now, 1 - DECAY)
        spread = self.moving_average[1] + FLOOR
        return (off - self.moving_average[0] / spread * moved) / spread
