"""ONNX graphs that the converter must reject."""
import numpy as np
from graph_case import Case
from onnx import helper
from operator_cases import X, ints, lstm_weights, move_cases, node, weights


def case(name, nodes, shapes, refusal, **options):
    return Case(name, nodes, shapes, refusal=refusal, **options)


def unsupported_cases(w):
    """Valid graphs that the engine cannot run."""
    yield case("conv_transpose", [node("ConvTranspose", "x w")], X,
               "ConvTranspose 'the_convtranspose': the engine has no such layer (opset 13); replace it with Resize and "
               "Conv", constants={"w": weights(10, 4, 3, 3)})
    yield case("gru", [node("GRU", "x w r", "t", hidden_size=4)], {"x": [5, 1, 3]}, "GRU 'the_gru'",
               constants={"w": weights(1, 12, 3), "r": weights(1, 12, 4)})
    yield case("other_domain", [helper.make_node("Fancy", ["x"], ["y"], domain="com.example")], X,
               "an operator of the domain 'com.example'", domains=["com.example"])
    yield case("weights_computed", [node("Relu", "x", "t"), node("MatMul", "x t")], {"x": [4, 4]}, "'the_matmul'",
               arguments=["--time-axis", "0"])
    yield case("softmax_of_all", [node("Softmax", "x", axis=1)], X, "a softmax over axes 1 .. 3 together", opset=11)
    yield case("kernel_17", [node("Conv", "x w")], {"x": [1, 2, 30, 30]}, "at most 15",
               constants={"w": weights(3, 2, 17, 17)})
    yield case("average_without_padding", [node("AveragePool", "x", kernel_shape=[3, 3], pads=[1, 1, 1, 1])], X,
               "leaves out its padding")
    yield case("reflect", [node("Pad", "x p", mode="reflect")], X, "padding of mode 'reflect'",
               constants={"p": ints(0, 0, 1, 1, 0, 0, 1, 1)})
    yield case("pad_with_ones", [node("Pad", "x p one", "t"), node("Conv", "t w")], X, "mixes constants",
               constants={"p": ints(0, 0, 1, 1, 0, 0, 1, 1), "one": np.float32(1), **w})
    yield case("batch", [node("Relu", "x")], {"x": [2, 3, 4, 4]}, "a batch of 2")
    yield case("open_size", [node("Relu", "x")], {"x": [1, 3, None, None]}, "set it with --shape")
    yield case("reverse_lstm", [node("LSTM", "x w r", "t", hidden_size=8, direction="reverse")], {"x": [5, 1, 3]},
               "direction reverse", constants=lstm_weights(3, 8))
    yield case("batched_lstm", [node("LSTM", "x w r", "t", hidden_size=8)], {"x": [5, 2, 3]}, "",
               constants=lstm_weights(3, 8))
    yield case("lstm_other_start", [helper.make_node("LSTM", ["x", "w", "r", "", "", "h"], ["t"],
                                                     hidden_size=8)], {"x": [5, 1, 3]},
               "does not begin with zeros", constants={**lstm_weights(3, 8), "h": np.ones((1, 1, 8), np.float32)})
    yield case("strided_time", [node("Conv", "x w", strides=[2], pads=[1, 0])], {"x": [1, 5, 12]}, "strides over time",
               constants={"w": weights(6, 5, 2)}, arguments=["--time-axis", "2"])
    yield case("future", [node("Conv", "x w", pads=[1, 1])], {"x": [1, 5, 12]}, "later steps of the stream",
               constants={"w": weights(6, 5, 3)}, arguments=["--time-axis", "2"])
    yield case("two_inputs", [node("Add", "x z")], {**X, "z": [1, 10, 9, 7]}, "only its own layer can use")
    yield case("unused_input", [node("Relu", "x")], {**X, "z": [1, 10, 9, 7]}, "input 'z': a network has one input")
    yield case("fifteen_outputs", [node("Tanh", "x", "o0")] + [node("Tanh", f"o{i}", f"o{i + 1}") for i in range(14)],
               X, "15 outputs; at most 14: join some of them by Concat", outputs=[f"o{i}" for i in range(15)])
    yield case("huge_weight", [node("Conv", "x w")], X, "Conv 'the_conv': a weight is too large for fp16",
               constants={"w": np.full((1, 10, 1, 1), 1e6, np.float32)})


