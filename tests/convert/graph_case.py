"""A graph to convert, and the expected result."""
import numpy as np
from onnx import TensorProto, helper, numpy_helper

FLOAT = TensorProto.FLOAT


class Case:
    """shapes: of the inputs by name. arguments: of the converter. feedback: state inputs -> outputs, of a graph of one
    step. rounds: number of times that folded values are rounded to fp16, a factor on the tolerance. first_output:
    (case, x) -> the first output by numpy, if ONNX Runtime does not support the graph. expected: (case, x) -> all
    outputs by numpy, in addition to ONNX Runtime's."""

    def __init__(self, name, nodes, shapes, outputs=("y",), opset=13, constants=None, arguments=(), steps=1,
                 feedback=None, layout="chw", refusal=None, domains=(), rounds=False, first_output=None, expected=None):
        self.name, self.nodes, self.shapes, self.outputs, self.opset = f"{name}_{opset}", nodes, shapes, outputs, opset
        self.constants, self.arguments = constants or {}, list(arguments)
        self.steps, self.feedback = steps, feedback or {}
        self.layout, self.refusal, self.domains, self.rounds = layout, refusal, domains, rounds
        self.first_output, self.expected = first_output, expected
        for i, node in enumerate(nodes[:-1]):  # the last keeps its name, which errors contain
            node.name = f"node_{i}"

    def model(self):
        inputs = [helper.make_tensor_value_info(name, FLOAT, shape) for name, shape in self.shapes.items()]
        outputs = [helper.make_tensor_value_info(name, FLOAT, None) for name in self.outputs]
        constants = [numpy_helper.from_array(np.asarray(value), name) for name, value in self.constants.items()]
        graph = helper.make_graph(self.nodes, "case", inputs, outputs, constants)
        opsets = [helper.make_opsetid("", self.opset)] + [helper.make_opsetid(domain, 1) for domain in self.domains]
        model = helper.make_model(graph, producer_name="operator_cases", opset_imports=opsets)
        model.ir_version = 8
        return model
