"""Graphs with patterns of recent networks: products of two results, activations, resized maps, attention heads.
numpy_graph computes the expected outputs."""
import numpy as np
import numpy_graph
from onnx import TensorProto, helper
from operator_cases import IMAGE, VECTOR, Case, floats, ints, node, weights

X = {"x": [1, 10, 8, 6]}


def case(name, nodes, shapes=None, **options):
    return Case(name, nodes, shapes or X, expected=numpy_graph.run, rounds=options.pop("rounds", True), **options)


def product_cases():
    w, s = {"w": weights(10, 10, 1, 1)}, weights(1, 10, 1, 1)
    conv = node("Conv", "x w", "t")
    for operator in ("Mul", "Add", "Sub"):
        yield case(f"{operator.lower()}_of_two", [conv, node(operator, "t x")], constants=w)
        for name, axes in (("pixel", [2, 3]), ("row", [2]), ("column", [3]), ("channel", [1])):
            part = node("ReduceMean", "t", "m", axes=axes, keepdims=1)
            yield case(f"{operator.lower()}_with_one_{name}", [conv, part, node(operator, "x m")], constants=w)
    yield case("mul_by_one_number", [node("ReduceMean", "x", "m", axes=[1, 2, 3]), node("Mul", "m x")])
    yield case("add_of_fewer_axes", [node("ReduceMean", "x", "m", axes=[0, 2, 3], keepdims=0),
                                     node("Reshape", "m s", "r"), node("Add", "r x")],
               constants={"s": ints(10, 1, 1)})
    yield case("square", [node("Mul", "x x")])
    yield case("div_of_two", [conv, node("Exp", "t", "e"), node("Div", "x e")], constants=w)
    yield case("div_constant", [node("Exp", "x", "e"), node("Div", "s e")], constants={"s": s})
    yield case("reciprocal", [node("Exp", "x", "e"), node("Reciprocal", "e")])
    for exponent in (0.5, 1, 2, 3):
        yield case(f"power_{exponent}", [node("Abs", "x", "a"), node("Pow", "a e")],
                   constants={"e": np.float32(exponent)})
    yield case("mul_of_vectors", [node("Sigmoid", "x", "s"), node("Mul", "x s")], VECTOR)
    yield case("mul_of_images", [node("Sigmoid", "x", "s"), node("Mul", "x s")], IMAGE)
    yield case("add_of_other_orders", [node("Transpose", "x", "t", perm=[0, 1, 3, 2]),
                                       node("Add", "t x")], {"x": [1, 10, 7, 7]})


def gate_cases():
    c = {"a": weights(3, 10, 1, 1), "b": weights(3), "c": weights(10, 3, 1, 1), "d": weights(10),
         "w": weights(10, 10, 1, 1)}
    squeeze = [node("Conv", "x w", "t"), node("GlobalAveragePool", "t", "p"), node("Conv", "p a b", "q"),
               node("Relu", "q", "r"), node("Conv", "r c d", "u")]
    yield case("squeeze_and_excite", [*squeeze, node("Sigmoid", "u", "g"), node("Mul", "t g")], constants=c)
    yield case("squeeze_and_excite_hard", [*squeeze, node("HardSigmoid", "u", "g", alpha=1 / 6), node("Mul", "g t")],
               constants=c)
    yield case("spatial_gate", [node("ReduceMean", "x", "m", axes=[1]), node("Sigmoid", "m", "g"), node("Mul", "x g")])


