"""The networks, their layers for training on CPUs, and the optimizer."""
import copy
import unittest

import torch
import torch.nn.functional as F
from torch import nn

from mien_training.networks.architectures import (
    FEATURES,
    BaseNet,
    BaseNetEncoder,
    ControlsDecoder,
    HiFiNetEncoder,
    PNet,
    folded,
)
from mien_training.networks.native_layers.depthwise_unit import depthwise_unit
from mien_training.networks.native_layers.expanded_unit import expanded_unit
from mien_training.networks.native_layers.norm_activation import NormActivation
from mien_training.phase1.dormant_units import Activity, of_units, reset_dormant
from mien_training.phase1.optimizer import Optimizer, orthogonal


def cost(network, *shape):
    """Parameters after folding batch norm, and multiply-accumulates of the convolutions."""
    macs, parameters, hooks = [0], [0], []

    def count(module, _, output):
        positions = output.shape[2] * output.shape[3]
        macs[0] += module.weight.numel() * positions
        parameters[0] += module.weight.numel() + module.out_channels

    for module in network.modules():
        if isinstance(module, nn.Conv2d):
            hooks.append(module.register_forward_hook(count))
    network.eval()(torch.zeros(1, *shape))
    for hook in hooks:
        hook.remove()
    return parameters[0], macs[0]


def check_gradients(encoder, shape):
    """The layers of training against PyTorch's own, which serve where maps are fp64."""
    twin, x = copy.deepcopy(encoder).double(), torch.randn(3, *shape)
    slope = torch.randn(3, FEATURES)
    (encoder(x) * slope).sum().backward()
    (twin.tail(twin.body(x.double())).flatten(1) * slope).sum().backward()
    whole = torch.cat([p.grad.flatten() for p in twin.parameters()]).norm()
    for (name, mine), theirs in zip(encoder.named_parameters(), twin.parameters()):
        # before a norm, a bias has none
        off = float((mine.grad - theirs.grad).norm() / (theirs.grad.norm() + 0.01 * whole))
        assert off < 3e-2, (name, off)


class Architectures(unittest.TestCase):
    def test_cost_streaming_and_gradients(self):
        parameters, macs = cost(BaseNetEncoder(), 3, 65, 65)
        assert parameters == 528656, parameters
        assert abs(macs / 5.22e6 - 1) < 0.01, macs
        parameters, macs = cost(HiFiNetEncoder(), 3, 129, 109)
        assert parameters == 969400, parameters
        assert abs(macs / 25.25e6 - 1) < 0.01, macs
        encoder, x = HiFiNetEncoder(), torch.randn(4, 3, 129, 109)
        encoder(x)
        encoder.eval()
        assert torch.allclose(encoder(x), folded(encoder)(x), atol=1e-4)
        torch.manual_seed(1)
        check_gradients(HiFiNetEncoder(), (3, 129, 109))
        check_gradients(BaseNetEncoder(), (3, 65, 65))
        decoder, x = ControlsDecoder().eval(), torch.randn(2, 9, FEATURES)
        whole, state, parts = decoder(x)[0], None, []
        for t in range(9):
            y, state = decoder(x[:, t:t + 1], state)
            parts.append(y)
        assert torch.allclose(whole, torch.cat(parts, 1), atol=1e-5)
        assert PNet()(torch.zeros(1, 3, 12, 12))[0].shape == (1, 1, 1, 1)


