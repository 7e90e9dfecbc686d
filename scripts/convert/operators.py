"""One function for each ONNX operator: (translator, node) -> its outputs. docs/convert.md lists them.

node.inputs are Tensors, numpy arrays (constants) or None; operators whose inputs are all constants do not come here, but those of MOVES
do, which serve both.
"""
import math

import numpy as np

import tensors
from constants import axes_of
from layers import slid
from refusal import Refused, require, require_room
from tensors import FUTURE, NOTHING, Tensor

MOST_DELAYS = 1000  # of one convolution: each becomes a layer, of which a file holds 1024


def is_constant(x):
    return isinstance(x, np.ndarray)


def as_tensor(x):
    return tensors.of_constant(x) if is_constant(x) else x


def constant(x, what):
    require(x is None or is_constant(x), f"its {what} is not a constant")
    return x


def scalar(x, default):
    return default if x is None else float(np.asarray(x).reshape(-1)[0])


# -- operators that only move elements -------------------------------------------------------------------------------------------------

def moved(x, move):
    return move(x) if is_constant(x) else x.moved(move)


def identity(t, node):
    return [node.inputs[0]]


def dropout(t, node):
    training = constant(node.inputs[2], "training_mode") if len(node.inputs) > 2 else None
    require(not scalar(training, 0), "it is in training mode")
    return [node.inputs[0], None]


def cast(t, node):
    require(node.attributes["to"] in (1, 10, 11), "it turns what the network computes into integers")
    return [node.inputs[0]]


def reshape(t, node):
    x, wanted = node.inputs[0], [int(n) for n in constant(node.inputs[1], "shape")]
    if not node.attributes.get("allowzero", 0):
        wanted = [x.shape[i] if n == 0 else n for i, n in enumerate(wanted)]
    return [moved(x, lambda part: part.reshape(wanted))]


def flatten(t, node):
    x, axis = node.inputs[0], node.attributes.get("axis", 1)
    rows = math.prod(x.shape[:axis])
    return [moved(x, lambda part: part.reshape(rows, -1))]


def squeeze(t, node):
    x, axes = node.inputs[0], axes_of(node.inputs, node.attributes)
    axes = [i for i, n in enumerate(x.shape) if n == 1] if axes is None else axes
    return [moved(x, lambda part: part.squeeze(tuple(axes)))]


def unsqueeze(t, node):
    x, axes = node.inputs[0], axes_of(node.inputs, node.attributes)
    return [moved(x, lambda part: np.expand_dims(part, tuple(axes)))]


def transpose(t, node):
    order = node.attributes.get("perm")
    return [moved(node.inputs[0], lambda part: part.transpose(order))]


