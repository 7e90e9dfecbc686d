"""Operators on constants, which exporters leave in shape arithmetic."""
import numpy as np
import onnx

from .errors import Refused, in_a_line, require, require_room

try:
    from onnx.reference import ReferenceEvaluator
except ImportError:  # before onnx 1.13
    ReferenceEvaluator = None

ASSUMED_SIZE = 1 << 10  # assumed for a size that shape inference leaves open
TYPES = {1: np.float32, 6: np.int32, 7: np.int64, 9: np.bool_, 10: np.float16, 11: np.float64}


def axes_of(inputs, attributes, index=1):
    if len(inputs) > index and inputs[index] is not None:
        require(isinstance(inputs[index], np.ndarray), "its axes are not constant")
        return [int(a) for a in inputs[index].reshape(-1)]
    axes = attributes.get("axes")
    return None if axes is None else list(axes)


def constant_of_shape(inputs, attributes):
    value = attributes.get("value")
    value = np.zeros(1, np.float32) if value is None else value
    require_room(*inputs[0])
    return np.full([int(n) for n in inputs[0]], value.reshape(-1)[0])


def cast(inputs, attributes):
    if attributes["to"] not in TYPES:
        raise Refused(f"a cast to type {attributes['to']}")
    return inputs[0].astype(TYPES[attributes["to"]])


def expanded(inputs, _):
    require_room(inputs[0].size, *inputs[1])
    return inputs[0] * np.ones([int(n) for n in inputs[1]], inputs[0].dtype)


def counted(inputs, _):
    first, last, step = (x.reshape(()) for x in inputs)
    require_room(abs((last - first) / step))
    return np.arange(first, last, step)


def divided(inputs, _):
    a, b = inputs
    return a // b if np.issubdtype(a.dtype, np.integer) else a / b


FUNCTIONS = {
    "ConstantOfShape": constant_of_shape, "Cast": cast, "Div": divided,
    "Add": lambda i, a: i[0] + i[1], "Sub": lambda i, a: i[0] - i[1], "Mul": lambda i, a: i[0] * i[1],
    "Neg": lambda i, a: -i[0], "Sqrt": lambda i, a: np.sqrt(i[0]), "Exp": lambda i, a: np.exp(i[0]), "Pow": lambda i,
    a: i[0] ** i[1],
    "Reciprocal": lambda i, a: 1 / i[0], "Floor": lambda i, a: np.floor(i[0]), "Ceil": lambda i, a: np.ceil(i[0]),
    "Abs": lambda i, a: np.abs(i[0]), "Range": counted,
    "Gather": lambda i, a: np.take(i[0], i[1].astype(np.int64), a.get("axis", 0)), "Equal": lambda i, a: i[0] == i[1],
    "Where": lambda i, a: np.where(*i), "Expand": expanded,
    "ReduceProd": lambda i,
    a: np.prod(i[0], tuple(axes_of(i, a)) if axes_of(i, a) else None, keepdims=bool(a.get("keepdims", 1))),
    "Not": lambda i, a: ~i[0], "Greater": lambda i, a: i[0] > i[1], "Less": lambda i, a: i[0] < i[1],
}


def evaluated(node, opset):
    """Evaluates an operator on constants with ONNX's reference, if ONNX's shape inference gives results of moderate
    size."""
    require(ReferenceEvaluator is not None,
            f"onnx {onnx.__version__} computes no constants: pip install 'onnx>=1.15', or fold constants before "
                                            "(onnxsim)")
    given = {name: np.asarray(x) for name, x in zip(node.input_names, node.inputs) if name}
    constants = [onnx.numpy_helper.from_array(x, name) for name, x in given.items()]
    graph = onnx.helper.make_graph([node.proto], "constants", [], [onnx.ValueInfoProto(name=name)
                                                                   for name in node.outputs if name], constants)
    model = onnx.helper.make_model(graph, opset_imports=[onnx.helper.make_opsetid("", opset)])
    try:
        inferred = onnx.shape_inference.infer_shapes(model, data_prop=True)
        for output in inferred.graph.output:
            require_room(*(d.dim_value or ASSUMED_SIZE for d in output.type.tensor_type.shape.dim))
        return [np.asarray(x) for x in ReferenceEvaluator(model).run(None, {})]
    except Refused:
        raise
    except Exception as error:  # whatever the reference raises
        raise Refused(f"it cannot be computed on its constants: {in_a_line(error)}") from error
