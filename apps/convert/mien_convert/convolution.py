"""ONNX operators with windows that slide over a map, and global pooling."""
import math

import numpy as np

from . import tensors
from .activations import clip, hard_sigmoid, leaky_relu, relu, sigmoid, tanh
from .arithmetic import add_two
from .constants import axes_of
from .errors import Refused, require, require_room
from .layers import slid
from .operands import constant
from .stateful import conv_over_time
from .tensors import NOTHING, Tensor


def steps_of(attributes, count):
    """Strides and dilations of a window over that many axes."""
    strides, dilations = (attributes.get(key, [1] * count) for key in ("strides", "dilations"))
    require(len(strides) == len(dilations) == count and min(strides + dilations) > 0,
            f"strides {strides}, dilations {dilations} of a window over {count} axes")
    return strides, dilations


def padding_of(attributes, sizes, kernel, strides, dilations):
    """([before...], [after...]): padding by pads or auto_pad."""
    mode, count = attributes.get("auto_pad", "NOTSET"), len(sizes)
    if mode in ("NOTSET", ""):
        pads = attributes.get("pads", [0] * 2 * count)
        require(len(pads) == 2 * count, f"pads: wrong length (got {len(pads)}, expected {2 * count})")
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
    """An equal convolution without dilations, with zeros between its taps."""
    if all(d == 1 for d in dilations):
        return weight
    size = [(k - 1) * d + 1 for k, d in zip(weight.shape[2:], dilations)]
    require_room(*weight.shape[:2], *size)
    wide = np.zeros((*weight.shape[:2], *size))
    wide[(slice(None), slice(None), *(slice(None, None, d) for d in dilations))] = weight
    return wide


def ungrouped(weight, groups):
    """An equal convolution without groups, with zeros between the groups."""
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
            f"it reads {list(x.shape)} with a weight {list(weight.shape)}"
            + (f" in {groups} groups" if groups != 1 else ""))
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
        return t.whole(t.layer("fully_connected", [layer], out, weight=weight.reshape(len(weight), -1), bias=bias),
                       len(x.at))
    require(max(kernel) <= 15 and max(stride) <= 15, f"kernel {list(kernel)}, stride {list(stride)}: at most 15")
    require(all(p < k for p, k in zip(padding, kernel * 2)),
            f"padding {list(padding)} as large as the kernel {list(kernel)}")
    operation = "depthwise" if depthwise else "conv2d"
    return t.whole(t.layer(operation, [layer], out, weight=weight, bias=bias, stride=stride, padding=padding),
                   len(x.at))


def folded_into_conv(t, x, weight, bias, depthwise, padded):
    """Folds a pending scale and shift into the weights; a shift only if the window reads no padding."""
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


def max_pool(t, node):
    require(len(node.outputs) == 1 or not node.outputs[1], "its second output, the places of the largest values")
    x, kernel = node.inputs[0], node.attributes["kernel_shape"]
    require(len(x.shape) - 2 == len(kernel) <= 2 and not (t.steps and len(kernel) == 1),
            f"a pool over {list(kernel)} of {list(x.shape)}")
    strides, dilations = steps_of(node.attributes, len(kernel))
    require(all(d == 1 for d in dilations), "dilations")
    before, after = padding_of(node.attributes, x.shape[2:], kernel, strides, dilations)
    flat = len(kernel) == 1
    if flat:
        x = x.moved(lambda part: part[:, :, None, :])
        kernel, strides, before, after = [1, *kernel], [1, *strides], [0, *before], [0, *after]
    layer = t.as_map(x)
    sizes, after, ceil_mode = pool_windows(layer.shape[:2], kernel, strides, before, after,
                                           node.attributes.get("ceil_mode", 0))
    require(max(kernel) <= 15 and max(strides) <= 15, f"kernel {list(kernel)}, stride {list(strides)}: at most 15")
    y = t.whole(t.layer("max_pool", [layer], (*sizes, layer.shape[2]), kernel=tuple(kernel), stride=tuple(strides),
                        padding=(*before, *after), ceil_mode=ceil_mode), len(x.at))
    return [y.moved(lambda part: part[:, :, 0, :]) if flat else y]


def pool_windows(shape, kernel, strides, before, after, ceil_mode):
    """Sizes of the output, padding at the end, and ceil mode. ONNX ignores a window that ceil mode adds beyond the map;
    in the engine it lies in the padding and never holds the maximum."""
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
    """A depthwise convolution, which is correct without padding, or if the mean includes the padding."""
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
    rank = len(x.shape)
    if axes is None or not axes:
        if node.attributes.get("noop_with_empty_axes", 0):
            return [x]
        axes = range(rank)
    axes = sorted({axis % rank for axis in axes})
    return [mean_over(t, x, axes, node.attributes.get("keepdims", 1))]


def mean_over(t, x, axes, keepdims):
    kept = [axis for axis in range(len(x.shape)) if axis not in axes]
    shape = [x.shape[axis] if axis in kept else 1 for axis in range(len(x.shape)) if keepdims or axis in kept]
    if len(x.shape) == 4 and axes in ([2, 3], [1, 2]):
        y = mean_of(t, x if axes == [2, 3] else x.moved(lambda part: part.transpose(0, 3, 1, 2)))
        return y.moved(lambda part: part.reshape(shape))
    require(not t.steps, f"a mean over axes {axes} of {list(x.shape)} over time")
    count = math.prod(x.shape[axis] for axis in axes)
    y = mean_of(t, x.moved(lambda part: part.transpose(kept + axes).reshape(1, -1, count, 1)))
    return y.moved(lambda part: part.reshape(shape))


def reduce_sum(t, node):
    x, axes = node.inputs[0], axes_of(node.inputs, node.attributes)
    mean, = reduce_mean(t, node)
    return [t.affine(mean, math.prod(x.shape) / max(math.prod(mean.shape), 1), 0.0) if axes or mean is not x else x]


def fused_conv(t, node):
    """Fused by ONNX Runtime's optimizer: a convolution, a sum, an activation."""
    inputs = [*node.inputs, None, None]
    y, = conv(t, Part(node, inputs[:3]))
    if inputs[3] is not None:
        y = add_two(t, y, inputs[3])
    name, values = node.attributes.get("activation", ""), list(node.attributes.get("activation_params", []))
    if not name:
        return [y]
    require(name in FUSED, f"the activation {name!r}; {', '.join(FUSED)} are possible")
    function, keys = FUSED[name]
    return function(t, Part(node, [y], dict(zip(keys, values))))


class Part:
    """A node that represents a part of another."""

    def __init__(self, node, inputs, attributes=None):
        self.inputs = inputs
        self.outputs = node.outputs[:1]
        self.attributes = node.attributes if attributes is None else attributes


FUSED = {"Relu": (relu, ()), "Sigmoid": (sigmoid, ()), "Tanh": (tanh, ()), "LeakyRelu": (leaky_relu, ("alpha",)),
         "Clip": (clip, ("min", "max")), "HardSigmoid": (hard_sigmoid, ("alpha", "beta"))}
