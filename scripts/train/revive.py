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


def of_units(encoder):
    """What each unit of the tail has of its own: (tensor, axis of the units)."""
    expand, depthwise, project = encoder.tail
    for layer in (*expand, *depthwise):
        for tensor in (*layer.parameters(), *layer.buffers()):
            if tensor.dim():
                yield tensor, 0
    yield project.weight, 1


@torch.no_grad()
def revive(encoder, on, generator, optimizer, average):
    """Dormant units start anew, in the running average of the encoder, too: random incoming weights, outgoing ones at zero so that no
    answer changes, and a gain as others have. Returns their number.

    174 of 672 revived at once with a gain of 1, where others had 0.05, and with moments that had decayed, took BaseNet's landmark error on
    validation portraits from 0.067 to 0.32.
    """
    dormant = torch.nonzero(on < DORMANT)[:, 0]
    if not len(dormant):
        return 0
    expand, depthwise, project = encoder.tail
    for convolution, norm in (expand, depthwise):
        fresh = torch.randn(convolution.weight[dormant].shape, generator=generator).to(convolution.weight.device)
        size = convolution.weight.flatten(1).norm(dim=1).median()
        convolution.weight[dormant] = fresh * (size / fresh.flatten(1).norm(dim=1)).view(-1, 1, 1, 1)
        norm.weight[dormant], norm.bias[dormant] = norm.weight[on >= DORMANT].abs().median(), 0.0
    project.weight[:, dormant] = 0.0
    for (tensor, axis), (averaged, _) in zip(of_units(encoder), of_units(average)):
        optimizer.begin_anew(tensor, dormant, axis)
        averaged.transpose(0, axis)[dormant] = tensor.transpose(0, axis)[dormant]
    on[dormant] = 1.0
    return len(dormant)


def self_test():
    import copy
    from networks import BaseNet
    from optimizer import Optimizer
    torch.manual_seed(1)
    network = BaseNet().train()
    encoder, optimizer = network.encoder, Optimizer(network, 1e-3)
    encoder.tail[1][1].bias.data[:7] = -50.0
    activity, images = Activity(encoder, decay=0.0), torch.randn(64, 3, 65, 65)

    def step():
        optimizer.zero_grad(), (encoder(images) * torch.randn(64, 256)).sum().backward(), optimizer.step()
    for _ in range(5):
        step()
    for state in optimizer.rest.state.values():
        # As late in training, when nothing makes up for small moments any more.
        state["exp_avg_sq"].div_(1 - 0.999 ** int(state["step"])), state["step"].fill_(100000)
    average = copy.deepcopy(encoder)
    before = encoder(images)
    assert (activity.on[:7] == 0).all()
    assert revive(encoder, activity.on, torch.Generator().manual_seed(2), optimizer, average) == 7
    assert all(torch.equal(mine.transpose(0, axis)[:7], theirs.transpose(0, axis)[:7])
               for (mine, axis), (theirs, _) in zip(of_units(encoder), of_units(average)))
    assert torch.allclose(before, encoder(images), atol=1e-4) and (activity.on[:7] > 0.1).all()
    outgoing = encoder.tail[2].weight
    step()
    assert 0 < outgoing[:, :7].abs().max() <= 1e-3, "no step is longer than the rate"


if __name__ == "__main__":
    self_test()
