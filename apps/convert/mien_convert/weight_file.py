"""Writes .mien weight files (docs/format.md). With the standard library only; same bytes as formats/mien_writer.cpp.

    file = MienFile()
    net = file.network("encoder", input=(65, 65, 3))
    x = net.conv2d(net.input, weight, bias, stride=2, activation="relu6")
    net.output(net.pointwise(x, weight, bias))
    file.constant("landmark_template", points)
    file.metadata["name"] = "basenet"
    file.write("basenet.mien")

Arrays are objects with `.shape` and `.tolist()` (numpy, torch), (array('f'), shape) pairs, or nested lists, in
PyTorch's layout. Everything that the format forbids raises ValueError.
"""
import math
import re
import struct
from array import array

from .atomic_files import write_whole
from .packing import (
    FP16,
    FP32,
    MAX_DIM,
    MAX_RANK,
    Tensor,
    depthwise_tensor,
    flat_floats,
    padded_order,
    panels,
    require,
    round_up_8,
    shaped,
    vector,
)
from .xxhash64 import xxhash64

OPS = {"conv2d": 1, "depthwise": 2, "pointwise": 3, "fully_connected": 4, "causal_conv": 5, "lstm": 6, "max_pool": 7,
       "add": 8, "activation": 9, "softmax": 10, "global_average_pool": 11, "concat": 12, "slice": 13, "multiply": 14,
       "divide": 15, "broadcast_add": 16, "resize": 17, "rearrange": 18, "normalize": 19}
ACTIVATIONS = {"none": 0, "relu": 1, "relu6": 2, "leaky_relu": 3, "prelu": 4, "sigmoid": 5, "tanh": 6, "clamp01": 7}
# only in activation layers
CURVES = {"hard_swish": 8, "swish": 9, "gelu": 10, "gelu_tanh": 11, "erf": 12, "exp": 13, "sqrt": 14}
SLIDING = ("conv2d", "depthwise", "max_pool")
TWO_SIZES = ("multiply", "divide", "broadcast_add")  # the second may be smaller
# without activation
PASSIVE = ("lstm", "max_pool", "add", "softmax", "global_average_pool", "concat", "slice", *TWO_SIZES, "resize",
           "rearrange", "normalize")
# minor version of the format
SINCE = {"global_average_pool": 1, "concat": 1, "slice": 1,
         **dict.fromkeys((*TWO_SIZES, "resize", "rearrange", "normalize", *CURVES), 2)}
NO_INDEX = 0xFFFFFFFF
ANY_SIZE, CEIL_MODE = 1, 1
ALIGNMENT = 64
HEADER_BYTES = RECORD_BYTES = 64
CHECKSUM_AT = 56
MAX_NETWORKS, MAX_LAYERS, MAX_TENSORS, MAX_METADATA, MAX_OUTPUTS = 64, 1024, 4096, 256, 14
MAX_WIDE_OUTPUTS = 4  # with up to this many, they are 32-bit numbers
MAX_FACTOR = (1 << 16) - 1  # of a resize
GRIDS = ("half_pixel", "asymmetric", "align_corners")
SAMPLINGS = ("round_half_down", "round_half_up", "floor", "ceil", "bilinear")
READING_ORDERS = ("hwc", "hcw", "whc", "wch", "chw", "cwh")
MAX_TEXT_BYTES, MAX_FILE_BYTES, MAX_MAP_ELEMS = 4096, 1 << 31, 1 << 28
MAX_KERNEL, MAX_STRIDE = 15, 15
MIN_INPUT_BOUND, MAX_INPUT_BOUND = 2.0 ** -64, 2.0 ** 64
MAX_MARGIN = (1 << 16) - 1  # of a slice, and its first channel
NAME = re.compile(r"[a-z0-9_./]{1,63}")


