"""Reads an ONNX file as nodes with attributes, with any version of the onnx package."""
import warnings

import numpy as np
import onnx
from onnx import numpy_helper

from .errors import Refused, require

OPSETS = range(9, 29)
WHOLE_NUMBERS = (onnx.TensorProto.INT32, onnx.TensorProto.INT64, onnx.TensorProto.BOOL)
MAX_EXTERNAL_BYTES = 1 << 31
# Types of the attributes that operators read; files may contain any.
KINDS = {
    name: kind for kind, names in {
        onnx.AttributeProto.INT: "allowzero antialias axis ceil_mode count_include_pad end exclude_outside group "
                                 "hidden_size input_forget "
                                 "keepdims layout noop_with_empty_axes num_outputs start stash_type to training_mode "
                                 "transA transB value_int",
        onnx.AttributeProto.INTS: "axes dilations ends kernel_shape pads perm split starts strides value_ints",
        onnx.AttributeProto.FLOAT: "alpha beta epsilon max min value_float",
        onnx.AttributeProto.FLOATS: "activation_params scales value_floats",
        onnx.AttributeProto.STRING: "activation approximate auto_pad coordinate_transformation_mode direction "
                                    "keep_aspect_ratio_policy mode "
                                    "nearest_mode",
        onnx.AttributeProto.STRINGS: "activations",
        onnx.AttributeProto.TENSOR: "value",
        onnx.AttributeProto.GRAPH: "then_branch else_branch",
    }.items() for name in names.split()
}
KINDS_OF = {("Pad", "value"): onnx.AttributeProto.FLOAT}  # until opset 10


class Node:
    """folder: the location of weights in other files."""

    def __init__(self, proto, folder):
        self.proto = proto
        self.operator, self.outputs = proto.op_type, list(proto.output)
        self.input_names = list(proto.input)
        name = repr(proto.name) if proto.name else "-> " + ", ".join(map(repr, self.outputs))
        self.name = f"{proto.op_type} {name}"
        self.domain = proto.domain
        for a in proto.attribute:
            kind = KINDS_OF.get((proto.op_type, a.name), KINDS.get(a.name, a.type))
            require(a.type == kind, f"{self.name}: its attribute {a.name!r} has the wrong type")
        self.attributes = {a.name: attribute(a, folder) for a in proto.attribute}
        self.inputs = []


def attribute(proto, folder):
    value = onnx.helper.get_attribute_value(proto)
    if isinstance(value, onnx.TensorProto):
        return array(value, folder)
    if isinstance(value, onnx.GraphProto):
        return Body(value, folder)
    if isinstance(value, bytes):
        return value.decode()
    return [v.decode() if isinstance(v, bytes) else v
            for v in value] if isinstance(value, (list, tuple)) or hasattr(value, "append") else value


def array(proto, folder):
    if proto.data_location == onnx.TensorProto.EXTERNAL:
        proto = with_external_data(proto, folder)
    try:
        values = numpy_helper.to_array(proto)
        values = values.astype(np.float32) if values.dtype.name == "bfloat16" else values
    except Exception as error:  # several kinds, by version
        raise Refused(f"weights {proto.name!r} are malformed: {error}") from error
    require(values.dtype.kind in "biuf", f"weights {proto.name!r} are not real numbers ({values.dtype})")
    return values


def with_external_data(proto, folder):
    """The same weights with the bytes of a file beside the model's."""
    entries = {entry.key: entry.value for entry in proto.external_data}
    name, location = f"weights {proto.name!r}", entries.get("location", "")
    path = (folder / location).resolve()
    require(location and path.is_relative_to(folder.resolve()),
            f"{name}: their file lies outside the model's folder (got {location!r})")
    require(path.is_file(), f"{name}: no file {location!r} beside the model; copy it there")
    offset, length = (entries.get(key, default)
                      for key, default in (("offset", "0"), ("length", str(path.stat().st_size))))
    require(offset.isdigit() and length.isdigit(),
            f"{name}: a part of {location!r} that is no number (offset {offset!r}, length {length!r})")
    offset, length = int(offset), int(length)
    require(length <= MAX_EXTERNAL_BYTES,
            f"{name}: too large (got {length} bytes, expected at most {MAX_EXTERNAL_BYTES})")
    with open(path, "rb") as file:
        file.seek(min(offset, path.stat().st_size))
        data = file.read(length)
    require(len(data) == length,
            f"{name}: {location!r} is too short (got {path.stat().st_size} bytes, expected {offset + length})")
    whole = onnx.TensorProto()
    whole.CopyFrom(proto)
    del whole.external_data[:]
    whole.data_location, whole.raw_data = onnx.TensorProto.DEFAULT, data
    return whole