def curve_cases():
    n = {"three": np.float32(3), "six": np.float32(6), "zero": np.float32(0), "root": np.float32(2 ** 0.5),
         "one": np.float32(1), "half": np.float32(0.5), "w": weights(10, 10, 1, 1)}
    conv = node("Conv", "x w", "t")
    for operator in ("Exp", "Erf", "HardSwish"):
        yield case(operator.lower(), [node(operator, "x")], opset=14, rounds=False)
        yield case(operator.lower() + "_after_conv", [conv, node(operator, "t")], opset=14, constants=n)
    yield case("sqrt", [node("Abs", "x", "a"), node("Sqrt", "a")])
    yield case("gelu", [node("Gelu", "x")], opset=20, rounds=False)
    yield case("gelu_tanh", [node("Gelu", "x", approximate="tanh")], opset=20, rounds=False)
    yield case("swish", [node("Swish", "x")], opset=24, rounds=False)
    yield case("swish_steep", [node("Swish", "x", alpha=1.5)], opset=24)
    yield case("elu", [node("Elu", "x", alpha=0.5)])
    yield case("limits", [node("Max", "x zero", "a"), node("Min", "a one")], constants=n)
    clip = node("Clip", "s zero six", "c")
    yield case("swish_in_parts", [conv, node("Sigmoid", "t", "s"), node("Mul", "t s")], constants=n)
    yield case("hard_swish_in_parts", [conv, node("Add", "t three", "s"), clip, node("Div", "c six", "g"),
                                       node("Mul", "t g")], constants=n)
    yield case("hard_swish_divided_last", [conv, node("Add", "t three", "s"), clip, node("Mul", "t c", "m"),
                                           node("Div", "m six")], constants=n)
    yield case("hard_swish_by_hard_sigmoid", [conv, node("HardSigmoid", "t", "g", alpha=1 / 6), node("Mul", "g t")],
               constants=n)
    gelu = [conv, node("Div", "t root", "d"), node("Erf", "d", "e"), node("Add", "e one", "g")]
    yield case("gelu_in_parts", [*gelu, node("Mul", "t g", "m"), node("Mul", "m half")], constants=n)
    yield case("gelu_halved_first", [*gelu, node("Mul", "t half", "h"), node("Mul", "h g")], constants=n)


def size_cases():
    empty = {"roi": floats(), "none": floats()}
    for opset, operator in ((9, "Upsample"), (10, "Resize")):
        for mode in ("nearest", "linear"):
            yield case(f"{operator.lower()}_{mode}", [node(operator, "x s", mode=mode)], opset=opset,
                       constants={"s": floats(1, 1, 2, 3)})
    for grid in ("half_pixel", "pytorch_half_pixel", "asymmetric", "align_corners"):
        for name, sizes in (("larger", (13, 12)), ("smaller", (4, 5)), ("one", (1, 1))):
            options = {"coordinate_transformation_mode": grid}
            size = {"n": ints(1, 10, *sizes), **empty}
            yield case(f"resize_linear_{grid}_{name}", [node("Resize", "x roi none n", mode="linear", **options)],
                       constants=size)
            for rounding in ("round_prefer_floor", "round_prefer_ceil", "floor", "ceil"):
                yield case(f"resize_{grid}_{name}_{rounding}", [node("Resize", "x roi none n", nearest_mode=rounding,
                                                                     **options)], constants=size)
    for opset in (11, 13, 18, 19):
        yield case("resize_by_scales", [node("Resize", "x roi s", mode="linear")], opset=opset,
                   constants={"s": floats(1, 1, 2, 2), **empty})
    sized = [node("Shape", "x", "all"), node("Slice", "all zero two axis", "front"),
             node("Concat", "front size", "n", axis=0),
             node("Resize", "x roi none n", mode="nearest", coordinate_transformation_mode="asymmetric",
                  nearest_mode="floor")]
    yield Case("resize_by_shape", sized, X, rounds=True,
               constants={"zero": ints(0), "two": ints(2), "axis": ints(0), "size": ints(16, 12), **empty},
               expected=lambda _, x: [x.repeat(2, 2).repeat(2, 3)])
    w = {"w": weights(6, 10, 1, 1), "s": floats(1, 1, 2, 2), **empty}
    half = node("Conv", "x v", "h", strides=[2, 2], pads=[0, 0, 0, 0])
    pyramid = [node("Conv", "x w", "t"), half, node("Resize", "h roi s", "u"), node("Add", "t u")]
    yield case("feature_pyramid", pyramid, constants={**w, "v": weights(6, 10, 1, 1)})


