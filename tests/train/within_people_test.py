"""The loss of differences between faces of one person."""
import unittest

import torch

from mien_training.phase1.within_people import Within, from_own_mean


class WithinPeople(unittest.TestCase):
    def setUp(self):
        generator = torch.Generator().manual_seed(1)
        random = lambda *shape: torch.randn(*shape, generator=generator)
        self.person = torch.arange(500).repeat_interleave(4)
        self.truth, self.noise, self.level = random(2000, 2), random(2000, 2), random(500, 2)[self.person]
        self.weight = torch.ones(2000, 2)

    def loss(self, ours, weight):
        """The value where the running means have settled."""
        differences = (from_own_mean(v, weight, self.person) for v in (ours, self.truth))
        return Within().loss(*differences, weight)

    def test_a_persons_level_does_not_count(self):
        alone, moved = (self.loss(0.8 * self.truth + shift, self.weight) for shift in (0, 3 * self.level))
        self.assertTrue(torch.allclose(alone, moved, atol=1e-4))

    def test_an_uncertain_answer_keeps_the_true_amplitude(self):
        gain = torch.full((2,), 0.3, requires_grad=True)
        optimiser, within = torch.optim.Adam([gain], lr=0.01), Within()
        for _ in range(500):
            ours = gain * (self.truth + self.noise)
            differences = (from_own_mean(v, self.weight, self.person) for v in (ours, self.truth))
            optimiser.zero_grad()
            within.loss(*differences, self.weight).sum().backward()
            optimiser.step()
        self.assertTrue(torch.allclose(gain.detach(), torch.tensor(0.5).sqrt(), atol=0.03), gain)

    def test_faces_without_weight_do_not_count(self):
        weight, ours = self.weight.clone(), self.truth.clone()
        weight[::3], ours[::3] = 0, 9
        self.assertLess(self.loss(ours, weight).abs().max(), 1e-3)

    def test_people_with_a_single_face_teach_nothing(self):
        alone = torch.arange(2000)
        ours = (0.1 * self.truth).requires_grad_()
        differences = (from_own_mean(v, self.weight, alone) for v in (ours, self.truth))
        Within().loss(*differences, self.weight).sum().backward()
        self.assertLess(ours.grad.abs().max(), 1e-6)


if __name__ == "__main__":
    unittest.main()