class Body:
    """The nodes of a graph, or of one branch of an If."""

    def __init__(self, graph, folder):
        self.constants = {p.name: array(p, folder) for p in graph.initializer}
        self.outputs = [o.name for o in graph.output]
        self.nodes = [Node(proto, folder) for proto in graph.node]


class Graph(Body):
    def __init__(self, path):
        model = loaded(path)
        graph = model.graph
        require(len(graph.node) > 0, "not an ONNX file, or one without nodes")
        versions = {o.domain: o.version for o in model.opset_import}
        self.opset = versions.get("", versions.get("ai.onnx", 0))
        require(self.opset in OPSETS,
                f"opset: not supported (got {self.opset}, expected {OPSETS[0]} to {OPSETS[-1]}); export the model with "
                "one of these")
        self.producer = f"{model.producer_name} {model.producer_version}".strip()
        super().__init__(graph, path.parent)
        self.inputs = {i.name: dimensions(i) for i in graph.input if i.name not in self.constants}
        self.whole_numbers = {i.name for i in graph.input if i.type.tensor_type.elem_type in WHOLE_NUMBERS}
        require(self.inputs, "the graph has no input")

    def fix(self, name, number):
        """Replaces an input by a constant."""
        shape = self.inputs.pop(name)
        require(self.inputs, f"input {name!r} is the only one")
        require(all(n in (None, 1) for n in shape), f"input {name!r}: not a single number (got a shape {shape})")
        kind = np.int64 if name in self.whole_numbers else np.float32
        require(kind is np.float32 or number == int(number), f"input {name!r}: not a whole number (got {number})")
        self.constants[name] = np.full([1] * len(shape), number, kind)

    def puts_channels_first(self):
        """Whether it reads its input with channels last."""
        first = next(iter(self.inputs))
        readers = [node for node in self.nodes if first in node.input_names]
        return all(node.operator == "Transpose" and list(node.attributes.get("perm", [])) == [0, 3, 1, 2]
                   for node in readers)

    def has_time(self):
        """Whether it seems to process a stream: it has a recurrent cell, or convolutions that only see the past."""
        def causal(node):
            pads = node.attributes.get("pads", [])
            return node.operator == "Conv" and len(pads) == 2 and pads[0] > 0 == pads[1]
        return any(node.operator in ("LSTM", "GRU", "RNN") or causal(node) for node in self.nodes)


def loaded(path):
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # the warning about a file that can only be read in part
            model = onnx.load(str(path), load_external_data=False)
    except Exception as error:  # the type depends on the version of protobuf
        raise Refused(f"not an ONNX file: {error}") from error
    return inlined(model) if len(model.functions) else model


def inlined(model):
    """The model with its local functions inlined."""
    try:
        from onnx.inliner import inline_local_functions
    except ImportError as error:
        raise Refused(
            f"the model has functions of its own ({model.functions[0].name!r}), which onnx {onnx.__version__} cannot "
            "inline: "
                      "pip install 'onnx>=1.15'") from error
    try:
        return inline_local_functions(model)
    except Exception as error:  # malformed functions, in several ways
        raise Refused(f"the model's functions cannot be inlined: {error}") from error


def dimensions(value):
    """None where a dimension is not a number."""
    kind = value.type.WhichOneof("value")
    require(kind == "tensor_type", f"input {value.name!r}: not a tensor (got {kind or 'no type'})")
    # A missing value is 0; some exporters write -1.
    return [d.dim_value if d.dim_value > 0 else None for d in value.type.tensor_type.shape.dim]
