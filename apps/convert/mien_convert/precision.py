"""Keeps layers precise if fp16 is too coarse for their weights: splits such a layer into one with rounded weights, one
with the rounding errors, and a sum.

An evaluation on random inputs shows whether the outputs differ by more than ALLOWED. If so, layers are split in the
order of benefit per cost, until the difference is below AIM.
"""
import numpy as np

from .evaluation import TENSORS, exact, in_two_parts, rounded, tensors_of, value_of
from .layers import WEIGHTED, Layer
from .weight_file import MAX_LAYERS

ALLOWED, AIM = 5e-4, 2.5e-4  # of an output's largest value; other inputs differ by a factor of two or three
SMALL = 1e-3  # minimum of the largest value of an output, to which errors are relative
INPUTS, STEPS = 2, 16  # of the evaluation; the latter of a stream
MAX_NUMBERS = 1 << 26  # of all layers at once: 256 MB, and as much for those compared
MAX_WORK = 5 * 10 ** 10  # multiplications of an evaluation, and of the measurement of the order: some ten seconds each


class Precision:
    """errors: estimated, of the largest value, with all weights rounded and with `kept` layers precise. None where
    nothing was estimated."""

    def __init__(self, before=None, after=None, kept=(), too_large=False):
        self.before, self.after, self.kept, self.too_large = before, after, list(kept), too_large
        self.more_bytes = 2 * sum(np.size(tensor) for layer in self.kept for tensor in tensors_of(layer))
        self.more_work = sum(map(work, self.kept))


def kept_precise(network, is_stream, allowed):
    """Splits layers of a network where `allowed`; returns a report."""
    search = Search(network, is_stream)
    if not search.coarse:
        return Precision()
    if not search.has_room():
        return Precision(too_large=True)
    with np.errstate(all="ignore"):
        precision = search.found(allowed)
    for layer in precision.kept:
        split(layer)
    network.sort()
    return precision


class Search:
    def __init__(self, network, is_stream):
        self.network, self.layers = network, network.layers
        self.coarse = [layer for layer in self.layers if is_coarse(layer)]
        self.is_stream, self.count = is_stream, STEPS if is_stream else INPUTS

    def has_room(self):
        numbers = sum(layer.size for layer in [self.network.source, *self.layers])
        self.count = min(self.count, MAX_NUMBERS // numbers)
        return self.count > 0 and self.count * sum(map(work, self.layers)) <= MAX_WORK

    def found(self, allowed):
        source = self.network.source
        x = np.random.default_rng(7).standard_normal((self.count, *source.shape)).astype(np.float32)
        self.values = {id(source): x}
        for layer in self.layers:
            self.values[id(layer)] = value_of(layer, [self.values[id(x)] for x in layer.inputs], exact, exact)
        before = self.error(self.coarse, ())
        if not allowed or not before > ALLOWED:
            return Precision(before, before)
        candidates = [layer for layer in self.coarse if layer.op in WEIGHTED and not layer.input_bound]
        candidates = self.ordered(candidates)[:(MAX_LAYERS - len(self.layers)) // 3]
        after = self.error(self.coarse, candidates)
        least, most = 0, len(candidates)
        while most - least > 1 and after <= AIM:
            middle = (least + most) // 2
            error = self.error(self.coarse, candidates[:middle])
            least, most, after = (least, middle, error) if error <= AIM else (middle, most, after)
        return Precision(before, after, candidates[:most])

    def ordered(self, candidates):
        """Layers without which the error is large come first, then the others by benefit and cost. If that takes too
        long to measure, the cheapest come first."""
        if len(candidates) / 2 * sum(map(work, self.layers)) > MAX_WORK:
            return sorted(candidates, key=work)
        one = slice(None) if self.is_stream else slice(1)
        errors = {id(layer): self.error([layer], (), one) for layer in candidates}
        return sorted(candidates,
                      key=lambda layer: (errors[id(layer)] <= AIM / 2, -errors[id(layer)] ** 2 / work(layer)))

    def error(self, coarse, precise, taken=slice(None)):
        """Error of the outputs for sample inputs if `coarse` layers have rounded weights, except those that are kept
        `precise`."""
        weights_as = {id(layer): rounded for layer in coarse} | {id(layer): in_two_parts for layer in precise}
        slopes_as = {id(layer): rounded for layer in coarse}
        values = {}
        for layer in self.layers:
            if id(layer) in weights_as or any(id(x) in values for x in layer.inputs):
                inputs = [values[id(x)] if id(x) in values else self.values[id(x)][taken] for x in layer.inputs]
                values[id(layer)] = value_of(layer, inputs, weights_as.get(id(layer), exact),
                                             slopes_as.get(id(layer), exact))
        return max(difference(values[id(y)], self.values[id(y)][taken]) for y in self.network.outputs
                   if id(y) in values)


def is_coarse(layer):
    """Whether fp16 cannot represent its weights exactly."""
    with np.errstate(over="ignore"):
        return any((rounded(numbers) != exact(numbers)).any() for numbers in tensors_of(layer))


def difference(got, wanted):
    return float(np.abs(got - wanted).max() / max(np.abs(wanted).max(), SMALL))


def work(layer):
    """Multiplications of a run."""
    weight = layer.options.get("weight")
    pixels = layer.shape[0] * layer.shape[1]
    return pixels * weight.size if weight is not None else layer.size


def split(layer):
    """Splits it into a layer with rounded weights and one with the rest, their sum, and the activation."""
    parts = []
    for take in (rounded, lambda tensor: tensor - rounded(tensor)):
        options = {name: take(value) if name in TENSORS else value for name, value in layer.options.items()}
        parts.append(Layer(layer.op, layer.inputs, layer.shape, layer.node, **options))
    layer.options, layer.inputs, layer.op = {}, parts, "add"
    if layer.activation:
        layer.inputs, layer.op = [Layer("add", parts, layer.shape, layer.node)], "activation"
