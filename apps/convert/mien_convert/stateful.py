"""ONNX operators with state in a stream: convolutions that only see the past, and LSTMs."""
import numpy as np

from . import tensors
from .errors import require, require_room
from .operands import constant, is_constant
from .tensors import FUTURE, NOTHING, Tensor

MAX_DELAYS = 1000  # for one convolution: each becomes a layer, and a file has at most 1024


def conv_over_time(t, x, weight, bias, before, after, dilation):
    """[1, c, t]: steps of the stream, between columns before and columns after them."""
    require(x.shape[0] == 1, f"a batch of {x.shape[0]}")
    reach = (weight.shape[2] - 1) * dilation
    require(0 <= reach <= MAX_DELAYS, f"a convolution that reaches back {reach} steps; at most {MAX_DELAYS}")
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
    """The number of columns before the stream's steps, and of steps."""
    # the last: NOTHING and FUTURE, whose number is -1
    told = np.array([layer.op != "state" for layer in t.layers] + [False])
    real = told[at >> tensors.BITS].any(0)
    require(real.any(), "all its inputs are constants")
    first, last = np.flatnonzero(real)[[0, -1]]
    require(real[first:last + 1].all() and ((at[:, last + 1:] == NOTHING) | (at[:, last + 1:] == FUTURE)).all(),
            "it mixes steps of time")
    return int(first), int(last + 1 - first)


def begins_with(t, past, scale, shift):
    """Whether the columns before the stream are zeros or states, with this scale and shift."""
    scale, shift = (np.broadcast_to(n, past.shape[:1])[:, None] for n in (scale, shift))
    state = past.at >= 0
    return ((past.shift == shift) & ((past.scale == scale) | ~state)).all()


def remember(t, at, past, real):
    """The last columns become the states before the next steps."""
    for number in np.unique(at[:, :past][at[:, :past] >= 0] >> tensors.BITS):
        following = np.full(t.layers[number].size, NOTHING, np.int64)
        channel, column = np.nonzero((at >> tensors.BITS == number) & (at >= 0))
        following[at[channel, column] & tensors.MASK] = at[channel, column + real]
        t.states[int(number)] = following


def causal(t, x, weight, bias, dilation):
    """The engine's convolution has kernel 2 and no dilation; other convolutions store past steps side by side."""
    inputs, taps = weight.shape[1:]
    if taps == 1:
        return t.layer("fully_connected", [x], (1, 1, len(bias)), weight=weight[:, :, 0], bias=bias)
    if taps == 2 and dilation == 1:
        return t.layer("causal_conv", [x], (1, 1, len(bias)), weight=weight, bias=bias)
    t.notes.append(f"{t.node}: kernel {taps}, dilation {dilation} over time uses {(taps - 1) * dilation} delays")
    delay = np.zeros((inputs, inputs, 2))
    delay[:, :, 0] = np.eye(inputs)
    before, kept, rows = x, x, [weight[:, :, -1]]
    for step in range(1, (taps - 1) * dilation + 1):
        before = t.layer("causal_conv", [before], x.shape, weight=delay, bias=np.zeros(inputs))
        if step % dilation == 0:
            kept = t.layer("concat", [kept, before], (1, 1, kept.shape[2] + inputs))
            rows.append(weight[:, :, -1 - step // dilation])
    return t.layer("fully_connected", [kept], (1, 1, len(bias)), weight=np.concatenate(rows, 1), bias=bias)


def lstm(t, node):
    inputs = list(node.inputs) + [None] * (8 - len(node.inputs))
    x, weight_ih, weight_hh, bias, lengths, hidden_0, cell_0, peepholes = inputs
    a, batch_first = node.attributes, node.attributes.get("layout", 0)
    require(t.steps, "an LSTM in a network without time (see --time-axis)")
    require(a.get("direction", "forward") == "forward", f"direction {a.get('direction')}")
    names = [name.lower() for name in a.get("activations", ["sigmoid", "tanh", "tanh"])]
    require(names == ["sigmoid", "tanh", "tanh"] and "clip" not in a and not a.get("input_forget", 0),
            "unsupported options of the cell")
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
    """[1, 4 size, n] with ONNX's gates i, o, f, c -> [4 size', n] with i, f, c, o, where size' is a multiple of 8:
    cells of zeros stay zero."""
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
