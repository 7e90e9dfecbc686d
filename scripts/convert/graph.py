"""An ONNX file as nodes with attributes, and its translation, for one guess at what the axes of its input mean."""
import itertools
import math
import warnings

import numpy as np
import onnx
from onnx import numpy_helper

from layers import Network
from operators import MOVES, OPERATORS, is_constant
from refusal import MOST_IN_ALL, Refused, in_a_line, require
from tensors import FUTURE, MASK, NOTHING, Tensor, elements
from translator import Translator

OPSETS = range(11, 19)
DYNAMIC_STEPS = 3  # nominal, where the file does not say how many
# What the attributes that operators read are; in a file they may be anything.
KINDS = {
    name: kind for kind, names in {
        onnx.AttributeProto.INT: "allowzero axis ceil_mode count_include_pad end group hidden_size input_forget keepdims layout start to "
                                 "training_mode transA transB value_int",
        onnx.AttributeProto.INTS: "axes dilations kernel_shape pads perm split strides value_ints",
        onnx.AttributeProto.FLOAT: "alpha beta epsilon value_float",
        onnx.AttributeProto.FLOATS: "value_floats",
        onnx.AttributeProto.STRING: "auto_pad direction mode",
        onnx.AttributeProto.STRINGS: "activations",
        onnx.AttributeProto.TENSOR: "value",
    }.items() for name in names.split()
}


class Node:
    def __init__(self, proto):
        self.operator, self.outputs = proto.op_type, list(proto.output)
        self.input_names = list(proto.input)
        self.name = f"{proto.op_type} {proto.name!r}" if proto.name else f"{proto.op_type} -> {', '.join(map(repr, self.outputs))}"
        self.domain = proto.domain
        for a in proto.attribute:
            require(a.type == KINDS.get(a.name, a.type), f"{self.name}: its attribute {a.name!r} is of another kind than ONNX says")
        self.attributes = {a.name: attribute(a) for a in proto.attribute}
        self.inputs = []


def attribute(proto):
    value = onnx.helper.get_attribute_value(proto)
    if isinstance(value, onnx.TensorProto):
        return array(value)
    if isinstance(value, bytes):
        return value.decode()
    return [v.decode() if isinstance(v, bytes) else v for v in value] if isinstance(value, (list, tuple)) or hasattr(value, "append") else value


def array(proto):
    require(proto.data_location != onnx.TensorProto.EXTERNAL, f"weights {proto.name!r} lie in another file")
    try:
        values = numpy_helper.to_array(proto)
    except Exception as error:  # several kinds, by version
        raise Refused(f"weights {proto.name!r} are malformed: {error}") from error
    require(values.dtype.kind in "biuf", f"weights {proto.name!r} are no real numbers ({values.dtype})")
    return values


class Graph:
    def __init__(self, path):
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")  # all there is of a file that could be read in part only
                model = onnx.load(str(path), load_external_data=False)
        except Exception as error:  # what protobuf raises depends on its version
            raise Refused(f"not an ONNX file: {error}") from error
        graph = model.graph
        require(len(graph.node) > 0, "not an ONNX file, or one without nodes")
        versions = {o.domain: o.version for o in model.opset_import}
        self.opset = versions.get("", versions.get("ai.onnx", 0))
        require(self.opset in OPSETS, f"opset {self.opset}; {OPSETS[0]} to {OPSETS[-1]} are taken")
        self.producer = f"{model.producer_name} {model.producer_version}".strip()
        self.constants = {p.name: array(p) for p in graph.initializer}
        self.inputs = {i.name: dimensions(i) for i in graph.input if i.name not in self.constants}
        self.outputs = [o.name for o in graph.output]
        self.nodes = [Node(proto) for proto in graph.node]
        require(self.inputs, "the graph has no input")

    def has_time(self):
        """Whether it looks as if its steps came one by one: a cell, or a convolution that sees the past only."""
        def causal(node):
            pads = node.attributes.get("pads", [])
            return node.operator == "Conv" and len(pads) == 2 and pads[0] > 0 == pads[1]
        return any(node.operator in ("LSTM", "GRU", "RNN") or causal(node) for node in self.nodes)


def dimensions(value):
    """None where a dimension is not a number."""
    kind = value.type.WhichOneof("value")
    require(kind == "tensor_type", f"input {value.name!r} is no tensor (but a {kind or 'value without a type'})")
    # Not said is 0; some exporters say -1.
    return [d.dim_value if d.dim_value > 0 else None for d in value.type.tensor_type.shape.dim]


class Guess:
    """What the axes of the input are: the time axis or None, and whether channels come last."""

    def __init__(self, time_axis=None, channels_last=False):
        self.time_axis, self.channels_last = time_axis, channels_last