class NormActivationTest(unittest.TestCase):
    def test_output_and_gradients_match_pytorch(self):
        """Answers, gradients and statistics against those of PyTorch's own layers in fp64."""
        torch.manual_seed(1)
        for dtype, tolerance in ((torch.float32, 1e-4), (torch.bfloat16, 1e-2)):
            for shape in ((48, 40, 13, 11), (7, 96, 1, 1), (3, 5, 4, 9)):
                for activation in (True, False):
                    layer = NormActivation(shape[1], activation).train()
                    nn.init.uniform_(layer.weight, 0.5, 1.5)
                    nn.init.normal_(layer.bias)
                    twin = nn.BatchNorm2d(shape[1]).double().train()
                    twin.load_state_dict(layer.state_dict())
                    x = (torch.randn(shape) * 2 + 3).to(dtype).requires_grad_()
                    exact = x.detach().double().requires_grad_()
                    y, truth = layer(x), twin(exact)
                    truth = F.relu6(truth) if activation else truth
                    slope = torch.randn(shape).to(dtype)
                    (y * slope).sum().backward()
                    (truth * slope).sum().backward()
                    pairs = [(y, truth), (x.grad, exact.grad), (layer.weight.grad, twin.weight.grad), (layer.bias.grad,
                                                                                                       twin.bias.grad),
                             (layer.running_mean, twin.running_mean), (layer.running_var, twin.running_var)]
                    for mine, theirs in pairs:
                        assert float((mine.detach() - theirs.detach()).abs().max()) < tolerance * (
                            1 + float(theirs.abs().max())), (shape, activation)
                    assert layer.num_batches_tracked == 1
                    layer.eval()
                    twin.eval()
                    if dtype == torch.float32:
                        assert torch.allclose(layer(x).double(), F.relu6(twin(exact)) if activation else twin(exact),
                                              atol=1e-4)


class DepthwiseUnit(unittest.TestCase):
    def test_output_and_gradients_match_pytorch(self):
        """Answers, gradients and statistics against those of PyTorch's own layers in fp64."""
        torch.manual_seed(1)
        for dtype, tolerance in ((torch.float32, 1e-4), (torch.bfloat16, 6e-2)):
            for channels, h, w, stride, padding, expanded in ((40, 13, 11, 1, 0, True), (64, 12, 9, 2, 0,
                                                                                         True), (24, 5, 4, 1, 1, True),
                                                              (16, 7, 6, 2, 1, True), (16, 9, 8, 1, 0, False)):
                first = NormActivation(channels, True) if expanded else None
                layers = [first, nn.Conv2d(channels, channels, 3, stride, padding, groups=channels, bias=False),
                          NormActivation(channels, True)]
                for layer in (layers[0], layers[2]):
                    if layer is not None:
                        nn.init.uniform_(layer.weight, 0.5, 1.5)
                        nn.init.uniform_(layer.bias, 0.5, 2)
                twin = [nn.BatchNorm2d(channels).double() if isinstance(m, nn.BatchNorm2d) else m and nn.Conv2d(
                    channels, channels, 3, stride, padding, groups=channels, bias=False).double() for m in layers]
                for mine, theirs in zip(layers, twin):
                    if mine is not None:
                        theirs.load_state_dict(mine.state_dict())
                x = torch.randn(6, channels, h, w).to(dtype).requires_grad_()
                exact = x.detach().double().requires_grad_()
                y = depthwise_unit(x, *layers)
                seen = F.relu6(twin[0](exact)) if expanded else exact
                truth = F.relu6(twin[2](twin[1](seen)))
                slope = torch.randn(truth.shape).to(dtype)
                (y * slope).sum().backward()
                (truth * slope).sum().backward()
                pairs = [(y, truth), (x.grad, exact.grad)]
                for mine, theirs in zip(layers, twin):
                    if mine is not None:
                        pairs += zip((p.grad for p in mine.parameters()), (p.grad for p in theirs.parameters()))
                        pairs += [(a, b) for a, b in zip(mine.buffers(), theirs.buffers())]
                for mine, theirs in pairs:
                    off = float((mine.detach().double() - theirs.detach()).norm() / theirs.double().norm().clamp(min=1))
                    assert off < tolerance, (dtype, channels, stride, padding, off)


