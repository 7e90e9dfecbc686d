"""Translates an ONNX graph, for one interpretation of the axes of its input."""
import itertools
import math

import numpy as np

from .errors import MAX_TOTAL_NUMBERS, Refused, in_a_line, require
from .layers import Network
from .operands import is_constant
from .operators import MOVES, OPERATORS
from .tensors import FUTURE, MASK, NOTHING, Tensor, elements
from .translator import Translator
from .weight_file import MAX_OUTPUTS

DYNAMIC_STEPS = 3  # nominal, if the file leaves it open


OTHER_ADVICE = "replace it with operators of docs/convert.md, or cut the model before it"
ADVICE = {
    "ConvTranspose": "replace it with Resize and Conv",
    "GRU": "replace it with LSTM", "RNN": "replace it with LSTM",
    "Loop": "export the model without control flow", "Scan": "export the model without control flow",
    "NonMaxSuppression": "cut the model before it and do this in your program",
    "TopK": "cut the model before it and do this in your program",
    "ArgMax": "cut the model before it and do this in your program",
    "QLinearConv": "convert the model that is not quantized",
    "DequantizeLinear": "convert the model that is not quantized",
    "QuantizeLinear": "convert the model that is not quantized",
    "ConvInteger": "convert the model that is not quantized",
}
MICROSOFT = {"FusedConv", "Gelu"}  # of ONNX Runtime's optimizer


def operator_of(node):
    if node.domain == "com.microsoft" and node.operator in MICROSOFT:
        return node.operator
    require(node.domain in ("", "ai.onnx"), f"an operator of the domain {node.domain!r}; export the model without it")
    return node.operator


class Guess:
    """An interpretation of the input's axes: the time axis or None, and whether channels are last."""

    def __init__(self, time_axis=None, channels_last=False):
        self.time_axis, self.channels_last = time_axis, channels_last


def guesses(graph, shape, time_axis):
    """Interpretations in the order of attempts. time_axis: None (any), -1 (no time), or the user's."""
    images = [Guess(None, True), Guess()] if len(shape) == 4 and shape[3] and shape[3] <= 4 < (shape[1] or 0) else [
        Guess(), Guess(None, True)]
    plain = images if len(shape) == 4 else [Guess()]
    if time_axis is not None:
        return plain if time_axis < 0 else [Guess(time_axis)]
    dynamic = [axis for axis in range(len(shape)) if shape[axis] is None]
    axes = sorted(range(len(shape)), key=lambda axis: axis not in dynamic)
    over_time = [Guess(axis) for axis in axes if len(shape) >= 2]
    return over_time + plain if graph.has_time() else plain + (over_time if len(shape) == 3 else [])


