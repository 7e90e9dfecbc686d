"""Functions that all operators use to create layers from ONNX nodes. operators.py has one function per operator."""
import numpy as np

from . import tensors
from .constants import FUNCTIONS, evaluated
from .element_order import MAX_PIECES, pieces_of
from .errors import Refused, require, require_room
from .layers import Layer
from .tensors import BITS, MASK, NOTHING, Tensor
from .weight_file import MAX_LAYERS

MAX_GROUPS = 16  # of channels that come from different layers


class Translator:
    """steps: how many steps of a stream the graph holds; 0 where it has no time."""

    def __init__(self, opset, steps):
        self.opset, self.steps = opset, steps
        self.layers = []
        self.node = ""  # the node, for error messages
        self.states = {}  # number of a state input's layer -> its next value, as elements
        self.notes = []

    # -- layers ------------------------------------------------------------

    def layer(self, op, inputs, shape, **options):
        require_room(*shape, max(self.steps, 1))
        layer = Layer(op, inputs, shape, self.node, **options)
        layer.number = len(self.layers)
        self.layers.append(layer)
        return layer

    def whole(self, layer, steps=None):
        """[steps, c, h, w]: of the last steps of the stream, by default of all."""
        return Tensor(tensors.elements(layer, max(self.steps, 1))[-(steps or self.steps or 1):])

    def replaced(self, tensor, replacements):
        """The tensor's element references, with references to some layers redirected to others."""
        at = tensor.at.copy()
        for old, new in replacements.items():
            mine = (tensor.at >= 0) & (tensor.at >> BITS == old)
            at[mine] = (new.number << BITS) | (tensor.at[mine] & MASK)
        return at

    def replaced_layers(self, tensor, replacements):
        """The same for a plain tensor, as one layer."""
        return Tensor(self.replaced(tensor, replacements), None, tensor.shift)

    def same_layers(self, a, b):
        """Pairs of layers of equal shape, if plain tensors hold the same elements of one as of the other everywhere;
        else nothing."""
        if a.shape != b.shape or (a.at < 0).any() or (b.at < 0).any() or ((a.at ^ b.at) & MASK).any():
            return []
        pairs = np.unique(np.stack([a.at >> BITS, b.at >> BITS], -1).reshape(-1, 2), axis=0)
        layers = [(self.real(int(first)), self.real(int(second))) for first, second in pairs]
        distinct = len({first.number for first, _ in layers}) == len(layers)
        return layers if distinct and all(first.shape == second.shape for first, second in layers) else []

    def real(self, number):
        layer = self.layers[number]
        require(layer.op not in ("state", "cell"), "it reads a state that only its own layer can use")
        return layer

    # -- per-channel arithmetic ------------------------------------------------------------

    def affine(self, tensor, scale, shift):
        """scale * tensor + shift, which broadcast to it."""
        shape = np.broadcast_shapes(tensor.shape, np.shape(scale), np.shape(shift))
        require(shape == tensor.shape, "its result has another shape than its operand")
        result = Tensor(tensor.at, tensor.scale * scale, tensor.shift * scale + shift)
        # Linear layers absorb it at once; otherwise the next reader applies it.
        absorbing = all(self.layers[n].is_plain() for n in tensor.layer_numbers())
        return self.settled(result) if absorbing and self.is_per_channel(result) else result

    def is_per_channel(self, tensor):
        try:
            for number in tensor.layer_numbers():
                self.channel_numbers(tensor, number)
        except Refused:
            return False
        return True

    def channel_numbers(self, tensor, number):
        mine = (tensor.at >= 0) & (tensor.at >> BITS == number)
        layer = self.real(number)
        return (tensors.per_channel(layer, tensor.at[mine], tensor.scale[mine], 1.0),
                tensors.per_channel(layer, tensor.at[mine], tensor.shift[mine], 0.0))

    def settled(self, tensor):
        """The same with scale 1 and shift 0, except for constants: pending scales and shifts become layers."""
        if tensor.is_plain():
            return tensor
        if not self.steps and not self.is_per_channel(tensor):
            return self.settled_by_element(tensor)
        made = {}
        for number in tensor.layer_numbers():
            scale, shift = self.channel_numbers(tensor, number)
            if (scale != 1).any() or (shift != 0).any():
                layer = self.layers[number]
                made[number] = self.layer("affine", [layer], layer.shape, scale=scale, shift=shift)
        constant = tensor.at < 0
        return Tensor(self.replaced(tensor, made), np.ones(tensor.shape), np.where(constant, tensor.shift, 0.0))

    def settled_by_element(self, tensor):
        """As a vector with a scale and a shift per channel."""
        computed = tensor.at >= 0
        vector = self.vector_of(tensor.at[computed])
        self.notes.append(f"{self.node}: its constants, one for each element, are rounded to fp16")
        layer = self.layer("affine", [vector], vector.shape, scale=tensor.scale[computed], shift=tensor.shift[computed])
        if computed.all() and len(tensor.shape) > 1:  # a pixel for each row, whose channels can be sliced
            columns = tensor.shape[-1]
            pixels = self.layer("rearrange", [layer], (layer.size // columns, 1, columns), order="hwc")
            return Tensor(tensors.elements(pixels).reshape(columns, -1).T.reshape(tensor.shape))
        at = tensor.at.copy()
        at[computed] = tensors.elements(layer).reshape(-1)
        return Tensor(at, None, np.where(computed, 0.0, tensor.shift))

    def activated(self, tensor, function, activation, slopes=None):
        """Applies an activation to every element, and `function` to constants. slopes: a function of (layer number) for
        PReLU."""
        tensor = self.settled(tensor)
        made = {}
        for number in tensor.layer_numbers():
            layer = self.real(number)
            made[number] = self.layer("activation", [layer], layer.shape)
            made[number].activation = dict(activation, slopes=slopes(number)) if slopes else dict(activation)
        return Tensor(self.replaced(tensor, made), tensor.scale, np.where(tensor.at < 0, function(tensor.shift), 0.0))

    # -- steps ------------------------------------------------------------

    def sizes(self, at):
        sizes = np.array([layer.size for layer in self.layers], np.int64)
        return sizes[np.maximum(at, 0) >> BITS]

    def one_step(self, at):
        """[s, ...], the last steps of the stream -> the content of each step, as elements of step 0."""
        size = self.sizes(at)
        step = np.where(at >= 0, (at & MASK) // size, 0)
        at = np.where(at >= 0, at - step * size, at)
        first = max(self.steps, 1) - len(at)
        own = first + np.arange(len(at)).reshape(-1, *[1] * (at.ndim - 1))
        require(first >= 0 and (at == at[0]).all() and ((step == own) | (at < 0)).all(), "it mixes steps of time")
        return at[0]

    # -- maps ------------------------------------------------------------

    def as_map(self, tensor, rearranges=True):
        """[s, c, h, w] as one layer with exactly that map. Adds slices and concatenations if necessary, and layers that
        rearrange elements if these do not suffice and `rearranges` allows it."""
        tensor = self.settled(tensor)
        require(not (tensor.at == tensors.FUTURE).any(), "it depends on later steps of the stream")
        constant = tensor.at == NOTHING
        if constant.any():
            require(tensor.at.shape[0] == 1 and not tensor.shift.any(),
                    "it mixes constants with computed values")
            return self.padded(tensor)
        at = self.one_step(tensor.at)
        return self.map_of(at) if rearranges and not self.steps else self.blocks(at)

    def map_of(self, at):
        """[c, h, w] by as many layers as necessary."""
        try:
            return self.blocks(at)
        except Refused:
            pass
        begins = np.flatnonzero(np.diff(at[:, 0, 0] >> BITS)) + 1
        try:
            return self.rearranged(at)
        except Refused:
            if not 0 < len(begins) < MAX_GROUPS:
                raise
        return self.joined([self.map_of(part) for part in np.split(at, begins)])

    def blocks(self, at):
        """[c, h, w] as consecutive parts of layers' maps."""
        numbers, channels = self.channel_runs(at)
        runs = [(self.real(number), at[first:last]) for number, first, last in zip(numbers, channels, channels[1:])]
        boxes = [self.place_of_block(layer, run) for layer, run in runs]  # before any layer is made
        return self.joined([self.block(layer, run, box) for (layer, run), box in zip(runs, boxes)])

    def joined(self, parts):
        whole = parts[0]
        for part in parts[1:]:
            whole = self.layer("concat", [whole, part], (*whole.shape[:2], whole.shape[2] + part.shape[2]))
        return whole

    def channel_runs(self, at):
        """The bounds of runs of channels that are consecutive in one layer, and the layers."""
        first = at[:, 0, 0]
        number, pixels = first >> BITS, np.array([layer.shape[0] * layer.shape[1] for layer in self.layers])
        channel = (first & MASK) // pixels[number]
        begins = np.flatnonzero((np.diff(number) != 0) | (np.diff(channel) != 1)) + 1
        require(len(begins) < MAX_LAYERS,
                f"its channels come from {len(begins) + 1} pieces; a network has at most {MAX_LAYERS} layers")
        bounds = [0, *begins.tolist(), len(at)]
        return number[bounds[:-1]].tolist(), bounds

    def place_of_block(self, layer, at):
        """The start of [c, h, w], which must be a part of the layer's map."""
        h, w, c = layer.shape
        begin = first, y, x = [int(n) for n in np.unravel_index(int(at[0, 0, 0] & MASK), (c, h, w))]
        inside = all(b + n <= size for b, n, size in zip(begin, at.shape, (c, h, w)))
        channels, rows, columns = np.ogrid[tuple(map(slice, at.shape))]
        require(inside and (at == at[0, 0, 0] + (channels * h + rows) * w + columns).all(),
                "it reads a map whose rows, columns or channels have been rearranged")
        return begin

    def block(self, layer, at, begin):
        (h, w, _), (first, y, x) = layer.shape, begin
        if at.size == layer.size:
            return layer
        margins = y, x, h - y - at.shape[1], w - x - at.shape[2]
        return self.layer("slice", [layer], (at.shape[1], at.shape[2], at.shape[0]), first_channel=first,
                          channels=at.shape[0], padding=margins)

    def padded(self, tensor):
        """Adds zeros around a map: a depthwise convolution with a single tap of 1."""
        (top, left, bottom, right), inner = tensors.zero_border(tensor)
        require(inner.shape != tensor.shape, "it mixes constants with computed values")
        require(top + bottom <= 14 and left + right <= 14,
                "zeros around a map: at most 14 in all above and below, or left and right")
        x = self.as_map(inner)
        kh, kw = top + bottom + 1, left + right + 1
        h, w, c = x.shape
        weight = np.zeros((c, 1, kh, kw))
        weight[:, 0, bottom, right] = 1
        return self.layer("depthwise", [x], (h + kh - 1, w + kw - 1, c), weight=weight, bias=np.zeros(c), stride=(1, 1),
                          padding=(kh - 1, kw - 1, kh - 1, kw - 1))

    def rearranged(self, at):
        """[c, h, w] of any elements, which must be pieces of layers."""
        c, h, w = at.shape
        try:
            pieces = self.pieces(at.transpose(1, 2, 0).reshape(-1))
        except Refused:
            vector = self.vector_of(at.reshape(-1))
            turned = self.layer("rearrange", [vector], (c, h, w), order="hwc")
            return self.layer("rearrange", [turned], (h, w, c), order="wch")
        if len(pieces) == 1:
            return self.piece(pieces[0], (h, w, c))
        vector = self.joined([self.piece(piece) for piece in pieces])
        return self.layer("rearrange", [vector], (h, w, c), order="hwc")

    def vector_of(self, elements):
        """[n] elements of layers as a vector."""
        return self.joined([self.piece(piece) for piece in self.pieces(elements)])

    def pieces(self, elements):
        """[n] elements as pieces of layers."""
        numbers = elements >> BITS
        bounds = [0, *(np.flatnonzero(np.diff(numbers)) + 1).tolist(), len(elements)]
        require(len(bounds) <= MAX_PIECES, f"it combines a tensor from more than {MAX_PIECES} pieces")
        found = []
        for first, last in zip(bounds, bounds[1:]):
            found += pieces_of(self.real(int(numbers[first])), elements[first:last] & MASK)
        require(len(found) <= MAX_PIECES, f"it combines a tensor from more than {MAX_PIECES} pieces")
        return found

    def piece(self, piece, shape=None):
        """As a map of that shape, by default as a vector."""
        layer = self.joined([self.slice_of(piece, channels) for channels in piece.channels])
        shape = shape or (1, 1, layer.size)
        same = layer.shape == shape and (piece.order == "hwc" or shape[:2] == (1, 1))
        return layer if same else self.layer("rearrange", [layer], shape, order=piece.order)

    def slice_of(self, piece, channels):
        layer, (first, last), (top, bottom), (left, right) = piece.layer, channels, piece.rows, piece.columns
        size = bottom - top, right - left, last - first
        if size == layer.shape:
            return layer
        margins = top, left, layer.shape[0] - bottom, layer.shape[1] - right
        return self.layer("slice", [layer], size, first_channel=first, channels=size[2], padding=margins)

    def arrangements(self, shape, channel_axis=None):
        """Ways to read a tensor of this shape as [steps, c, h, w]: the axes that make up each of these."""
        steps, axes = range(1, max(self.steps, 1) + 1), range(len(shape))
        if len(shape) == 4:
            yield from ([[axis] for axis in order] for order in ((0, 1, 2, 3), (0, 3, 1, 2), (0, 3, 2, 1))
                        if channel_axis in (None, order[1]) and shape[0] in steps)
        for step, channel in [(s, c) for s in axes for c in axes if s != c and shape[s] in steps] + [(None, c)
                                                                                                     for c in axes]:
            others = [axis for axis in axes if axis not in (step, channel)]
            if channel_axis in (None, channel) and all(shape[axis] == 1 for axis in others):
                yield [[] if step is None else [step], [channel], others, []]
        if len(shape) == 3 and shape[0] == 1 and channel_axis in (None, 2) and not self.steps:
            yield [[0], [2], [1], []]
        if len(shape) == 3 and shape[0] == 1 and channel_axis in (None, 1):
            yield [[0], [1], [], [2]]
        if not self.steps:
            for channel in [len(shape) - 1, 1] if channel_axis is None else [channel_axis]:
                if 0 <= channel < len(shape):
                    yield [[], [channel], [axis for axis in axes if axis != channel], []]

    def arranged(self, tensor, channel_axis=None):
        """Finds an arrangement that is a map: its layer, its number of steps, and the way to restore the order of
        elements."""
        (layer,), steps, back = self.arranged_alike([tensor], channel_axis)
        return layer, steps, back

    def arranged_alike(self, given, channel_axis=None):
        """The same for several tensors: the first is the largest, and the others have size 1 on broadcast axes.
        Rearranges elements of the first only if necessary."""
        given, refusal = [self.settled(tensor) for tensor in given], None
        shape = given[0].shape
        for first, others in ((False, False), (False, True), (True, True)):
            for groups in self.arrangements(shape, channel_axis):
                try:
                    layers = [self.as_map(tensor.moved(lambda part, groups=groups: grouped(part, groups)),
                                          others if i else first)
                              for i, tensor in enumerate(given)]
                except Refused as error:
                    refusal = refusal or error
                    continue
                order = [axis for group in groups for axis in group]
                ordered = [shape[axis] for axis in order]
                steps = grouped(given[0].at, groups).shape[0]
                return layers, steps, lambda part, order=order, ordered=ordered: part.reshape(ordered).transpose(
                    np.argsort(order))
        raise refusal or Refused(f"it reads a tensor {list(shape)}, which is neither a map nor a vector")

    def result(self, layer, steps, back):
        """A layer's elements in the arrangement that `arranged` found."""
        return self.whole(layer, steps).moved(back)

    # -- dense layers ------------------------------------------------------------

    def rows(self, tensor):
        """[r, n], where each row is a step: the content of a step, and scales and shifts, all [n]."""
        require(not (tensor.at == tensors.FUTURE).any(), "it depends on later steps of the stream")
        message = "the steps are scaled differently"
        return Tensor(self.one_step(tensor.at), tensors.along(tensor.scale, [0], message),
                      tensors.along(tensor.shift, [0], message))

    def dense(self, row, weight, bias):
        """weight [out, n] times a row of any elements: the sum of one fully connected layer per layer that they come
        from."""
        bias = bias + weight @ row.shift
        weight = weight * row.scale
        total = None
        for number in row.layer_numbers():
            x = self.real(number)
            mine = (row.at >= 0) & (row.at >> BITS == number)
            if np.count_nonzero(mine) < x.size:  # else the file itself has a weight of this size
                require_room(len(bias), x.size)
            own = np.zeros((len(bias), x.size))
            np.add.at(own, (slice(None), row.at[mine] & MASK), weight[:, mine])
            part = self.layer("fully_connected", [x], (1, 1, len(bias)), weight=own,
                              bias=np.zeros_like(bias) if total else bias)
            total = self.layer("add", [total, part], part.shape) if total else part
        require(total, "all its inputs are constants")
        return total

    # -- nodes ------------------------------------------------------------

    def constant(self, node):
        """The result of an operator whose inputs are all constants."""
        with np.errstate(all="ignore"):
            if node.operator in FUNCTIONS:
                return [np.asarray(FUNCTIONS[node.operator](node.inputs, node.attributes))]
            return evaluated(node, self.opset)


def grouped(part, groups):
    """The axes of each group become one."""
    order = [axis for group in groups for axis in group]
    return part.transpose(
        order).reshape([int(np.prod([part.shape[axis] for axis in group], dtype=np.int64)) for group in groups])