def head_cases():
    w = {"w": weights(12, 10, 1, 1), "v": weights(12, 10, 3, 3), "pairs": ints(1, -1, 2), "fours": ints(1, -1, 4)}
    flat = [node("Conv", "x w", "a"), node("Transpose", "a", "b", perm=[0, 2, 3, 1]), node("Reshape", "b pairs", "c"),
            node("Conv", "x v", "d", strides=[2, 2]), node("Transpose", "d", "e", perm=[0, 2, 3, 1]),
            node("Reshape", "e pairs", "f")]
    yield case("detection_head", [*flat, node("Concat", "c f", "g", axis=1), node("Softmax", "g", axis=2)], constants=w)
    yield case("two_heads", [*flat, node("Softmax", "c", "y", axis=-1), node("Sigmoid", "f", "z")],
               outputs=("y", "z", "d"), constants=w)
    priors = {"centre": np.linspace(0, 1, 192).reshape(1, 96, 2).astype(np.float16).astype(np.float32),
              "two": floats(2), "one": ints(2), "i0": ints(0), "i2": ints(2), "i4": ints(4)}
    decode = [node("Conv", "x u", "t"), node("Transpose", "t", "b", perm=[0, 2, 3, 1]), node("Reshape", "b fours", "l"),
              node("Slice", "l i0 i2 one", "xy"), node("Slice", "l i2 i4 one", "wh"), node("Mul", "xy centre", "m"),
              node("Add", "m centre", "at"),
              node("Exp", "wh", "e"), node("Mul", "e centre", "size"), node("Div", "size two", "h"),
              node("Sub", "at h", "low"), node("Add", "at h", "high"), node("Concat", "low high", axis=2)]
    yield case("boxes_from_priors", decode, constants={**w, **priors, "u": weights(8, 10, 1, 1)})
    anchors = {"shape": ints(1, 3, 4, 8, 6), "rows": ints(1, -1, 4)}
    yield case("anchors", [node("Conv", "x w", "t"), node("Reshape", "t shape", "a"),
                           node("Transpose", "a", "b", perm=[0, 1, 3, 4, 2]),
                           node("Reshape", "b rows", "c"), node("Sigmoid", "c")], constants={**w, **anchors})
    many = [node("Conv", "x w", "t"), node("Split", "t", " ".join(f"y{i}" for i in range(12)), axis=1)]
    yield case("twelve_outputs", many, outputs=[f"y{i}" for i in range(12)], constants=w)
    yield case("rows_and_columns_exchanged", [node("Conv", "x w", "t"), node("Transpose", "t", "y", perm=[0, 1, 3, 2])],
               constants=w)
    yield case("conv_of_exchanged", [node("Transpose", "x", "t", perm=[0, 1, 3, 2]), node("Conv", "t v")], constants=w)
    yield case("softmax_of_rows", [node("Softmax", "x", axis=3)])
    yield case("flattened_channels_last", [node("Relu", "x", "r"), node("Transpose", "r", "t", perm=[0, 2, 3, 1]),
                                           node("Flatten", "t")])
    yield case("joined_rows", [node("Relu", "x", "r"), node("Concat", "r x", axis=2)])
    yield case("split_rows", [node("Split", "x", "a b", axis=2), node("Mul", "a b")])


def norm_cases():
    n = {"g": floats(*np.linspace(0.5, 2, 10)), "b": weights(10), "two": np.float32(2), "eps": np.float32(1e-5),
         "w": weights(10, 10, 1, 1)}
    last = node("Transpose", "x", "t", perm=[0, 2, 3, 1])
    yield case("layer_norm", [last, node("LayerNormalization", "t g b", "u", epsilon=1e-6),
                              node("Transpose", "u", perm=[0, 3, 1, 2])], opset=17,
               constants=n)
    yield case("layer_norm_of_vector", [node("LayerNormalization", "x g b", axis=-1)], {"x": [1, 10]}, opset=17,
               constants=n)
    parts = [last, node("ReduceMean", "t", "m", axes=[-1]), node("Sub", "t m", "d"), node("Pow", "d two", "q"),
             node("ReduceMean", "q", "v", axes=[-1]),
             node("Add", "v eps", "o"), node("Sqrt", "o", "r"), node("Div", "d r", "n"), node("Mul", "n g", "s"),
             node("Add", "s b", "a"), node("Transpose", "a", perm=[0, 3, 1, 2])]
    yield case("layer_norm_in_parts", parts, constants=n)
    block = [node("Conv", "x k", "c", group=10, pads=[1, 1, 1, 1]), node("Transpose", "c", "t", perm=[0, 2, 3, 1]),
             node("LayerNormalization", "t g b", "n"), node("MatMul", "n up", "h"), node("Gelu", "h", "e"),
             node("MatMul", "e down", "d"),
             node("Mul", "d g", "s"), node("Transpose", "s", "z", perm=[0, 3, 1, 2]), node("Add", "x z")]
    yield case("convnext_block", block, opset=20,
               constants={**n, "k": weights(10, 1, 3, 3), "up": weights(10, 40), "down": weights(40, 10)})
    for axes in ([2, 3], [1], [2], [3], [1, 2, 3], [1, 3]):
        for keepdims in (0, 1):
            yield case(f"mean_{''.join(map(str, axes))}_{keepdims}", [node("ReduceMean", "x axes", keepdims=keepdims)],
                       opset=18, constants={"axes": ints(*axes)})
    yield case("sum_of_pixels", [node("ReduceSum", "x axes")], constants={"axes": ints(2, 3)})


