"""Chooses the layers that may compute with 8-bit integers, from sample inputs.

These are the pointwise layers of inverted residual blocks. The bound of a layer's inputs (docs/format.md) is the one
with the least mean square error of rounding and saturation. If the outputs then differ too much, layers get 16 bits,
those with the largest error per multiplication first.
"""
from pathlib import Path

import numpy as np

from .errors import require
from .evaluation import exact, value_of
from .precision import MAX_NUMBERS, MAX_WORK, SMALL, work

LARGEST, LARGEST_NOT_NEGATIVE = 127, 255  # 8-bit integers
BOUNDED = ("relu6", "clamp01")            # activations of the depthwise layer of a block
VALUES = 1 << 13                          # of each sample, that determine a bound
MIN_VALUE = 2.0 ** -64                    # of a bound


class Int8:
    """What was chosen: layers, candidates, their share of the multiplications, and the error of the outputs."""

    def __init__(self, layers, candidates, total_work, error):
        self.layers, self.candidates, self.error = layers, candidates, error
        self.share = sum(map(work, layers)) / max(total_work, 1)


def read_samples(folder, shape):
    """The inputs in a folder's .npy files, [n, h, w, c]. Their last axes are those of `mien run --input`."""
    require(Path(folder).is_dir(), f"--int8: no folder {folder}")
    paths = sorted(Path(folder).glob("*.npy"))
    require(paths, f"--int8: no .npy file in {folder}")
    return np.concatenate([read_sample(path, shape) for path in paths])


def read_sample(path, shape):
    h, w, c = shape
    try:
        values = np.load(path, allow_pickle=False)
    except (ValueError, OSError, EOFError) as error:
        raise ValueError(f"{path}: {error}") from error
    last = (c,) if h == w == 1 and values.shape[-3:] != (c, 1, 1) else (c, h, w)
    require(values.dtype.kind == "f" and values.shape[-len(last):] == last,
            f"{path}: shape {values.shape} of {values.dtype} (expected [...,]{','.join(map(str, last))} of float32)")
    require(np.isfinite(values).all(), f"{path}: values that are not finite")
    return values.astype(np.float32).reshape(-1, c, h, w).transpose(0, 2, 3, 1)


def choose_int8(network, samples, allowed):
    """Sets the input bounds of the chosen layers. `allowed`: root mean square difference of an output, relative to its
    standard deviation."""
    candidates = blocks_of(network)
    total = sum(map(work, network.layers))
    if not candidates:
        return Int8([], [], total, 0.0)
    search = Search(network, samples[spread(len(samples), room(network, candidates, total))], candidates)
    chosen, error = search.choose(allowed)
    for layer in chosen:
        layer.input_bound = search.bounds[id(layer)]
    return Int8(chosen, candidates, total, error)


def blocks_of(network):
    """The expand and project layers of inverted residual blocks."""
    found = []
    for layer in network.layers:
        before = layer.inputs[0]
        in_block = before.op == "depthwise" and before.activation.get("activation") in BOUNDED and network.alone(before)
        if layer.is_pointwise(network.source) and in_block:
            expand = before.inputs[0]
            found += [expand] if expand.is_pointwise(network.source) and network.alone(expand) else []
            found.append(layer)
    return found


def room(network, candidates, total):
    """How many samples an evaluation may have."""
    numbers = sum(layer.size for layer in [network.source, *network.layers])
    return max(1, min(MAX_NUMBERS // numbers, 10 * MAX_WORK // (total * 2 * len(candidates))))


def spread(available, count):
    return np.unique(np.linspace(0, available - 1, min(count, available)).astype(int))


class Search:
    def __init__(self, network, samples, candidates):
        self.network, self.candidates = network, candidates
        self.values = {id(network.source): samples}
        for layer in network.layers:
            self.values[id(layer)] = value_of(layer, self.inputs(layer, {}), exact, exact)
        self.bounds = {id(layer): self.bound(layer) for layer in candidates}

    def inputs(self, layer, changed):
        return [changed.get(id(x), self.values[id(x)]) for x in layer.inputs]

    def bound(self, layer):
        flat = self.values[id(layer.inputs[0])].ravel()
        count = min(len(flat), VALUES * len(self.values[id(layer)]))
        some = np.random.default_rng(7).choice(flat, count, replace=False)
        largest = max(float(np.abs(flat).max()), MIN_VALUE)
        return min(largest * np.linspace(0.3, 1, 29),
                   key=lambda bound: np.square(rounded_inputs(layer, some, bound) - some).sum())

    def choose(self, allowed):
        errors = {id(layer): self.error([layer]) for layer in self.candidates}
        chosen = sorted(self.candidates, key=lambda layer: errors[id(layer)] ** 2 / work(layer))
        error = self.error(chosen)
        while error > allowed:
            chosen.pop()
            error = self.error(chosen)
        return chosen, error

    def error(self, layers):
        """The error of the outputs if these layers compute with 8 bits."""
        in_8_bits, changed = {id(layer) for layer in layers}, {}
        for layer in self.network.layers:
            if id(layer) in in_8_bits:
                x = rounded_inputs(layer, self.inputs(layer, changed)[0], self.bounds[id(layer)])
                changed[id(layer)] = value_of(layer, [x], rounded_weights, exact)
            elif any(id(x) in changed for x in layer.inputs):
                changed[id(layer)] = value_of(layer, self.inputs(layer, changed), exact, exact)
        return max((relative(changed[id(y)], self.values[id(y)]) for y in self.network.outputs if id(y) in changed),
                   default=0.0)


def rounded_inputs(layer, x, bound):
    not_negative = layer.inputs[0].op == "depthwise"
    low, high = (0, LARGEST_NOT_NEGATIVE) if not_negative else (-LARGEST, LARGEST)
    return np.clip(np.rint(x * (high / bound)), low, high).astype(np.float32) * np.float32(bound / high)


def rounded_weights(tensor):
    """The weights of each output in multiples of 1/127 of the largest; the bias as it is."""
    if tensor.ndim == 1:
        return exact(tensor)
    scale = np.maximum(np.abs(tensor).max((1, 2, 3), keepdims=True), 1e-20) / LARGEST
    return exact(np.rint(tensor / scale) * scale)


def relative(got, wanted):
    difference = np.sqrt(np.mean(np.square(got - wanted, dtype=np.float64)))
    return float(difference / max(wanted.std(), SMALL * np.abs(wanted).max(), 1e-20))
