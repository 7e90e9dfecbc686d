"""Layers of the engine while a network is converted, and the passes that make them few before they are written.

A layer's value is a map (h, w, c); weights are numpy arrays in PyTorch's layout. `affine` is scale * x + shift per
channel: not an operation of the format, it is folded into the previous layer or becomes a 1x1 depthwise convolution.
"""

import numpy as np

from .errors import Refused, require
from .weight_file import CURVES

WEIGHTED = ("conv2d", "depthwise", "fully_connected", "causal_conv")  # and an activation may follow


class Layer:
    def __init__(self, op, inputs, shape, node="", **options):
        self.op, self.inputs, self.shape, self.node, self.options = op, list(inputs), tuple(shape), node, options
        self.activation = {}  # keywords of mien_file's layers
        self.input_bound = 0.0  # of a pointwise layer that may compute with 8 bits
        self.number = -1      # of the value, while it is translated

    @property
    def size(self):
        h, w, c = self.shape
        return h * w * c

    def is_pointwise(self, source):
        """Whether it is written as one: an image of few channels has a convolution of its own."""
        if self.op != "conv2d" or self.inputs[0] is source and source.is_image():
            return False
        o = self.options
        return o["weight"].shape[2:] == (1, 1) and o["stride"] == (1, 1) and not any(o["padding"])

    def is_image(self):
        h, w, c = self.shape
        return c <= 4 and h * w > 1

    def is_plain(self):
        """Whether linear operations can be folded into its weights."""
        return self.op in WEIGHTED and not self.activation


def window_count(size, kernel, stride, before, after):
    return (before + size + after - kernel) // stride + 1


def slid(shape, kernel, stride, padding, channels):
    h = window_count(shape[0], kernel[0], stride[0], padding[0], padding[2])
    w = window_count(shape[1], kernel[1], stride[1], padding[1], padding[3])
    require(h > 0 and w > 0, f"a window of {kernel} does not fit on a map of {shape[:2]}")
    return h, w, channels


def identity_conv(x):
    """The same map as a separate layer, for layers that cannot read an interleaved image."""
    c = x.shape[2]
    return Layer("conv2d", [x], x.shape, x.node, weight=np.eye(c).reshape(c, c, 1, 1), bias=np.zeros(c), stride=(1, 1),
                 padding=(0, 0, 0, 0))


class Network:
    """The layers that outputs need, in order; passes transform it."""

    def __init__(self, source, outputs):
        self.source, self.outputs = source, list(outputs)
        self.sort()
        for change in (self.merge_affines, self.fuse_curves, self.merge_affines, self.fold_affine_back,
                       self.merge_activations, self.fuse_activations, self.affine_to_depthwise, self.centre_slices,
                       self.merge_rearrangements, self.unpack_image):
            change()
            self.sort()

    def sort(self):
        """Orders layers after their inputs, and removes layers without readers."""
        self.layers, done = [], {id(self.source)}
        pending = list(reversed(self.outputs))
        while pending:
            layer = pending[-1]
            missing = [x for x in layer.inputs if id(x) not in done]
            if id(layer) in done or not missing:
                pending.pop()
                if id(layer) not in done:
                    done.add(id(layer))
                    self.layers.append(layer)
            else:
                pending += reversed(missing)
        self.readers = {}
        for layer in self.layers:
            for x in layer.inputs:
                self.readers.setdefault(id(x), []).append(layer)

    def alone(self, layer):
        """Only one layer reads it, and no user of the network."""
        return len(self.readers.get(id(layer), [])) == 1 and all(layer is not x for x in self.outputs)

    def replace(self, old, new):
        for layer in self.layers:
            layer.inputs = [new if x is old else x for x in layer.inputs]
        self.outputs = [new if x is old else x for x in self.outputs]

    def merge_affines(self):
        """Merges consecutive affine layers, and removes those that change nothing."""
        for layer in list(self.layers):
            if layer.op != "affine":
                continue
            before, o = layer.inputs[0], layer.options
            if before.op == "affine" and not before.activation and self.alone(before):
                layer.inputs = list(before.inputs)
                layer.options = {"scale": before.options["scale"] * o["scale"],
                                 "shift": before.options["shift"] * o["scale"] + o["shift"]}
            if is_uniform(layer, 1.0, 0.0) and layer.inputs[0] is not self.source:
                self.replace(layer, layer.inputs[0])
            self.sort()

    def fuse_curves(self):
        """Merges activations that exporters write as several operators: x sigmoid(x), x relu6(x + 3), x (1 + erf(x /
        sqrt 2))."""
        for layer in list(self.layers):
            if layer.op != "multiply" or layer.inputs[0].shape != layer.inputs[1].shape:
                continue
            for x, gate in (layer.inputs, layer.inputs[::-1]):
                found = curve_of(x, gate) if self.alone(gate) else None
                if found:
                    x, kind, scale = found
                    curve = Layer("activation", [x], x.shape, layer.node)
                    curve.activation = {"activation": kind}
                    layer.op, layer.inputs = "affine", [curve]
                    layer.options = {"scale": np.full(x.shape[2], scale), "shift": np.zeros(x.shape[2])}
                    self.sort()
                    break

    def fold_affine_back(self):
        for layer in list(self.layers):
            if layer.op != "affine":
                continue
            before = layer.inputs[0]
            if before.is_plain() and self.alone(before):
                scale, shift = layer.options["scale"], layer.options["shift"]
                weight = before.options["weight"]
                before.options["weight"] = weight * scale.reshape(-1, *[1] * (weight.ndim - 1))
                before.options["bias"] = before.options["bias"] * scale + shift
                self.replace(layer, before)
                self.sort()

    def merge_activations(self):
        """Removes a ReLU before a clamp at 0."""
        for layer in list(self.layers):
            before = layer.inputs[0]
            if layer.activation.get("activation") in ("relu", "relu6", "clamp01") and before.op == "activation" \
                    and before.activation["activation"] == "relu":
                layer.inputs[0] = before.inputs[0]
        self.sort()

    def fuse_activations(self):
        for layer in list(self.layers):
            before = layer.inputs[0]
            if layer.op == "activation" and layer.activation["activation"] not in CURVES and (
                before.is_plain() or before.op == "affine" and not before.activation) and self.alone(before):
                before.activation = layer.activation
                self.replace(layer, before)
                self.sort()

    def affine_to_depthwise(self):
        for layer in self.layers:
            if layer.op == "affine":
                c = layer.shape[2]
                layer.op = "depthwise"
                layer.options = {"weight": layer.options["scale"].reshape(c, 1, 1, 1), "bias": layer.options["shift"],
                                 "stride": (1, 1), "padding": (0, 0, 0, 0)}

    def centre_slices(self):
        """An addition takes the centre slice by itself."""
        for layer in self.layers:
            if layer.op == "add":
                if is_centre_slice(layer.inputs[0]) and not is_centre_slice(layer.inputs[1]):
                    layer.inputs.reverse()
                if is_centre_slice(layer.inputs[1]):
                    layer.inputs[1] = layer.inputs[1].inputs[0]

    def merge_rearrangements(self):
        """Merges consecutive rearrangements."""
        for layer in list(self.layers):
            before = layer.inputs[0]
            if layer.op == before.op == "rearrange" and layer.options["order"] == "hwc" and self.alone(before):
                layer.inputs, layer.options = list(before.inputs), before.options
                self.sort()

    def unpack_image(self):
        h, w, c = self.source.shape
        needing = [layer for layer in self.layers
                   if any(x is self.source for x in layer.inputs) and layer.op != "conv2d"]
        if c > 4 or h * w == 1 or not needing:
            return
        unpacked = identity_conv(self.source)
        for layer in needing:
            layer.inputs = [unpacked if x is self.source else x for x in layer.inputs]

    def write(self, net):
        """Adds the layers to a network of mien_file."""
        numbers = {id(self.source): net.input}
        for layer in self.layers:
            try:
                numbers[id(layer)] = write_layer(net, layer, [numbers[id(x)] for x in layer.inputs], self.source)
            except ValueError as error:
                raise Refused(f"{layer.node}: {error}") from error
        for output in self.outputs:
            net.output(numbers[id(output)])