class Conversion:
    """A graph as layers. `shapes`: of inputs by name, where the file leaves them open."""

    def __init__(self, graph, guess, shapes):
        self.graph, self.guess = graph, guess
        first, *others = graph.inputs
        shape = list(shapes.get(first, graph.inputs[first]))
        require(shape,
                f"input {first!r} has no axes (expected a map, a vector or steps; set its shape with --shape)")
        if guess.time_axis is None:
            steps = 0
            shape = [1 if n is None and axis == 0 else n for axis, n in enumerate(shape)]
        else:
            require(guess.time_axis < len(shape), f"input {first!r} has no axis {guess.time_axis}")
            steps = shape[guess.time_axis] or DYNAMIC_STEPS
            shape[guess.time_axis] = steps
            shape = [n or 1 for n in shape]
        require(all(shape), f"input {first!r} has the shape {shape}: set it with --shape")
        self.t = Translator(graph.opset, steps)
        self.source, values = self.make_source(shape)
        values.update(graph.constants)
        self.state_names = {}
        for name in others:
            require(name not in graph.whole_numbers,
                    f"input {name!r} is an integer, which no layer reads; make it a constant: --value {name}=NUMBER")
            values[name] = self.make_state(name, [n or 1 for n in shapes.get(name, graph.inputs[name])])
        self.run(values)
        self.take_outputs(values)

    def make_source(self, shape):
        """Creates the input as a layer, and its tensor."""
        time, steps = self.guess.time_axis, max(self.t.steps, 1)
        rest = [n for axis, n in enumerate(shape) if axis != time]
        if time is not None or len(shape) <= 2 or (len(shape) == 3 and shape[0] == shape[1] == 1):
            many = [n for n in rest if n != 1]
            require(len(many) <= 1 or len(rest) >= 3 and rest[-3] > 0 and all(n == 1 for n in rest[:-3]),
                    f"an input {shape}")
            c, h, w = rest[-3:] if len(many) > 1 else (many[0] if many else 1, 1, 1)
        elif len(shape) == 3:
            c, h, w = shape[1], 1, shape[2]
        else:
            require(len(shape) == 4, f"an input {shape}")
            c, h, w = shape[1:] if not self.guess.channels_last else (shape[3], *shape[1:3])
        require(time is not None or shape[0] == 1 or len(shape) == 1, f"a batch of {shape[0]}")
        source = self.t.layer("input", [], (h, w, c))
        at = elements(source, steps)
        if time is not None:
            at = np.moveaxis(at.reshape(steps, *rest), 0, time)
        elif self.guess.channels_last:
            at = at.transpose(0, 2, 3, 1)
        return source, {next(iter(self.graph.inputs)): Tensor(at.reshape(shape))}

    def make_state(self, name, shape):
        state = self.t.layer("state", [], (1, 1, math.prod(shape)))
        self.state_names[state.number] = (name, shape)
        return Tensor(elements(state).reshape(shape))

    def run(self, values):
        self.room, self.count = MAX_TOTAL_NUMBERS, 0
        self.run_body(self.graph, values)

    def run_body(self, body, values):
        for node in body.nodes:
            self.t.node = node.name
            count = self.count
            self.count += 1
            try:
                missing = [name for name in node.input_names if name and name not in values]
                require(not missing, f"undefined input {', '.join(map(repr, missing))}")
                node.inputs = [values[name] if name else None for name in node.input_names]
                made = {name: value for name, value in zip(node.outputs, self.take(node, values)) if name}
                require(all(value is not None for value in made.values()), "an input is missing")
                self.room -= sum(map(size, made.values()))
                require(self.room >= 0,
                        f"all tensors so far: at most {MAX_TOTAL_NUMBERS} numbers; reduce --shape or try --any-size")
            except MemoryError as error:
                raise Refused(f"{node.name}: out of memory", count) from error
            except Refused as refusal:
                raise Refused(f"{node.name}: {refusal}", max(count, refusal.progress)) from refusal
            except (ValueError, TypeError, LookupError, AttributeError, ArithmeticError) as error:
                raise Refused(f"{node.name}: it is malformed ({type(error).__name__}: {in_a_line(error)})",
                              count) from error
            values.update(made)

    def take(self, node, values):
        operator = operator_of(node)
        if operator == "Constant":
            return [constant_value(node.attributes)]
        if operator == "If":
            return self.take_branch(node, values)
        if all(x is None or is_constant(x) for x in node.inputs) and operator not in MOVES:
            return self.t.constant(node)
        require(operator in OPERATORS,
                f"the engine has no such layer (opset {self.graph.opset}); {ADVICE.get(operator, OTHER_ADVICE)}")
        outputs = OPERATORS[operator](self.t, node)
        return [constant_if_it_is(x) for x in outputs]

    def take_branch(self, node, values):
        """For an If with a constant condition: removes the other branch."""
        condition, = node.inputs
        require(is_constant(condition) and np.size(condition) == 1,
                "its condition depends on the network's input; export the model with one branch")
        branch = node.attributes["then_branch" if np.reshape(condition, ()) else "else_branch"]
        inner = {**values, **branch.constants}
        self.run_body(branch, inner)
        return [inner[name] for name in branch.outputs]

    def take_outputs(self, values):
        states = dict(self.t.states)
        lost = [name for number, (name, _) in self.state_names.items() if number not in states]
        require(not lost, f"input {', '.join(map(repr, lost))}: a network has one input, and states that a layer keeps")
        self.t.node = "output"
        kept = list(self.graph.outputs)
        for number, following in states.items():
            shape = self.state_names[number][1]
            same = [name for name in kept if same_elements(values.get(name), following, shape)]
            if same:
                kept.remove(same[-1])
        self.outputs = {}
        for name in kept:
            require(name in values, f"output {name!r}: undefined")
            require(not is_constant(values[name]), f"output {name!r} is a constant")
            try:
                layer = self.output_layer(values[name])
            except Refused as refusal:
                raise Refused(f"output {name!r}: {refusal}", len(self.graph.nodes)) from refusal
            require(layer is not self.source, f"output {name!r} is the input")
            self.outputs[name] = layer
        require(self.outputs, "no output except states")

    def output_layer(self, tensor):
        """The layer of an output; creates one in the element order of the ONNX file if necessary."""
        tensor = self.t.settled(tensor)
        numbers = tensor.layer_numbers()
        if len(numbers) == 1 and (tensor.at >= 0).all():
            layer = self.t.real(numbers[0])
            if self.is_whole(layer, tensor.at.reshape(-1) & MASK, len(tensor.shape)):
                return layer
        require(not (tensor.at == FUTURE).any(), "it depends on later steps of the stream")
        if self.t.steps or max(tensor.shape, default=1) == math.prod(tensor.shape):
            return self.t.arranged(tensor)[0]
        if len(tensor.shape) == 4 and tensor.shape[0] == 1:
            return self.t.as_map(
                tensor.moved(lambda part: part.transpose(0, 3, 1, 2) if self.guess.channels_last else part))
        rows = math.prod(tensor.shape[:-1])
        layer = self.t.as_map(tensor.moved(lambda part: part.reshape(1, rows, -1, 1).transpose(0, 2, 1, 3)))
        return self.t.layer("rearrange", [layer], (rows, layer.shape[2], 1), order="hwc")

    def is_whole(self, layer, at, rank):
        """Whether these are all elements of a layer at the last steps of the stream: in its own order, in that of a map
        with channels last, or in any order of a stream's axes."""
        steps, last = np.unique(at // layer.size), max(self.t.steps, 1) - 1
        if at.size != layer.size * len(steps) or steps[-1] != last or steps[0] != last + 1 - len(steps):
            return False
        by_step = at[np.argsort(at // layer.size, kind="stable")].reshape(len(steps), layer.size) % layer.size
        h, w, c = layer.shape
        map_ = np.arange(layer.size).reshape(c, h, w)
        channels_last = self.guess.channels_last and rank == 4
        orders = itertools.permutations(range(3)) if self.t.steps else [(0, 1, 2), (1, 2, 0)][:2 if channels_last
                                                                                              else 1]
        for order in orders:
            if (by_step == map_.transpose(order).reshape(-1)).all():
                if order != (0, 1, 2):
                    self.t.notes.append(f"the output of {layer.node} has its axes in another order in the ONNX file")
                return True
        return False

    def rearranges_source(self):
        layers, seen = list(self.outputs.values()), set()
        while layers:
            layer = layers.pop()
            if layer.op == "rearrange" and layer.inputs[0] is self.source:
                return True
            layers += [x for x in layer.inputs if id(x) not in seen]
            seen.update(map(id, layer.inputs))
        return False

    def network(self):
        layers = list(dict.fromkeys(self.outputs.values()))
        require(len(layers) <= MAX_OUTPUTS,
                f"{len(layers)} outputs; at most {MAX_OUTPUTS}: join some of them by Concat in the model")
        self.positions = {name: layers.index(layer) for name, layer in self.outputs.items()}
        return Network(self.source, layers)


def constant_value(attributes):
    for key in ("value", "value_float", "value_int", "value_floats", "value_ints"):
        if key in attributes:
            value = attributes[key]
            return np.asarray(value, np.float32 if "float" in key else np.int64 if "int" in key else None)
    raise Refused("a constant of an unsupported type")


def size(x):
    return x.at.size if isinstance(x, Tensor) else np.size(x)


def constant_if_it_is(x):
    if isinstance(x, Tensor) and (x.at == NOTHING).all():
        return x.shift
    return np.asarray(x) if isinstance(x, np.generic) else x


def same_elements(value, following, shape):
    return isinstance(value, Tensor) and list(value.shape) == list(shape) and value.is_plain() \
        and (value.at.reshape(-1) == following).all()


def converted(graph, shapes, time_axis=None):
    """The first interpretation that works, or the error of the one that came furthest. Where channels may be last,
    prefers interpretations that do not rearrange the input."""
    furthest = rearranging = None
    for guess in guesses(graph, shapes.get(next(iter(graph.inputs)), next(iter(graph.inputs.values()))), time_axis):
        try:
            with np.errstate(all="ignore"):  # the writer reports what the format does not support
                conversion = Conversion(graph, guess, shapes)
            doubtful = guess.channels_last or graph.puts_channels_first()
            if not doubtful or not conversion.rearranges_source():
                return conversion
            rearranging = rearranging or conversion
        except Refused as refusal:
            if furthest is None or refusal.progress > furthest.progress:
                furthest = refusal
    if rearranging:
        return rearranging
    raise furthest