class MienFile:
    def __init__(self):
        self.metadata = {}
        self._networks, self._constants = [], []

    def network(self, name, input, any_size=False):
        """input (h, w, c); any_size: runs on every map at least that large."""
        network = Network(_name(name), input, any_size)
        self._networks.append(network)
        return network

    def constant(self, name, values, data_type="fp32"):
        floats, shape = flat_floats(values)
        require(1 <= len(shape) <= MAX_RANK, f"constant {name}: rank {len(shape)}")
        self._constants.append((_name(name), Tensor(floats, shape, {"fp16": FP16, "fp32": FP32}[data_type])))

    def to_bytes(self):
        for names in [n.name for n in self._networks], [name for name, _ in self._constants]:
            require(len(set(names)) == len(names), f"duplicate name in {sorted(names)}")
        strings = _Strings()
        network_names = [strings.add(network.name) for network in self._networks]
        networks, layers, tensors = [], [], []
        for network, name in zip(self._networks, network_names):
            networks.append(network.record(name, len(layers)))
            layers += [layer.record(tensors) for layer in network.layers]
        names = [strings.here()] * len(tensors) + [strings.add(name) for name, _ in self._constants]
        tensors += [tensor for _, tensor in self._constants]
        metadata = [struct.pack("<4I", *strings.add(_name(key)), *strings.add(_text(value)))
                    for key, value in sorted(self.metadata.items())]
        version = max(network.version() for network in self._networks) if self._networks else 0
        return _assemble(version, networks, layers, list(zip(names, tensors)), metadata, bytes(strings.data))

    def write(self, path):
        write_whole(path, self.to_bytes())


def sealed(file):
    """The bytes of a file with a valid checksum."""
    head, body = file[:CHECKSUM_AT], file[HEADER_BYTES:]
    return head + struct.pack("<Q", xxhash64(head + bytes(8) + body)) + body


def _assemble(minor_version, networks, layers, tensors, metadata, strings):
    counts = len(networks), len(layers), len(tensors), len(metadata)
    for count, limit in zip(counts, (MAX_NETWORKS, MAX_LAYERS, MAX_TENSORS, MAX_METADATA)):
        require(count <= limit, f"{count} records, at most {limit}")
    require(networks, "no network")
    data_offset = _aligned(HEADER_BYTES + 64 * sum(counts[:3]) + 16 * len(metadata) + len(strings))
    records, data = [], bytearray()
    for name, tensor in tensors:
        records.append(tensor.record(name, data_offset + len(data)))
        data += tensor.data + bytes(-len(tensor.data) % ALIGNMENT)
    body = b"".join(networks + layers + records + metadata) + strings
    body += bytes(data_offset - HEADER_BYTES - len(body)) + data
    total = HEADER_BYTES + len(body)
    require(total <= MAX_FILE_BYTES, "file too large")
    header = struct.pack("<8s2H7I2Q", b"\x89MIEN\r\n\x1a", 1, minor_version, 0x01020304, HEADER_BYTES, *counts,
                         len(strings), total, data_offset)
    return sealed(header + bytes(8) + body)