def opset_cases():
    clip = {"low": np.float32(0), "high": np.float32(6)}
    yield case("relu6_by_attributes", [node("Clip", "x", min=0.0, max=6.0)], opset=9)
    yield case("slice_by_attributes", [node("Slice", "x", axes=[1, 2], starts=[2, 1], ends=[7, 8])], opset=9)
    yield case("pad_by_attributes", [node("Pad", "x", "t", pads=[0, 0, 1, 1, 0, 0, 1, 0]), node("Conv", "t w")],
               opset=9, constants={"w": weights(4, 10, 3, 3)})
    for opset in (9, 10, 19, 21, 23, 25, 28):
        yield case("relu6_of_opset", [node("Conv", "x w", "t"), node("Clip", "t low high") if opset > 10
                                      else node("Clip", "t", min=0.0, max=6.0)],
                   opset=opset, constants={"w": weights(4, 10, 1, 1), **clip})
    fused = helper.make_node("FusedConv", ["x", "w", "b", "z"], ["y"], name="the_fusedconv", domain="com.microsoft",
                             activation="Clip", activation_params=[-0.5, 0.75])
    fused_case = Case("fused_conv", [node("Conv", "x w", "z"), fused], X, domains=["com.microsoft"], rounds=True,
                      expected=fused_answer, constants={"w": weights(4, 10, 1, 1), "b": weights(4)})
    yield fused_case


def fused_answer(case, x):
    conv = np.einsum("oi,bihw->bohw", case.constants["w"][:, :, 0, 0], x.astype(np.float64))
    return [np.clip(2 * conv + case.constants["b"].reshape(1, -1, 1, 1), -0.5, 0.75)]


def branch_cases():
    """If with a known condition."""
    def branch(name, operator):
        output = helper.make_tensor_value_info(f"{name}_y", TensorProto.FLOAT, None)
        return helper.make_graph([helper.make_node(operator, ["t"], [f"{name}_y"])], name, [], [output])
    choice = helper.make_node("If", ["yes"], ["y"], name="the_if", then_branch=branch("a", "Tanh"),
                              else_branch=branch("b", "Sin"))
    yield Case("if", [node("Relu", "x", "t"), node("Equal", "n n", "yes"), choice], X,
               constants={"n": np.array(3, np.int64)}, expected=lambda _, x: [np.tanh(np.maximum(x, 0))])


def accepted():
    for cases in (product_cases, gate_cases, curve_cases, size_cases, head_cases, norm_cases, opset_cases,
                  branch_cases):
        yield from cases()


def refused():
    """Graphs that are slightly different from supported ones, with a part of the error message."""
    def of(name, nodes, refusal, shapes=None, **options):
        return Case(name, nodes, shapes or X, refusal=refusal, **options)
    roi = {"roi": floats(), "s": floats(1, 1, 1.5, 1.5), "n": ints(1, 10, 16, 12)}
    yield of("resize_cubic", [node("Resize", "x roi roi n", mode="cubic")],
             "the mode 'cubic'; nearest and linear are possible", constants=roi)
    yield of("resize_to_fractions", [node("Resize", "x roi s")],
             "whose products are not integers; give sizes", {"x": [1, 10, 7, 6]}, constants=roi)
    yield of("resize_cropped", [node("Resize", "x roi roi n", coordinate_transformation_mode="tf_crop_and_resize")],
             "the coordinate_transformation_mode 'tf_crop_and_resize'", constants=roi)
    yield of("resize_antialiased", [node("Resize", "x roi roi n", mode="linear", antialias=1)],
             "antialias; export the model without it", opset=18, constants=roi)
    yield of("resize_of_channels", [node("Resize", "x roi roi m")], "rows and columns are possible",
             constants={**roi, "m": ints(1, 20, 8, 6)})
    yield of("power_of_a_result", [node("Sigmoid", "x", "s"), node("Pow", "x s")], "its exponent is not a constant")
    yield of("power_pi", [node("Pow", "x e")], "an exponent of 3.14", constants={"e": np.float32(3.140625)})
    yield of("norm_over_axes", [node("LayerNormalization", "x g", axis=1)], "one axis is possible", opset=17,
             constants={"g": np.ones((10, 8, 6), np.float32)})
    unknown = helper.make_node("If", ["c"], ["y"], name="the_if", then_branch=helper.make_graph([], "a", [], []),
                               else_branch=helper.make_graph([], "b", [], []))
    yield of("if_of_input", [node("Relu", "x", "c"), unknown], "its condition depends on the network's input")
    yield of("max_of_two", [node("Relu", "x", "r"), node("Max", "x r")], "it compares tensors; numbers are possible")