class ExpandedUnit(unittest.TestCase):
    def test_output_and_gradients_match_pytorch(self):
        """Answers, gradients and statistics against those of PyTorch's own layers in fp64."""
        torch.manual_seed(1)
        for dtype, tolerance in ((torch.float32, 2e-4), (torch.bfloat16, 6e-2)):
            for narrow, channels, h, w, stride, padding in ((16, 32, 13, 11, 1, 0), (24, 96, 12, 9, 2, 0),
                                                            (40, 120, 5, 5, 1, 1), (16, 40, 7, 6, 2, 1)):
                convolution = lambda: nn.Conv2d(channels, channels, 3, stride, padding, groups=channels, bias=False)
                layers = nn.Sequential(nn.Conv2d(narrow, channels, 1, bias=False), NormActivation(channels, True),
                                       convolution(), NormActivation(channels, True)).train()
                for layer in (layers[1], layers[3]):
                    nn.init.uniform_(layer.weight, 0.5, 1.5)
                    nn.init.uniform_(layer.bias, 0.5, 2)
                layers[0].weight.data = layers[0].weight.data.to(dtype).float()
                twin = nn.Sequential(nn.Conv2d(narrow, channels, 1, bias=False), nn.BatchNorm2d(channels),
                                     convolution(), nn.BatchNorm2d(channels)).double().train()
                twin.load_state_dict(layers.state_dict())
                x = (torch.randn(6, narrow, h, w) + 0.5).to(dtype).requires_grad_()
                exact = x.detach().double().requires_grad_()
                y = expanded_unit(x, *layers)
                truth = F.relu6(twin[3](twin[2](F.relu6(twin[1](twin[0](exact))))))
                slope = torch.randn(truth.shape).to(dtype)
                (y * slope).sum().backward()
                (truth * slope).sum().backward()
                pairs = [(y, truth), (x.grad, exact.grad), *zip(layers.buffers(), twin.buffers()),
                         *zip((p.grad for p in layers.parameters()), (p.grad for p in twin.parameters()))]
                for mine, theirs in pairs:
                    off = float((mine.detach().double() - theirs.detach()).norm()
                                / theirs.detach().double().norm().clamp(min=1))
                    assert off < tolerance, (dtype, narrow, channels, stride, padding, off)


class OptimizerTest(unittest.TestCase):
    def test_directions_are_orthogonal(self):
        """Directions: the singular vectors of the matrices with values near 1, also where only a few are not 0."""
        torch.manual_seed(1)
        for shape in ((2, 24, 96), (3, 96, 24), (1, 16, 16)):
            matrices = torch.randn(shape)
            u, _, vt = torch.linalg.svd(matrices, full_matrices=False)
            cosines = torch.einsum("nik,nij,njk->nk", u, orthogonal(matrices), vt.transpose(1, 2))
            assert cosines.min() > 0.3 and cosines.max() < 1.25, (shape, cosines.min(), cosines.max())
            assert torch.linalg.svdvals(orthogonal(matrices)).max() < 1.25, shape
        thin = torch.randn(1, 96, 2) @ torch.randn(1, 2, 24)
        values = torch.linalg.svdvals(orthogonal(thin))[0]
        assert values[1] > 0.6 and values[2] < 0.05, values[:3]


class DormantUnits(unittest.TestCase):
    def test_reset_keeps_the_output(self):

        torch.manual_seed(1)
        network = BaseNet().train()
        encoder, optimizer = network.encoder, Optimizer(network, 1e-3)
        encoder.tail[1][1].bias.data[:7] = -50.0
        activity, images = Activity(encoder, decay=0.0), torch.randn(64, 3, 65, 65)

        def step():
            optimizer.zero_grad()
            (encoder(images) * torch.randn(64, 256)).sum().backward()
            optimizer.step()
        for _ in range(5):
            step()
        for state in optimizer.rest.state.values():
            # As late in training, when the bias correction no longer compensates for small moments.
            state["exp_avg_sq"].div_(1 - 0.999 ** int(state["step"]))
            state["step"].fill_(100000)
        average = copy.deepcopy(encoder)
        before = encoder(images)
        assert (activity.on[:7] == 0).all()
        assert reset_dormant(encoder, activity.on, torch.Generator().manual_seed(2), optimizer, average) == 7
        assert all(torch.equal(mine.transpose(0, axis)[:7], theirs.transpose(0, axis)[:7])
                   for (mine, axis), (theirs, _) in zip(of_units(encoder), of_units(average)))
        assert torch.allclose(before, encoder(images), atol=1e-4) and (activity.on[:7] > 0.1).all()
        outgoing = encoder.tail[2].weight
        step()
        assert 0 < outgoing[:, :7].abs().max() <= 1e-3, "no step is longer than the rate"


if __name__ == "__main__":
    unittest.main()