def invalid_cases(w):
    """Graphs with errors, or without anything to compute."""
    yield case("output_is_input", [node("Identity", "x")], X, "output 'y' is the input")
    yield case("constant_output", [node("Shape", "x")], X, "output 'y' is a constant")
    yield case("nobody_computes", [node("Relu", "nowhere")], X, "undefined input 'nowhere'")
    yield case("complex_padding", [node("Pad", "x p")], X, "weights 'p' are not real numbers (complex64)",
               constants={"p": np.array([0, 0, 1, 1, 0, 0, 1, 1], np.complex64)})
    yield case("no_size", [node("Relu", "x")], {"x": [0, -2, 1 << 40]}, "set it with --shape")
    yield case("no_input", [helper.make_node("Identity", [""], ["y"], name="the_identity")], X,
               "Identity 'the_identity': an input is missing")
    for opset in (8, 29):
        yield case(f"opset_{opset}", [node("Relu", "x")], X,
                   f"opset: not supported (got {opset}, expected 9 to 28); export the model", opset=opset)
    yield case("attribute_kind", [node("Conv", "x w", pads=1)], X,
               "its attribute 'pads' has the wrong type", constants=w)
    yield case("other_groups", [node("Conv", "x w", group=3)], X, "[6, 10, 3, 3] in 3 groups", constants=w)
    yield case("strides_of_other_axes", [node("Conv", "x w", strides=[2])], X,
               "strides [2], dilations [1, 1] of a window over 2 axes", constants=w)
    yield case("no_stride", [node("MaxPool", "x", kernel_shape=[2, 2], strides=[0, 1])], X,
               "strides [0, 1], dilations [1, 1] of a window")
    yield case("padding_of_other_axes", [node("Conv", "x w", pads=[1, 1])], X,
               "pads: wrong length (got 2, expected 4)", constants=w)


def large_cases(w):
    """Small files that ask for much memory or time."""
    def large(name, nodes, shapes=None, refusal="at most 16777216 numbers", **options):
        return Case(name, nodes, shapes or X, refusal=refusal, **options)
    much = {"n": ints(1 << 30), "p": ints(0, 0, 0, 0, 0, 0, 0, 1 << 30), "zero": np.float32(0), "one": np.float32(1),
            "end": np.float32(1 << 30)}
    yield large("large_input", [node("Relu", "x")], {"x": [1, 10, 1 << 20, 7]})
    yield large("large_dilation", [node("Conv", "x w", dilations=[1 << 20, 1 << 20])], constants=w)
    yield large("large_padding", [node("Pad", "x p")], constants=much)
    yield large("large_constant", [node("ConstantOfShape", "n", "t"), node("Add", "x t")], constants=much)
    yield large("large_expansion", [node("Expand", "one n", "t"), node("Add", "x t")], constants=much)
    yield large("large_range", [node("Range", "zero end one", "t"), node("Add", "x t")], constants=much)
    yield large("large_reversal", [node("Slice", "x last first one_axis back", "t"), node("Relu", "t")],
                {"x": [1, 1 << 20, 1, 1]}, "its channels come from 1048576 pieces",
                constants={"last": ints(-1), "first": ints(-(1 << 31)), "one_axis": ints(1), "back": ints(-1)})
    yield large("large_selection", [node("Gather", "x i", axis=3)], constants={"i": np.zeros(1 << 18, np.int64)})
    doubled = [node("Concat", f"t{i} t{i}" if i else "x x", f"t{i + 1}", axis=1) for i in range(3)]
    yield large("doubled_again_and_again", [*doubled, node("Relu", "t3")], {"x": [1, 10, 512, 512]})
    many = [node("ConstantOfShape", "n", f"t{i}") for i in range(9)]
    yield large("many_large_constants", [*many, node("Add", "x t8")], None, "at most 134217728 numbers",
                constants={"n": ints(1 << 24)})
    yield large("few_of_many", [node("Slice", "x start end axis", "t"), node("Flatten", "t", "u"),
                                node("Gemm", "u w", "y")],
                {"x": [1, 1, 1024, 1024]},
                constants={"start": ints(0), "end": ints(2), "axis": ints(3), "w": weights(2048, 20)})
    backward = {"start": ints(-1), "end": ints(-(1 << 31)), "axis": ints(1), "step": ints(-1)}
    yield large("channels_in_pieces", [node("Slice", "x start end axis step", "t"),
                                       node("Relu", "t")], {"x": [1, 1 << 20, 1, 1]},
                "come from 1048576 pieces; a network has at most 1024 layers", constants=backward)
    yield large("long_future", [node("Conv", "x w", pads=[1, 1 << 20])], {"x": [1, 5, 12]},
                "it depends on later steps of the stream", constants={"w": weights(6, 5, 2)},
                arguments=["--time-axis", "2"])
    yield large("long_memory", [node("Conv", "x w", pads=[100000, 0], dilations=[100000])], {"x": [1, 5, 12]},
                "reaches back 100000 steps; at most 1000", constants={"w": weights(6, 5, 2)},
                arguments=["--time-axis", "2"])


def refused():
    """Cases with a part of the error message."""
    w = {"w": weights(6, 10, 3, 3), "v": weights(4, 5, 3, 3)}
    yield from unsupported_cases(w)
    yield from invalid_cases(w)
    yield from large_cases(w)
    yield from (moved for moved in move_cases() if moved.refusal is not None)