def is_uniform(layer, scale, shift):
    """Whether an affine layer has the same scale and shift for all channels, these."""
    return layer.op == "affine" and not layer.activation and np.allclose(layer.options["scale"], scale, rtol=1e-5,
                                                                         atol=0) \
        and np.allclose(layer.options["shift"], shift, rtol=1e-5, atol=0)


def activated_by(layer, kind):
    """The input of an activation layer; None for another layer."""
    return layer.inputs[0] if layer.op == "activation" and layer.activation == {"activation": kind} else None


def curve_of(x, gate):
    """(its input, the curve, a factor) if x times the gate is one."""
    if activated_by(gate, "sigmoid") is x:
        return x, "swish", 1.0
    for kind, scale, shift, factor in (("relu6", 1.0, 3.0, 6.0), ("clamp01", 1 / 6, 0.5, 1.0)):
        inner = activated_by(gate, kind)
        if inner is not None and is_uniform(inner, scale, shift) and inner.inputs[0] is x:
            return x, "hard_swish", factor
        whole = gate.inputs[0] if gate.op == "affine" else None
        inner = activated_by(whole, kind) if whole is not None else None
        if inner is not None and is_uniform(inner, scale, shift) and inner.inputs[0] is x:
            own = float(gate.options["scale"][0])
            if is_uniform(gate, own, 0.0):
                return x, "hard_swish", own * factor
    if gate.op == "affine" and is_uniform(gate, float(gate.options["scale"][0]), float(gate.options["scale"][0])):
        inner = activated_by(gate.inputs[0], "erf")
        halved = x.inputs[0] if x.op == "affine" and is_uniform(x, float(x.options["scale"][0]), 0.0) else None
        if inner is not None and is_uniform(inner, 0.5 ** 0.5, 0.0) and inner.inputs[0] in (x, halved):
            own = 2 * float(gate.options["scale"][0])
            return (x, "gelu", own) if inner.inputs[0] is x else (halved, "gelu", own * float(x.options["scale"][0]))
    return None


def is_centre_slice(layer):
    if layer.op != "slice":
        return False
    top, left, bottom, right = layer.options["padding"]
    return layer.shape[2] == layer.inputs[0].shape[2] and top == bottom and left == right


def write_layer(net, layer, x, source):
    o, activation = layer.options, layer.activation
    if layer.is_pointwise(source):
        return net.pointwise(*x, o["weight"], o["bias"], input_bound=layer.input_bound, **activation)
    if layer.op in ("conv2d", "depthwise"):
        return getattr(net, layer.op)(*x, o["weight"], o["bias"], stride=o["stride"], padding=o["padding"],
                                      **activation)
    if layer.op in ("fully_connected", "causal_conv"):
        return getattr(net, layer.op)(*x, o["weight"], o["bias"], **activation)
    if layer.op == "activation":
        kind = dict(activation)
        return net.activation(*x, kind.pop("activation"), **kind)
    if layer.op == "rearrange":
        return net.rearrange(*x, o["order"], layer.shape)
    return getattr(net, layer.op)(*x, **o)