def guesses(graph, shape, time_axis):
    """In the order in which they are tried. time_axis: None (any), -1 (no time), or what the user says."""
    images = [Guess(None, True), Guess()] if len(shape) == 4 and shape[3] and shape[3] <= 4 < (shape[1] or 0) else [Guess(), Guess(None, True)]
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
        require(shape, f"input {first!r} has no axes: a network's input is a map, a vector or steps; say which with --shape")
        if guess.time_axis is None:
            steps = 0
            shape = [1 if n is None and axis == 0 else n for axis, n in enumerate(shape)]
        else:
            require(guess.time_axis < len(shape), f"input {first!r} has no axis {guess.time_axis}")
            steps = shape[guess.time_axis] or DYNAMIC_STEPS
            shape[guess.time_axis] = steps
            shape = [n or 1 for n in shape]
        require(all(shape), f"input {first!r} has the shape {shape}: say which with --shape")
        self.t = Translator(graph.opset, steps)
        self.source, values = self.make_source(shape)
        values.update(graph.constants)
        self.state_names = {}
        for name in others:
            values[name] = self.make_state(name, [n or 1 for n in shapes.get(name, graph.inputs[name])])
        self.run(values)
        self.take_outputs(values)

    def make_source(self, shape):
        """The input as a layer, and the tensor that it is."""
        time, steps = self.guess.time_axis, max(self.t.steps, 1)
        rest = [n for axis, n in enumerate(shape) if axis != time]
        if time is not None or len(shape) <= 2 or (len(shape) == 3 and shape[0] == shape[1] == 1):
            many = [n for n in rest if n != 1]
            require(len(many) <= 1 or len(rest) >= 3 and rest[-3] > 0 and all(n == 1 for n in rest[:-3]), f"an input {shape}")
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
        room = MOST_IN_ALL
        for count, node in enumerate(self.graph.nodes):
            self.t.node = node.name
            try:
                missing = [name for name in node.input_names if name and name not in values]
                require(not missing, f"nobody computes its input {', '.join(map(repr, missing))}")
                node.inputs = [values[name] if name else None for name in node.input_names]
                made = {name: value for name, value in zip(node.outputs, self.take(node)) if name}
                require(all(value is not None for value in made.values()), "an input is missing")
                room -= sum(map(size, made.values()))
                require(room >= 0, f"all tensors up to here: at most {MOST_IN_ALL} numbers; a smaller --shape and --any-size may do")
            except MemoryError as error:
                raise Refused(f"{node.name}: it takes more memory than there is", count) from error
            except Refused as refusal:
                raise Refused(f"{node.name}: {refusal}", count) from refusal
            except (ValueError, TypeError, LookupError, AttributeError, ArithmeticError) as error:
                raise Refused(f"{node.name}: it is malformed ({type(error).__name__}: {in_a_line(error)})", count) from error
            values.update(made)

    def take(self, node):
        require(node.domain in ("", "ai.onnx"), f"an operator of the domain {node.domain!r}")
        if node.operator == "Constant":
            return [constant_value(node.attributes)]
        if all(x is None or is_constant(x) for x in node.inputs) and node.operator not in MOVES:
            return self.t.constant(node.operator, node.inputs, node.attributes)
        require(node.operator in OPERATORS, f"the engine has no such layer (opset {self.graph.opset})")
        outputs = OPERATORS[node.operator](self.t, node)
        return [constant_if_it_is(x) for x in outputs]

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
            require(name in values, f"output {name!r}: nobody computes it")
            require(not is_constant(values[name]), f"output {name!r} is a constant")
            try:
                layer = self.output_layer(values[name])
            except Refused as refusal:
                raise Refused(f"output {name!r}: {refusal}", len(self.graph.nodes)) from refusal
            require(layer is not self.source, f"output {name!r} is the input")
            self.outputs[name] = layer
        require(self.outputs, "nothing but states comes out")

    def output_layer(self, tensor):
        """The layer that an output is, whatever its shape; else one that is made for it."""
        tensor = self.t.settled(tensor)
        numbers = tensor.layer_numbers()
        if len(numbers) == 1 and (tensor.at >= 0).all():
            layer = self.t.real(numbers[0])
            if self.is_whole(layer, tensor.at.reshape(-1) & MASK):
                return layer
        require(not (tensor.at == FUTURE).any(), "it holds steps that have not come")
        return self.t.arranged(tensor)[0]

    def is_whole(self, layer, at):
        """Whether these are all elements of a layer at the last steps of the stream, in some order of its axes."""
        steps, last = np.unique(at // layer.size), max(self.t.steps, 1) - 1
        if at.size != layer.size * len(steps) or steps[-1] != last or steps[0] != last + 1 - len(steps):
            return False
        by_step = at[np.argsort(at // layer.size, kind="stable")].reshape(len(steps), layer.size) % layer.size
        h, w, c = layer.shape
        map_ = np.arange(layer.size).reshape(c, h, w)
        for order in itertools.permutations(range(3)):
            if (by_step == map_.transpose(order).reshape(-1)).all():
                if order != (0, 1, 2):
                    self.t.notes.append(f"the output of {layer.node} has its axes in another order in the ONNX file")
                return True
        return False

    def network(self):
        layers = list(dict.fromkeys(self.outputs.values()))
        require(len(layers) <= 4, f"{len(layers)} outputs; at most 4")
        self.positions = {name: layers.index(layer) for name, layer in self.outputs.items()}
        return Network(self.source, layers)


def constant_value(attributes):
    for key in ("value", "value_float", "value_int", "value_floats", "value_ints"):
        if key in attributes:
            value = attributes[key]
            return np.asarray(value, np.float32 if "float" in key else np.int64 if "int" in key else None)
    raise Refused("a constant of another kind")


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
    """The first guess that works, or what stopped the one that came furthest."""
    furthest = None
    for guess in guesses(graph, shapes.get(next(iter(graph.inputs)), next(iter(graph.inputs.values()))), time_axis):
        try:
            with np.errstate(all="ignore"):  # what the format cannot hold, its writer refuses
                return Conversion(graph, guess, shapes)
        except Refused as refusal:
            if furthest is None or refusal.progress > furthest.progress:
                furthest = refusal
    raise furthest