def gather(t, node):
    index, axis = constant(node.inputs[1], "index").astype(np.int64), node.attributes.get("axis", 0)
    x = node.inputs[0]
    require_room(math.prod(x.shape) // max(x.shape[axis], 1), index.size)
    return [moved(x, lambda part: np.take(part, index, axis))]


def slice_(t, node):
    x = node.inputs[0]
    starts, ends = (constant(i, "range").reshape(-1) for i in node.inputs[1:3])
    axes = axes_of(node.inputs, {}, 3)
    axes = range(len(starts)) if axes is None else axes
    steps = constant(node.inputs[4], "steps").reshape(-1) if len(node.inputs) > 4 and node.inputs[4] is not None else np.ones(len(starts), int)
    ranges = [slice(None)] * len(x.shape)
    for axis, start, end, step in zip(axes, starts, ends, steps):
        size = x.shape[axis]
        first, last = slice_bounds(int(start), int(end), int(step), size)
        ranges[axis] = slice(first, last, int(step))
    return [moved(x, lambda part: part[tuple(ranges)])]


def slice_bounds(start, end, step, size):
    """ONNX's range as Python's: ends far outside are clamped, and going down to the first element has no number."""
    low, high = (0, size) if step > 0 else (-1, size - 1)
    first, last = (min(max(n + size if n < 0 else n, low), high) for n in (start, max(end, -size - 1)))
    return max(first, 0), None if last < 0 else last


def split(t, node):
    x, axis = node.inputs[0], node.attributes.get("axis", 0)
    sizes = constant(node.inputs[1], "split") if len(node.inputs) > 1 else node.attributes.get("split")
    if sizes is None:
        part = math.ceil(x.shape[axis] / len(node.outputs))
        sizes = [min(part, x.shape[axis] - part * i) for i in range(len(node.outputs))]
    ends = np.cumsum([int(n) for n in sizes])
    return [moved(x, lambda part, first=end - n, last=end: np.take(part, range(first, last), axis)) for n, end in zip(sizes, ends)]


def concat(t, node):
    axis = node.attributes["axis"]
    if all(map(is_constant, node.inputs)):
        return [np.concatenate(node.inputs, axis)]
    return [tensors.joined([as_tensor(x) for x in node.inputs], axis)]


def pad(t, node):
    x, mode = node.inputs[0], node.attributes.get("mode", "constant")
    require(mode == "constant", f"padding of mode {mode!r}")
    amounts = constant(node.inputs[1], "pads").reshape(-1)
    value = scalar(constant(node.inputs[2], "value") if len(node.inputs) > 2 else None, 0.0)
    axes = axes_of(node.inputs, {}, 3)
    axes = list(range(len(x.shape))) if axes is None else axes
    before, after = [0] * len(x.shape), [0] * len(x.shape)
    for i, axis in enumerate(axes):
        before[axis], after[axis] = int(amounts[i]), int(amounts[len(axes) + i])
    require(min(before + after) >= 0, "negative padding")
    require_room(*(b + n + e for b, n, e in zip(before, x.shape, after)))
    widths = list(zip(before, after))
    x = as_tensor(x)
    return [Tensor(np.pad(x.at, widths, constant_values=NOTHING), np.pad(x.scale, widths, constant_values=1.0),
                   np.pad(x.shift, widths, constant_values=value))]


def shape(t, node):
    first, last = node.attributes.get("start", 0), node.attributes.get("end")
    return [np.array(node.inputs[0].shape[first:last], np.int64)]


# -- arithmetic with constants ---------------------------------------------------------------------------------------------------------

def add(t, node):
    total = node.inputs[0]
    for other in node.inputs[1:]:
        total = add_two(t, total, other)
    return [total]


def add_two(t, a, b):
    if is_constant(a):
        a, b = b, a
    if is_constant(b):
        return t.affine(a, 1.0, b.astype(np.float64))
    require(a.shape == b.shape, f"a sum of {list(a.shape)} and {list(b.shape)}")
    first, steps, back = t.arranged(a)
    second, other_steps, _ = t.arranged(b)
    require(first.shape == second.shape and steps == other_steps, f"a sum of maps {first.shape} and {second.shape}")
    return t.result(t.layer("add", [first, second], first.shape), steps, back)


def subtract(t, node):
    a, b = node.inputs
    if is_constant(a):
        return [t.affine(b, -1.0, a.astype(np.float64))]
    if is_constant(b):
        return [t.affine(a, 1.0, -b.astype(np.float64))]
    return [add_two(t, a, t.affine(b, -1.0, 0.0))]


def multiply(t, node):
    a, b = node.inputs
    if is_constant(a):
        a, b = b, a
    require(is_constant(b), "a product of two things that the network computes")
    return [t.affine(a, b.astype(np.float64), 0.0)]


def divide(t, node):
    a, b = node.inputs
    require(is_constant(b), "a division by what the network computes")
    return [t.affine(a, 1.0 / b.astype(np.float64), 0.0)]


def negate(t, node):
    return [t.affine(node.inputs[0], -1.0, 0.0)]


def batch_norm(t, node):
    require(not node.attributes.get("training_mode", 0), "it is in training mode")
    x = node.inputs[0]
    gain, bias, mean, variance = (constant(i, "statistics").astype(np.float64) for i in node.inputs[1:5])
    scale = gain / np.sqrt(variance + node.attributes.get("epsilon", 1e-5))
    axes = [1, -1] + [1] * (len(x.shape) - 2)
    return [t.affine(x, scale.reshape(axes), (bias - mean * scale).reshape(axes))]


# -- activations -----------------------------------------------------------------------------------------------------------------------

def relu(t, node):
    return [t.activated(node.inputs[0], lambda x: np.maximum(x, 0), {"activation": "relu"})]


def sigmoid(t, node):
    return [t.activated(node.inputs[0], lambda x: 1 / (1 + np.exp(-x)), {"activation": "sigmoid"})]


def tanh(t, node):
    return [t.activated(node.inputs[0], np.tanh, {"activation": "tanh"})]


def leaky_relu(t, node):
    return [leaky(t, node.inputs[0], node.attributes.get("alpha", 0.01))]


def leaky(t, x, alpha):
    def function(v):
        return np.where(v < 0, alpha * v, v)
    if alpha == 0:
        return t.activated(x, function, {"activation": "relu"})
    if 0 < alpha < 1:
        return t.activated(x, function, {"activation": "leaky_relu", "alpha": alpha})
    return t.activated(x, function, {"activation": "prelu"}, lambda number: np.full(t.layers[number].shape[2], alpha))


def prelu(t, node):
    x, slope = t.settled(node.inputs[0]), constant(node.inputs[1], "slope").astype(np.float64)
    slope = np.broadcast_to(slope, x.shape)
    constants = x.at < 0
    require(not (constants & (x.shift < 0)).any(), "a negative constant beside what the network computes")

    def slopes(number):
        mine = (x.at >= 0) & (x.at >> tensors.BITS == number)
        return tensors.per_channel(t.layers[number], x.at[mine], slope[mine], 0.0)
    return [t.activated(x, lambda v: v, {"activation": "prelu"}, slopes)]


def clip(t, node):
    low = scalar(constant(node.inputs[1], "minimum") if len(node.inputs) > 1 else None, -math.inf)
    high = scalar(constant(node.inputs[2], "maximum") if len(node.inputs) > 2 else None, math.inf)
    # Exporters write the largest float for none, and a clip at 6 behind a ReLU for ReLU6.
    low, high = low if low > -3e38 else -math.inf, high if high < 3e38 else math.inf
    return [clipped(t, node.inputs[0], max(low, 0.0) if not_negative(t, node.inputs[0]) else low, high)]


def not_negative(t, x):
    return x.is_plain() and not ((x.at < 0) & (x.shift < 0)).any() and all(
        t.layers[n].activation.get("activation") in ("relu", "relu6", "clamp01", "sigmoid") for n in x.layer_numbers())


def clipped(t, x, low, high):
    """By what activations there are: relu, relu6, and a clamp to 0..1 between a scaling there and back."""
    if low == -math.inf and high == math.inf:
        return x
    if low == -math.inf:  # high - relu(high - x)
        return t.affine(clipped(t, t.affine(x, -1.0, high), 0.0, math.inf), -1.0, high)
    if low == 0 and high == 6:
        return t.activated(x, lambda v: np.clip(v, 0, 6), {"activation": "relu6"})
    if high == math.inf:
        x = x if low == 0 else t.affine(x, 1.0, -low)
        x = t.activated(x, lambda v: np.maximum(v, 0), {"activation": "relu"})
        return x if low == 0 else t.affine(x, 1.0, low)
    require(low < high, f"a range of {low} .. {high}")
    x = x if (low, high) == (0, 1) else t.affine(x, 1 / (high - low), -low / (high - low))
    x = t.activated(x, lambda v: np.clip(v, 0, 1), {"activation": "clamp01"})
    return x if (low, high) == (0, 1) else t.affine(x, high - low, low)


def hard_sigmoid(t, node):
    x = t.affine(node.inputs[0], node.attributes.get("alpha", 0.2), node.attributes.get("beta", 0.5))
    return [clipped(t, x, 0.0, 1.0)]


def softmax(t, node):
    x = node.inputs[0]
    axis = node.attributes.get("axis", -1 if t.opset >= 13 else 1) % len(x.shape)
    # Until opset 12 it is over all axes from there on.
    require(t.opset >= 13 or math.prod(x.shape[axis:]) == max(x.shape[axis:]), f"a softmax over axes {axis} .. {len(x.shape) - 1} together")
    axis = axis if t.opset >= 13 else axis + int(np.argmax(x.shape[axis:]))
    layer, steps, back = t.arranged(x, axis)
    return [t.result(t.layer("softmax", [layer], layer.shape), steps, back)]


# -- convolutions and pools ------------------------------------------------------------------------------------------------------------

def steps_of(attributes, count):
    """Strides and dilations of a window over that many axes."""
    strides, dilations = (attributes.get(key, [1] * count) for key in ("strides", "dilations"))
    require(len(strides) == len(dilations) == count and min(strides + dilations) > 0,
            f"strides {strides}, dilations {dilations} of a window over {count} axes")
    return strides, dilations


def padding_of(attributes, sizes, kernel, strides, dilations):
    """([before...], [after...]), as pads or auto_pad say."""
    mode, count = attributes.get("auto_pad", "NOTSET"), len(sizes)
    if mode in ("NOTSET", ""):
        pads = attributes.get("pads", [0] * 2 * count)
        require(len(pads) == 2 * count, f"padding {pads} of {count} axes")
        return list(pads[:count]), list(pads[count:])
    if mode == "VALID":
        return [0] * count, [0] * count
    before, after = [], []
    for size, k, stride, dilation in zip(sizes, kernel, strides, dilations):
        total = max((math.ceil(size / stride) - 1) * stride + (k - 1) * dilation + 1 - size, 0)
        less, more = total // 2, total - total // 2
        before.append(less if mode == "SAME_UPPER" else more)
        after.append(more if mode == "SAME_UPPER" else less)
    return before, after


def dilated(weight, dilations):
    """The same convolution with zeros between its taps and none in its dilations."""
    if all(d == 1 for d in dilations):
        return weight
    size = [(k - 1) * d + 1 for k, d in zip(weight.shape[2:], dilations)]
    require_room(*weight.shape[:2], *size)
    wide = np.zeros((*weight.shape[:2], *size))
    wide[(slice(None), slice(None), *(slice(None, None, d) for d in dilations))] = weight
    return wide


def ungrouped(weight, groups):
    """A grouped convolution as one with zeros between the groups."""
    if groups == 1:
        return weight
    outputs, inputs = weight.shape[0] // groups, weight.shape[1]
    require_room(weight.shape[0], inputs * groups, *weight.shape[2:])
    full = np.zeros((weight.shape[0], inputs * groups, *weight.shape[2:]))
    for g in range(groups):
        full[g * outputs:(g + 1) * outputs, g * inputs:(g + 1) * inputs] = weight[g * outputs:(g + 1) * outputs]
    return full


def conv(t, node):
    x, weight = node.inputs[0], constant(node.inputs[1], "weight").astype(np.float64)
    given = constant(node.inputs[2], "bias") if len(node.inputs) > 2 else None
    bias = np.zeros(len(weight)) if given is None else given.astype(np.float64)
    count = weight.ndim - 2
    require(count in (1, 2), f"a convolution over {count} axes")
    groups = node.attributes.get("group", 1)
    require(len(x.shape) == weight.ndim and weight.shape[1] * groups == x.shape[1] and len(weight) % groups == 0,
            f"it reads {list(x.shape)} with a weight {list(weight.shape)}" + (f" in {groups} groups" if groups != 1 else ""))
    strides, dilations = steps_of(node.attributes, count)
    before, after = padding_of(node.attributes, x.shape[2:], weight.shape[2:], strides, dilations)
    if count == 1 and t.steps:
        require(strides == [1], "strides over time")
        return [conv_over_time(t, x, ungrouped(weight, groups), bias, before[0], after[0], dilations[0])]
    weight = dilated(weight, dilations)
    if count == 2:
        return [conv_over_map(t, x, weight, bias, groups, strides, (*before, *after))]
    y = conv_over_map(t, x.moved(lambda part: part[:, :, None, :]), weight[:, :, None, :], bias, groups,
                      [1, *strides], (0, before[0], 0, after[0]))
    return [y.moved(lambda part: part[:, :, 0, :])]


def conv_over_map(t, x, weight, bias, groups, strides, padding):
    depthwise = groups == len(weight) == x.shape[1] and groups > 1
    if not depthwise:
        if groups > 1:
            t.notes.append(f"{t.node}: {groups} groups become one, with zeros between them")
        weight = ungrouped(weight, groups)
    if ((x.at == NOTHING) & (x.shift == 0)).any():
        border, x = tensors.zero_border(x)
        padding = tuple(a + b for a, b in zip(padding, border))
    x, weight, bias = folded_into_conv(t, x, weight, bias, depthwise, any(padding))
    layer = t.as_map(x)
    kernel, stride = weight.shape[2:], tuple(strides)
    h, w, c = layer.shape
    out = slid(layer.shape, kernel, stride, padding, len(weight))
    if max(kernel) > 15 and out[:2] == (1, 1) and not any(padding) and kernel == (h, w) and not depthwise:
        return t.whole(t.layer("fully_connected", [layer], out, weight=weight.reshape(len(weight), -1), bias=bias), len(x.at))
    require(max(kernel) <= 15 and max(stride) <= 15, f"kernel {list(kernel)}, stride {list(stride)}: at most 15")
    require(all(p < k for p, k in zip(padding, kernel * 2)), f"padding {list(padding)} as large as the kernel {list(kernel)}")
    operation = "depthwise" if depthwise else "conv2d"
    return t.whole(t.layer(operation, [layer], out, weight=weight, bias=bias, stride=stride, padding=padding), len(x.at))


def folded_into_conv(t, x, weight, bias, depthwise, padded):
    """What waits to be scaled and shifted goes into the weights; a shift only where no zeros are read beside it."""
    if x.is_plain() or (x.at < 0).any():
        return t.settled(x), weight, bias
    try:
        scale, shift = (tensors.along(part, [0, 2, 3], "") for part in (x.scale, x.shift))
    except Refused:
        return t.settled(x), weight, bias
    if padded and shift.any():
        return t.settled(x), weight, bias
    if depthwise:
        bias = bias + weight.sum((1, 2, 3)) * shift
        weight = weight * scale.reshape(-1, 1, 1, 1)
    else:
        bias = bias + np.einsum("oihw,i->o", weight, shift)
        weight = weight * scale.reshape(1, -1, 1, 1)
    return Tensor(x.at), weight, bias


def conv_over_time(t, x, weight, bias, before, after, dilation):
    """[1, c, t], steps of the stream between columns of what was before it and columns of what is after it."""
    require(x.shape[0] == 1, f"a batch of {x.shape[0]}")
    reach = (weight.shape[2] - 1) * dilation
    require(0 <= reach <= MOST_DELAYS, f"a convolution that reaches back {reach} steps; at most {MOST_DELAYS}")
    require_room(x.shape[1], before + x.shape[2] + after)
    x = Tensor(*(np.pad(part[0], ((0, 0), (before, after)), constant_values=value)
                 for part, value in ((x.at, NOTHING), (x.scale, 1.0), (x.shift, 0.0))))
    past, real = time_columns(t, x.at)
    require(past <= reach, f"{past} steps before the first, for a convolution that reaches back {reach}")
    require(past == 0 or real == t.steps, "it puts zeros before steps that are not the first")
    steps = x.moved(lambda part: part[:, past:past + real])
    scale, shift = (tensors.along(part, [1], "the steps are scaled differently") for part in (steps.scale, steps.shift))
    if not begins_with(t, x.moved(lambda part: part[:, :past]), scale, shift):
        require(begins_with(t, x.moved(lambda part: part[:, :past]), 1.0, 0.0), "the stream does not begin with zeros")
        steps, scale, shift = t.settled(steps), np.ones(len(scale)), np.zeros(len(scale))
    remember(t, x.at, past, real)
    layer = t.as_map(Tensor(steps.at.T[:, :, None, None]))
    bias = bias + np.einsum("oik,i->o", weight, shift)
    y = t.whole(causal(t, layer, weight * scale.reshape(1, -1, 1), bias, dilation)).at[:, :, 0, 0].T
    columns = np.full((len(bias), x.shape[1] - past), FUTURE, np.int64)
    columns[:, :real] = y[:, -real:]
    return Tensor(columns[None, :, reach - past:])


def time_columns(t, at):
    """How many columns come before the stream's steps, and how many are steps."""
    told = np.array([layer.op != "state" for layer in t.layers] + [False])  # the last: NOTHING and FUTURE, whose number is -1
    real = told[at >> tensors.BITS].any(0)
    require(real.any(), "it reads nothing but constants")
    first, last = np.flatnonzero(real)[[0, -1]]
    require(real[first:last + 1].all() and ((at[:, last + 1:] == NOTHING) | (at[:, last + 1:] == FUTURE)).all(), "it mixes steps of time")
    return int(first), int(last + 1 - first)


def begins_with(t, past, scale, shift):
    """Whether the columns before the stream are zeros or states, scaled and shifted like this."""
    scale, shift = (np.broadcast_to(n, past.shape[:1])[:, None] for n in (scale, shift))
    state = past.at >= 0
    return ((past.shift == shift) & ((past.scale == scale) | ~state)).all()


def remember(t, at, past, real):
    """The states among the columns before the stream become those before its next steps."""
    for number in np.unique(at[:, :past][at[:, :past] >= 0] >> tensors.BITS):
        following = np.full(t.layers[number].size, NOTHING, np.int64)
        channel, column = np.nonzero((at >> tensors.BITS == number) & (at >= 0))
        following[at[channel, column] & tensors.MASK] = at[channel, column + real]
        t.states[int(number)] = following


def causal(t, x, weight, bias, dilation):
    """The engine's convolution has kernel 2 and no dilation; for others steps of the past are kept side by side."""
    inputs, taps = weight.shape[1:]
    if taps == 1:
        return t.layer("fully_connected", [x], (1, 1, len(bias)), weight=weight[:, :, 0], bias=bias)
    if taps == 2 and dilation == 1:
        return t.layer("causal_conv", [x], (1, 1, len(bias)), weight=weight, bias=bias)
    t.notes.append(f"{t.node}: kernel {taps}, dilation {dilation} over time is made of {(taps - 1) * dilation} delays")
    delay = np.zeros((inputs, inputs, 2))
    delay[:, :, 0] = np.eye(inputs)
    before, kept, rows = x, x, [weight[:, :, -1]]
    for step in range(1, (taps - 1) * dilation + 1):
        before = t.layer("causal_conv", [before], x.shape, weight=delay, bias=np.zeros(inputs))
        if step % dilation == 0:
            kept = t.layer("concat", [kept, before], (1, 1, kept.shape[2] + inputs))
            rows.append(weight[:, :, -1 - step // dilation])
    return t.layer("fully_connected", [kept], (1, 1, len(bias)), weight=np.concatenate(rows, 1), bias=bias)


def max_pool(t, node):
    require(len(node.outputs) == 1 or not node.outputs[1], "its second output, the places of the largest values")
    x, kernel = node.inputs[0], node.attributes["kernel_shape"]
    require(len(x.shape) - 2 == len(kernel) <= 2 and not (t.steps and len(kernel) == 1), f"a pool over {list(kernel)} of {list(x.shape)}")
    strides, dilations = steps_of(node.attributes, len(kernel))
    require(all(d == 1 for d in dilations), "dilations")
    before, after = padding_of(node.attributes, x.shape[2:], kernel, strides, dilations)
    flat = len(kernel) == 1
    if flat:
        x = x.moved(lambda part: part[:, :, None, :])
        kernel, strides, before, after = [1, *kernel], [1, *strides], [0, *before], [0, *after]
    layer = t.as_map(x)
    sizes, after, ceil_mode = pool_windows(layer.shape[:2], kernel, strides, before, after, node.attributes.get("ceil_mode", 0))
    require(max(kernel) <= 15 and max(strides) <= 15, f"kernel {list(kernel)}, stride {list(strides)}: at most 15")
    y = t.whole(t.layer("max_pool", [layer], (*sizes, layer.shape[2]), kernel=tuple(kernel), stride=tuple(strides),
                        padding=(*before, *after), ceil_mode=ceil_mode), len(x.at))
    return [y.moved(lambda part: part[:, :, 0, :]) if flat else y]


def pool_windows(shape, kernel, strides, before, after, ceil_mode):
    """Sizes of the output, padding behind the map, and ceil mode. A window that ceil mode adds beyond the map does not count, which the
    engine has in padding instead: it never wins."""
    rooms = [b + n + a - k for n, k, b, a in zip(shape, kernel, before, after)]
    require(min(rooms) >= 0, f"a window of {list(kernel)} does not fit on a map of {list(shape)}")
    if not ceil_mode:
        return [room // s + 1 for room, s in zip(rooms, strides)], after, False
    sizes = [-(-room // s) + 1 for room, s in zip(rooms, strides)]
    fits = [(size - 1) * s < n + b for size, s, n, b in zip(sizes, strides, shape, before)]
    if all(fits):
        return sizes, after, True
    sizes = [size if fit else size - 1 for size, fit in zip(sizes, fits)]
    return sizes, [max(a, (size - 1) * s + k - b - n)
                   for a, size, s, k, b, n in zip(after, sizes, strides, kernel, before, shape)], False


def average_pool(t, node):
    """Without padding, or with padding that counts: a depthwise convolution."""
    x, kernel, a = node.inputs[0], node.attributes["kernel_shape"], node.attributes
    require(len(kernel) == 2 and len(x.shape) == 4, f"a pool over {list(kernel)} of {list(x.shape)}")
    strides, dilations = steps_of(a, 2)
    before, after = padding_of(a, x.shape[2:], kernel, strides, dilations)
    require(dilations == [1, 1], "dilations")
    require(not any(before + after) or a.get("count_include_pad", 0), "an average that leaves out its padding")
    exact = all((b + n + e - k) % s == 0 for n, k, s, b, e in zip(x.shape[2:], kernel, strides, before, after))
    require(exact or not a.get("ceil_mode", 0), "ceil_mode")
    if tuple(x.shape[2:]) == tuple(kernel) and not any(before + after):
        return global_average_pool(t, node)
    c = x.shape[1]
    weight = np.full((c, 1, *kernel), 1 / math.prod(kernel))
    return [conv_over_map(t, t.settled(x), weight, np.zeros(c), c, strides, (*before, *after))]


def mean_of(t, x, keepdims=True):
    """[1, c, h, w] -> [1, c, 1, 1]"""
    layer = t.as_map(x)
    if layer.shape[:2] == (1, 1):
        return t.whole(layer, len(x.at))
    return t.whole(t.layer("global_average_pool", [layer], (1, 1, layer.shape[2])), len(x.at))


def global_average_pool(t, node):
    x = node.inputs[0]
    require(len(x.shape) == 4, f"it reads {list(x.shape)}")
    return [mean_of(t, x)]


def global_max_pool(t, node):
    x = node.inputs[0]
    require(len(x.shape) == 4, f"it reads {list(x.shape)}")
    layer = t.as_map(x)
    h, w, c = layer.shape
    require(h <= 15 and w <= 15, f"a map of {h} x {w}: at most 15")
    y = t.layer("max_pool", [layer], (1, 1, c), kernel=(h, w), stride=(1, 1), padding=(0, 0, 0, 0), ceil_mode=False)
    return [t.whole(y, len(x.at))]


def reduce_mean(t, node):
    x, axes = node.inputs[0], axes_of(node.inputs, node.attributes)
    require(len(x.shape) == 4 and axes is not None, f"a mean of {list(x.shape)}")
    axes = sorted(a % 4 for a in axes)
    require(axes in ([2, 3], [1, 2]), f"a mean over axes {axes}")
    y = mean_of(t, x if axes == [2, 3] else x.moved(lambda part: part.transpose(0, 3, 1, 2)))
    y = y if axes == [2, 3] else y.moved(lambda part: part.transpose(0, 2, 3, 1))
    return [y if node.attributes.get("keepdims", 1) else y.moved(lambda part: part.squeeze(tuple(axes)))]


# -- dense layers and cells ------------------------------------------------------------------------------------------------------------

def gemm(t, node):
    a, b = node.inputs[:2]
    require(not is_constant(a), "its first operand is a constant")
    require(not node.attributes.get("transA", 0), "transA")
    weight = constant(b, "second operand").astype(np.float64) * node.attributes.get("alpha", 1.0)
    weight = weight if node.attributes.get("transB", 0) else weight.T
    bias = np.zeros(len(weight))
    if len(node.inputs) > 2 and node.inputs[2] is not None:
        addend = constant(node.inputs[2], "addend") * node.attributes.get("beta", 1.0)
        require(addend.size in (1, len(weight)), f"an addend {list(addend.shape)}")
        bias = bias + addend.reshape(-1)
    return [product(t, a, weight, bias)]


def matmul(t, node):
    a, b = node.inputs
    require(not is_constant(a), "its first operand is a constant")
    weight = constant(b, "second operand").astype(np.float64)
    require(weight.ndim == 2, f"a weight {list(weight.shape)}")
    return [product(t, a, weight.T, np.zeros(weight.shape[1]))]


def product(t, x, weight, bias):
    """[..., n] times weight [out, n]: of one vector, of every step, or at every pixel."""
    rows = x.moved(lambda part: part.reshape(-1, part.shape[-1]))
    require(weight.shape[1] == rows.shape[1], f"{rows.shape[1]} numbers times a weight for {weight.shape[1]}")
    if len(rows.at) <= max(t.steps, 1):
        y = t.whole(t.dense(t.rows(rows), weight, bias), len(rows.at))
        return y.moved(lambda part: part.reshape(*x.shape[:-1], len(weight)))
    return at_every_pixel(t, rows, weight, bias).moved(lambda part: part.reshape(*x.shape[:-1], len(weight)))


def at_every_pixel(t, rows, weight, bias):
    """[h * w, n] times weight [out, n] -> [h * w, out]"""
    numbers = rows.layer_numbers()
    require(len(numbers) > 0, "it reads nothing but constants")
    h, w, _ = t.real(numbers[0]).shape
    require(len(rows.at) == h * w, f"{len(rows.at)} vectors of a map of {h} x {w}")
    x = rows.moved(lambda part: part.T.reshape(1, -1, h, w))
    y = conv_over_map(t, x, weight[:, :, None, None], bias, 1, [1, 1], (0, 0, 0, 0))
    return y.moved(lambda part: part.reshape(len(weight), -1).T)


def lstm(t, node):
    inputs = list(node.inputs) + [None] * (8 - len(node.inputs))
    x, weight_ih, weight_hh, bias, lengths, hidden_0, cell_0, peepholes = inputs
    a, batch_first = node.attributes, node.attributes.get("layout", 0)
    require(t.steps, "an LSTM in a network without time (see --time-axis)")
    require(a.get("direction", "forward") == "forward", f"direction {a.get('direction')}")
    names = [name.lower() for name in a.get("activations", ["sigmoid", "tanh", "tanh"])]
    require(names == ["sigmoid", "tanh", "tanh"] and "clip" not in a and not a.get("input_forget", 0), "a cell of another kind")
    require(peepholes is None, "peepholes")
    require(lengths is None or is_constant(lengths) and (lengths == t.steps).all(), "sequence_lens")
    x = x.moved(lambda part: part.transpose(1, 0, 2)) if batch_first else x
    require(x.shape[1] == 1, f"a batch of {x.shape[1]}")
    require(len(x.at) == t.steps, f"{len(x.at)} steps of {t.steps}")
    size = a["hidden_size"]
    weight_ih, weight_hh = (gates(constant(w, "weight"), size) for w in (weight_ih, weight_hh))
    weight_hh = np.pad(weight_hh, ((0, 0), (0, weight_hh.shape[0] // 4 - size)))
    bias = np.zeros(8 * size) if bias is None else constant(bias, "bias").reshape(-1).astype(np.float64)
    bias = gates((bias[:4 * size] + bias[4 * size:]).reshape(1, -1, 1), size)[:, 0]
    row = t.rows(x.moved(lambda part: part[:, 0]))
    before = t.as_map(Tensor(x.at[:, 0, :, None, None]))
    layer = t.layer("lstm", [before], (1, 1, len(bias) // 4), weight_ih=weight_ih * row.scale, weight_hh=weight_hh,
                    bias=bias + weight_ih @ row.shift)
    cell = t.layer("cell", [layer], layer.shape)
    y, c = (t.whole(one).at[:, :size, 0, 0] for one in (layer, cell))
    for state, following in ((hidden_0, y[-1]), (cell_0, c[-1])):
        begin_cell(t, state, following)
    last = [Tensor(one[-1:].reshape(1, 1, size)) for one in (y, c)]
    return [Tensor(y.reshape(1, -1, 1, size) if batch_first else y.reshape(-1, 1, 1, size)), *last]


def gates(weight, size):
    """[1, 4 size, n] with ONNX's gates i, o, f, c -> [4 size', n] with i, f, c, o, size' a multiple of 8: cells of zeros stay zero."""
    weight = np.asarray(weight, np.float64).reshape(4, size, -1)[[0, 2, 3, 1]]
    return np.pad(weight, ((0, 0), (0, -size % 8), (0, 0))).reshape(-1, weight.shape[2])


def begin_cell(t, state, following):
    if state is None or is_constant(state):
        require(state is None or not state.any(), "its state does not begin with zeros")
        return
    numbers = state.layer_numbers()
    if len(numbers) == 0 and not state.shift.any():
        return
    require(len(numbers) == 1 and t.layers[numbers[0]].op == "state" and state.is_plain() and (state.at >= 0).all(),
            "its state is neither zeros nor an input")
    after = np.full(t.layers[numbers[0]].size, NOTHING, np.int64)
    after[state.at.reshape(-1) & tensors.MASK] = following
    t.states[numbers[0]] = after


MOVES = {"Identity": identity, "Dropout": dropout, "Reshape": reshape, "Flatten": flatten, "Squeeze": squeeze, "Unsqueeze": unsqueeze,
         "Transpose": transpose, "Gather": gather, "Slice": slice_, "Split": split, "Concat": concat, "Shape": shape}
OPERATORS = {
    **MOVES, "Cast": cast, "Pad": pad, "Add": add, "Sum": add, "Sub": subtract, "Mul": multiply, "Div": divide, "Neg": negate,
    "BatchNormalization": batch_norm, "Relu": relu, "LeakyRelu": leaky_relu, "PRelu": prelu, "Sigmoid": sigmoid, "Tanh": tanh, "Clip": clip,
    "HardSigmoid": hard_sigmoid, "Softmax": softmax, "Conv": conv, "MaxPool": max_pool, "AveragePool": average_pool,
    "GlobalAveragePool": global_average_pool, "GlobalMaxPool": global_max_pool, "ReduceMean": reduce_mean, "Gemm": gemm, "MatMul": matmul,
    "LSTM": lstm,
}