class Network:
    """Layers in order; each function adds one and returns its value's number. bias None is a bias of zeros."""
    input = 0

    def __init__(self, name, input, any_size):
        self.name, self.any_size = name, any_size
        self.layers, self.outputs, self.shapes = [], [], [tuple(input)]
        require(len(self.shapes[0]) == 3 and all(1 <= n <= MAX_DIM for n in self.shapes[0]), f"{name}: input {input}")

    def conv2d(self, x, weight, bias=None, stride=1, padding=0, **options):
        """weight [out, in, kernel_h, kernel_w], padding (top, left, bottom, right) or one number"""
        values, (out, channels, kh, kw) = shaped(weight, 4)
        require(channels == self._shape(x)[2], f"conv2d: weight for {channels} channels")
        order = [c * kh * kw + position for position in range(kh * kw) for c in range(channels)]
        layer = _Layer("conv2d", [x], out, (kh, kw), stride, padding)
        return self._dense(layer, values, (round_up_8(out), kh, kw, channels), order, bias, options)

    def depthwise(self, x, weight, bias=None, stride=1, padding=0, **options):
        """weight [channels, 1, kernel_h, kernel_w]"""
        values, (channels, one, kh, kw) = shaped(weight, 4)
        require(one == 1 and channels == self._shape(x)[2], f"depthwise: weight for {channels} channels")
        layer = _Layer("depthwise", [x], channels, (kh, kw), stride, padding)
        return self._add(layer, [depthwise_tensor(values, channels, kh, kw), vector(bias, channels)], options)

    def pointwise(self, x, weight, bias=None, **options):
        """weight [out, in] or [out, in, 1, 1]; input_bound: of inputs that may have 8 bits"""
        values, (out, channels) = shaped(weight, 2)
        require(channels == self._shape(x)[2], f"pointwise: weight for {channels} channels")
        order = padded_order(range(channels))
        return self._dense(_Layer("pointwise", [x], out), values, (round_up_8(out), len(order)), order, bias, options)

    def fully_connected(self, x, weight, bias=None, **options):
        """weight [out, in * h * w]: inputs in the order channel, row, column, as PyTorch flattens a map"""
        values, (out, inputs) = shaped(weight, 2)
        h, w, channels = self._shape(x)
        require(inputs == h * w * channels, f"fully_connected: weight for {inputs} inputs")
        order = [c * h * w + position if c < channels else None for block in range(0, channels, 8)
                 for position in range(h * w) for c in range(block, block + 8)]
        return self._dense(_Layer("fully_connected", [x], out), values, (round_up_8(out), len(order)), order, bias,
                           options)

    def causal_conv(self, x, weight, bias=None, **options):
        """weight [out, in, 2]: the previous input first, as in Conv1d"""
        values, (out, channels, kernel) = shaped(weight, 3)
        require(kernel == 2 and self._shape(x) == (1, 1, channels), f"causal_conv: weight for {channels} inputs")
        order = padded_order(range(0, 2 * channels, 2)) + padded_order(range(1, 2 * channels, 2))
        return self._dense(_Layer("causal_conv", [x], out), values, (round_up_8(out), 2, len(order) // 2), order, bias,
                           options)

    def lstm(self, x, weight_ih, weight_hh, bias=None, **options):
        """weight_ih [4 hidden, in], weight_hh [4 hidden, hidden], gates i, f, g, o; bias [4 hidden], PyTorch's two
        added"""
        ih, (rows, n) = shaped(weight_ih, 2)
        hh, (rows_hh, hidden) = shaped(weight_hh, 2)
        require(rows == rows_hh == 4 * hidden and hidden % 8 == 0, f"lstm: hidden size {hidden}")
        require(self._shape(x) == (1, 1, n), f"lstm: weight for {n} inputs")
        values = array("f")
        for row in range(rows):
            values += ih[row * n:(row + 1) * n] + hh[row * hidden:(row + 1) * hidden]
        order = padded_order(range(n)) + list(range(n, n + hidden))
        return self._dense(_Layer("lstm", [x], hidden), values, (rows, len(order)), order, bias, options)

    def max_pool(self, x, kernel, stride=None, padding=0, ceil_mode=False, **options):
        """stride defaults to the kernel; ceil_mode as in PyTorch"""
        layer = _Layer("max_pool", [x], self._shape(x)[2], _pair(kernel), kernel if stride is None else stride, padding)
        layer.flags = CEIL_MODE if ceil_mode else 0
        return self._add(layer, [], options)

    def add(self, a, b, **options):
        """a + the centre slice of b"""
        return self._add(_Layer("add", [a, b], self._shape(a)[2]), [], options)

    def global_average_pool(self, x, **options):
        """Mean over all pixels."""
        return self._add(_Layer("global_average_pool", [x], self._shape(x)[2]), [], options)

    def concat(self, a, b, **options):
        """The channels of a, then those of b."""
        return self._add(_Layer("concat", [a, b], self._shape(a)[2] + self._shape(b)[2]), [], options)

    def slice(self, x, first_channel, channels, padding=0, **options):
        """`channels` channels from the first on, without the rows and columns of the padding (top, left, bottom, right)
        """
        layer = _Layer("slice", [x], channels, padding=padding)
        layer.first_channel = first_channel
        return self._add(layer, [], options)

    def multiply(self, a, b, **options):
        """a times b, which is as high, wide and deep as a, or 1 in any of the three."""
        return self._add(_Layer("multiply", [a, b], self._shape(a)[2]), [], options)

    def divide(self, a, b, **options):
        return self._add(_Layer("divide", [a, b], self._shape(a)[2]), [], options)

    def broadcast_add(self, a, b, **options):
        return self._add(_Layer("broadcast_add", [a, b], self._shape(a)[2]), [], options)

    def resize(self, x, height, width, grid, sampling, **options):
        """grid: one of GRIDS, sampling: one of SAMPLINGS"""
        require(grid in GRIDS and sampling in SAMPLINGS, f"resize: {grid}, {sampling}")
        h, w, channels = self._shape(x)
        layer = _Layer("resize", [x], channels, stride=(_factor(h, height), _factor(w, width)))
        layer.flags, layer.declared = GRIDS.index(grid) + 4 * SAMPLINGS.index(sampling), (height, width)
        return self._add(layer, [], options)

    def rearrange(self, x, order, shape, **options):
        """The elements of x, read in an order of READING_ORDERS (the outermost axis first), as a map (h, w, c)."""
        require(order in READING_ORDERS, f"rearrange: {order}")
        layer = _Layer("rearrange", [x], shape[2])
        layer.flags, layer.declared = READING_ORDERS.index(order), tuple(shape[:2])
        return self._add(layer, [], options)

    def normalize(self, x, epsilon, **options):
        """Mean 0 and variance 1 of the channels of each pixel."""
        return self._add(_Layer("normalize", [x], self._shape(x)[2]), [], {"alpha": epsilon, **options})

    def activation(self, x, activation, **options):
        require(activation != "none", "activation: none")
        return self._add(_Layer("activation", [x], self._shape(x)[2]), [], {"activation": activation, **options})

    def softmax(self, x, **options):
        """Over channels."""
        return self._add(_Layer("softmax", [x], self._shape(x)[2]), [], options)

    def output(self, x):
        require(1 <= x < len(self.shapes) and x not in self.outputs and len(self.outputs) < MAX_OUTPUTS,
                 f"{self.name}: output {x}")
        self.outputs.append(x)

    def record(self, name, first_layer):
        used = {x for layer in self.layers for x in layer.inputs} | set(self.outputs)
        for value in range(1, len(self.shapes)):
            require(value in used, f"{self.name}: unused output of layer {value}")
        require(self.outputs, f"{self.name}: no output")
        outputs = self.outputs
        if len(outputs) <= MAX_WIDE_OUTPUTS:
            outputs = [place for value in outputs for place in (value, 0)]
        outputs = outputs + [0] * (MAX_OUTPUTS - len(outputs))
        return struct.pack("<2I3I4I14H", *name, *self.shapes[0], ANY_SIZE if self.any_size else 0, first_layer,
                           len(self.layers), len(self.outputs), *outputs)

    def version(self):
        """The minor version of the format that it needs."""
        names = [name for layer in self.layers for name in (layer.op, layer.activation)]
        return max([SINCE.get(name, 0) for name in names] + [2 if len(self.outputs) > MAX_WIDE_OUTPUTS else 0]
                   + [3 for layer in self.layers if layer.input_bound])

    def _shape(self, x):
        require(0 <= x < len(self.shapes), f"{self.name}: no value {x}")
        return self.shapes[x]

    def _dense(self, layer, values, shape, order, bias, options):
        """`shape`: dimensions of the packed weights, outputs first. `order`: see panels."""
        outputs = 4 * layer.channels if layer.op == "lstm" else layer.channels
        return self._add(layer, [panels(values, outputs, order, shape), vector(bias, outputs)], options)

    def _add(self, layer, tensors, options):
        layer.set_activation(options)
        layer.shape = layer.output_shape([self._shape(x) for x in layer.inputs])
        layer.tensors = tensors
        one_size = layer.op in ("fully_connected", "causal_conv", "lstm",
                                "rearrange") or layer.op == "resize" and 0 in layer.stride
        require(not self.any_size or not one_size, f"{self.name}: {layer.op} in a network of any size")
        self.layers.append(layer)
        self.shapes.append(layer.shape)
        return len(self.layers)


class _Layer:
    def __init__(self, op, inputs, channels, kernel=0, stride=0, padding=0):
        self.op, self.inputs, self.channels, self.flags, self.first_channel = op, inputs, channels, 0, 0
        self.kernel, self.stride, self.padding = _pair(kernel), _pair(stride), _four(padding)
        self.declared = None  # height and width, where they do not follow from the input's

    def set_activation(self, options):
        options = dict(options)
        self.activation = options.pop("activation", "none")
        self.alpha = options.pop("alpha", 0.0)
        self.input_bound = options.pop("input_bound", 0.0)
        allowed = self.op == "pointwise" and MIN_INPUT_BOUND <= self.input_bound <= MAX_INPUT_BOUND
        require(allowed or self.input_bound == 0, f"{self.op}: input bound {self.input_bound}")
        slopes = options.pop("slopes", None)
        require(not options, f"{self.op}: unknown options {sorted(options)}")
        require(self.activation in ACTIVATIONS or self.activation in CURVES and self.op == "activation",
                 f"{self.op}: unknown activation (got {self.activation})")
        require(self.activation == "none" or self.op not in PASSIVE, f"{self.op}: takes no activation")
        has_alpha = self.activation == "leaky_relu" or self.op == "normalize"
        require(0 < self.alpha < 1 if has_alpha else self.alpha == 0, f"alpha {self.alpha}")
        require((slopes is not None) == (self.activation == "prelu"), f"{self.op}: slopes belong to prelu")
        self.slopes = [vector(slopes, self.channels)] if slopes is not None else []

    def output_shape(self, shapes):
        h, w = (1, 1) if self.op in ("fully_connected", "global_average_pool") else shapes[0][:2]
        if self.op == "add":
            margins = [big - small for small, big in zip(*shapes)]
            require(margins[2] == 0 and all(m >= 0 and m % 2 == 0 for m in margins), f"add of {shapes}")
        if self.op == "concat":
            require(shapes[0][:2] == shapes[1][:2], f"concat of {shapes}")
        if self.op == "slice":
            h, w = self._cut(shapes[0])
        if self.op in TWO_SIZES:
            require(all(b in (a, 1) for a, b in zip(*shapes)), f"{self.op} of {shapes}")
        if self.declared:
            h, w = self.declared
        if self.op == "rearrange":
            require(h * w * self.channels == math.prod(shapes[0]),
                     f"rearrange of {shapes[0]} as {(h, w, self.channels)}")
        if self.op in SLIDING:
            top, left, bottom, right = self.padding
            h = self._slide(h, self.kernel[0], self.stride[0], top, bottom)
            w = self._slide(w, self.kernel[1], self.stride[1], left, right)
        require(1 <= self.channels <= MAX_DIM and 1 <= h <= MAX_DIM and 1 <= w <= MAX_DIM
                 and h * w * round_up_8(self.channels) <= MAX_MAP_ELEMS, f"{self.op}: output {(h, w, self.channels)}")
        return h, w, self.channels

    def _cut(self, shape):
        """Output size of a slice."""
        (h, w, c), (top, left, bottom, right) = shape, self.padding
        require(all(0 <= n <= MAX_MARGIN for n in (*self.padding, self.first_channel)), f"slice without {self.padding}")
        require(top + bottom < h and left + right < w and 1 <= self.channels <= c - self.first_channel,
                 f"slice of {shape}: {self.channels} channels from {self.first_channel}, without {self.padding}")
        return h - top - bottom, w - left - right

    def _slide(self, size, kernel, stride, before, after):
        """Output size of a window that slides over `size` elements."""
        require(1 <= kernel <= MAX_KERNEL and 1 <= stride <= MAX_STRIDE, f"{self.op}: kernel {kernel}, stride {stride}")
        require(0 <= before < kernel and 0 <= after < kernel, f"{self.op}: padding {before}, {after}")
        require(before + size + after >= kernel, f"{self.op}: kernel {kernel} on {size} elements")
        last = (before + size + after - kernel + (stride - 1 if self.flags == CEIL_MODE else 0)) // stride
        require(last * stride < before + size, f"{self.op}: the last window would begin beyond the map")
        return last + 1

    def record(self, tensors):
        """Appends the layer's tensors to those of the file."""
        first = len(tensors)
        weights, bias = (first, first + 1) if self.tensors else (NO_INDEX, NO_INDEX)
        slopes = first + len(self.tensors) if self.slopes else NO_INDEX
        tensors += self.tensors + self.slopes
        return struct.pack("<2H2I3I8H2Hf3If", OPS[self.op], {**ACTIVATIONS, **CURVES}[self.activation],
                           *(self.inputs + [NO_INDEX])[:2], *self.shape, *self.kernel, *self.stride, *self.padding,
                           self.flags, self.first_channel, self.alpha, weights, bias, slopes, self.input_bound)


class _Strings:
    def __init__(self):
        self.data = bytearray()

    def here(self):
        """An empty string."""
        return len(self.data), 0

    def add(self, text):
        encoded = text.encode()
        self.data += encoded
        return len(self.data) - len(encoded), len(encoded)


def _factor(size, resized):
    """The factor between the sizes, or 0 if it is not an integer."""
    factor, rest = divmod(resized, size)
    return factor if rest == 0 and factor <= MAX_FACTOR else 0


def _name(name):
    require(NAME.fullmatch(name), f"name {name!r}")
    return name


def _text(text):
    require(len(text.encode()) <= MAX_TEXT_BYTES and not re.search(r"[\x00-\x08\x0b-\x1f\x7f-\x9f]", text),
             f"metadata {text[:40]!r}")
    return text


def _pair(value):
    return tuple(value) if isinstance(value, (list, tuple)) else (value, value)


def _four(value):
    return tuple(value) if isinstance(value, (list, tuple)) else (value,) * 4


def _aligned(n):
    return -(-n // ALIGNMENT) * ALIGNMENT
