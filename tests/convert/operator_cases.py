"""ONNX graphs of one or a few operators, built by hand in several opsets."""
import numpy as np
from graph_case import Case
from onnx import helper, numpy_helper

OPSETS = (11, 13, 15, 18)


random = np.random.default_rng(7)


def node(operator, inputs, outputs="y", **attributes):
    return helper.make_node(operator, inputs.split(), outputs.split(), name=f"the_{operator.lower()}", **attributes)


def weights(*shape):
    """Values that fp16 represents exactly, so that results can be compared with a small tolerance."""
    fan_in = max(int(np.prod(shape[1:])), 1)
    return (random.standard_normal(shape) / np.sqrt(fan_in)).astype(np.float16).astype(np.float32)


def ints(*values):
    return np.array(values, np.int64)


def floats(*values):
    return np.array(values, np.float32)


X = {"x": [1, 10, 9, 7]}
IMAGE = {"x": [1, 3, 9, 7]}
VECTOR = {"x": [1, 13]}


def conv_cases():
    w = {"w": weights(6, 10, 3, 3), "b": weights(6)}
    image = {"w": weights(6, 3, 3, 3), "b": weights(6)}
    yield Case("conv", [node("Conv", "x w b", pads=[1, 1, 1, 1])], X, constants=w)
    yield Case("conv_of_image", [node("Conv", "x w b", strides=[2, 2])], IMAGE, constants=image)
    yield Case("conv_asymmetric", [node("Conv", "x w b", pads=[0, 1, 2, 0], strides=[2, 1])], X, constants=w)
    yield Case("conv_dilated", [node("Conv", "x w", dilations=[2, 3])], X, constants=w)
    for mode in ("SAME_UPPER", "SAME_LOWER", "VALID"):
        yield Case(f"conv_{mode.lower()}", [node("Conv", "x w b", auto_pad=mode, strides=[2, 3])], X, constants=w)
    yield Case("conv_depthwise", [node("Conv", "x w b", group=10, pads=[1, 1, 1, 1], strides=[2, 2])], X,
               constants={"w": weights(10, 1, 3, 3), "b": weights(10)})
    yield Case("conv_groups", [node("Conv", "x w b", group=2)], X,
               constants={"w": weights(6, 5, 3, 3), "b": weights(6)})
    yield Case("conv_multiplier", [node("Conv", "x w", group=10)], X, constants={"w": weights(20, 1, 3, 3)})
    yield Case("conv_pointwise", [node("Conv", "x w b")], X, constants={"w": weights(6, 10, 1, 1), "b": weights(6)})
    yield Case("conv_pointwise_of_image", [node("Conv", "x w")], IMAGE, constants={"w": weights(6, 3, 1, 1)})
    yield Case("conv_pointwise_strided", [node("Conv", "x w", strides=[2, 2])], X,
               constants={"w": weights(6, 10, 1, 1)})
    yield Case("conv_of_whole_map", [node("Conv", "x w b")], {"x": [1, 4, 20, 17]},
               constants={"w": weights(6, 4, 20, 17), "b": weights(6)})
    yield Case("conv_1d", [node("Conv", "x w b", pads=[2, 1], strides=[2])], {"x": [1, 5, 40]},
               constants={"w": weights(6, 5, 4), "b": weights(6)})


def norm_cases():
    norm = {"gain": floats(*random.uniform(0.5, 2, 6)), "bias": weights(6), "mean": weights(6),
            "variance": floats(*random.uniform(0.5, 2, 6))}
    conv = {"w": weights(6, 10, 3, 3), "b": weights(6), **norm}
    names = " gain bias mean variance"
    for opset in OPSETS:
        yield Case("norm_after_conv", [node("Conv", "x w b", "t"),
                                       node("BatchNormalization", "t" + names, "u", epsilon=0.01), node("Relu", "u")],
                   X, opset=opset, constants=conv, rounds=True)
    wide = {**norm, "w": weights(4, 6, 3, 3)}
    for name, pads in (("norm_before_conv", [0, 0, 0, 0]), ("norm_before_padded_conv", [1, 1, 1, 1])):
        yield Case(name, [node("BatchNormalization", "x" + names, "t"),
                          node("Conv", "t w", pads=pads)], {"x": [1, 6, 8, 5]}, constants=wide, rounds=True)
        yield Case(name + "_depthwise", [node("BatchNormalization", "x" + names, "t"),
                                         node("Conv", "t w", pads=pads, group=6)],
                   {"x": [1, 6, 8, 5]}, constants={**norm, "w": weights(6, 1, 3, 3)}, rounds=True)
    yield Case("norm_between", [node("Relu", "x", "r"), node("BatchNormalization", "r" + names, "t"),
                                node("Conv", "t w"), node("Relu", "t", "z")],
               {"x": [1, 6, 8, 5]}, ("y", "z"), constants=wide, rounds=True)
    yield Case("norm_of_image", [node("BatchNormalization", "x gain bias mean variance")], IMAGE,
               constants={key: value[:3] for key, value in norm.items()}, rounds=True)
    yield Case("norm_of_vector", [node("BatchNormalization", "x" + names)], {"x": [1, 6]}, constants=norm, rounds=True)


def activation_cases():
    low, high = np.float32(-0.75), np.float32(0.5)
    plain = [("relu", "Relu", {}), ("leaky_relu", "LeakyRelu", {"alpha": 0.125}),
             ("leaky_relu_default", "LeakyRelu", {}), ("leaky_relu_zero", "LeakyRelu", {"alpha": 0.0}),
             ("leaky_relu_steep", "LeakyRelu", {"alpha": 1.5}), ("sigmoid", "Sigmoid", {}),
             ("tanh", "Tanh", {}), ("hard_sigmoid", "HardSigmoid", {"alpha": 0.25, "beta": 0.5})]
    for name, operator, attributes in plain:
        yield Case(name, [node(operator, "x", **attributes)], X)
        yield Case(name + "_after_conv", [node("Conv", "x w b", "t"), node(operator, "t", **attributes)], X,
                   rounds=name == "hard_sigmoid", constants={"w": weights(6, 10, 1, 1), "b": weights(6)})
    for opset in OPSETS:
        yield Case("relu6", [node("Clip", "x low high")], X, opset=opset,
                   constants={"low": np.float32(0), "high": np.float32(6)})
    for name, inputs in (("clip", "x low high"), ("clip_below", "x low"), ("clip_above", "x  high")):
        clip = helper.make_node("Clip", inputs.split(" "), ["y"], name="the_clip")
        yield Case(name, [clip], X, constants={"low": low, "high": high}, rounds=True)
    yield Case("clip_01", [node("Clip", "x low high")], X, constants={"low": np.float32(0), "high": np.float32(1)})
    clip = helper.make_node("Clip", ["t", "", "high"], ["y"])
    yield Case("relu_clip", [node("Relu", "x", "t"), clip], X, constants={"high": np.float32(6)})
    yield Case("prelu", [node("PRelu", "x s")], X, constants={"s": weights(10, 1, 1)})
    yield Case("prelu_scalar", [node("PRelu", "x s")], X, constants={"s": floats(0.25)})
    yield Case("prelu_of_vector", [node("PRelu", "x s")], VECTOR, constants={"s": weights(13)})
    yield Case("softmax_vector", [node("Softmax", "x")], VECTOR, opset=11)
    yield Case("softmax_vector", [node("Softmax", "x")], VECTOR, opset=13)
    yield Case("softmax_channels", [node("Softmax", "x", axis=1)], X)
    yield Case("activation_of_part", [node("Split", "x", "a b", axis=1), node("Sigmoid", "a", "y"),
                                      node("Relu", "b", "z")], X, ("y", "z"))


def pool_cases():
    for opset in (11, 12, 18):
        yield Case("max_pool", [node("MaxPool", "x", kernel_shape=[3, 3], strides=[2, 2], pads=[1, 1, 1, 1])], X,
                   opset=opset)
    yield Case(
        "max_pool_ceil", [node("MaxPool", "x", kernel_shape=[3, 2], strides=[2, 2], ceil_mode=1)], {"x": [1, 10, 8, 7]})
    yield Case("max_pool_same", [node("MaxPool", "x", kernel_shape=[2, 2], strides=[2, 2], auto_pad="SAME_UPPER")], X)
    yield Case("max_pool_of_image", [node("MaxPool", "x", kernel_shape=[2, 2])], IMAGE)
    yield Case("max_pool_1d", [node("MaxPool", "x", kernel_shape=[3], strides=[2])], {"x": [1, 5, 40]})
    yield Case("average_pool", [node("AveragePool", "x", kernel_shape=[2, 4], strides=[2, 1])], X)
    yield Case("average_pool_padded", [node("AveragePool", "x", kernel_shape=[2, 2], pads=[1, 0, 0, 1],
                                            count_include_pad=1)], X)
    yield Case("average_pool_whole", [node("AveragePool", "x", kernel_shape=[9, 7])], X)
    yield Case("global_average_pool", [node("GlobalAveragePool", "x")], X)
    yield Case("global_max_pool", [node("GlobalMaxPool", "x")], X)
    yield Case("reduce_mean", [node("ReduceMean", "x", axes=[2, 3], keepdims=0)], X, opset=11)
    yield Case("reduce_mean", [node("ReduceMean", "x", axes=[-1, -2])], X, opset=13)
    yield Case("reduce_mean", [node("ReduceMean", "x axes", keepdims=0)], X, opset=18, constants={"axes": ints(2, 3)})
    yield Case("reduce_mean_channels_last", [node("ReduceMean", "x", axes=[1, 2], keepdims=0)], {"x": [1, 9, 7, 3]},
               layout="hwc")


def arithmetic_cases():
    c = {"c": weights(10, 1, 1), "w": weights(10, 10, 1, 1), "s": np.float32(0.5)}
    conv = node("Conv", "x w", "t")
    for operator in ("Add", "Sub", "Mul", "Div"):
        yield Case(f"{operator.lower()}_constant", [node(operator, "x c")], X, constants=c, rounds=operator == "Div")
        yield Case(f"{operator.lower()}_scalar_after_conv", [conv, node(operator, "t s")], X, constants=c)
    yield Case("sub_from_constant", [node("Sub", "c x")], X, constants=c)
    yield Case("neg", [node("Neg", "x", "t"), node("Relu", "t")], X)
    yield Case("add", [conv, node("Add", "t x")], X, constants=c)
    yield Case("add_relu", [conv, node("Add", "t x", "u"), node("Relu", "u")], X, constants=c)
    yield Case("sub", [conv, node("Sub", "x t")], X, constants=c)
    yield Case("sum", [conv, node("Sum", "t x s x")], X, constants={**c, "s": np.full((1, 1, 1, 1), 0.5, np.float32)})
    yield Case("add_vectors", [node("Tanh", "x", "t"), node("Add", "t x")], VECTOR)
    yield Case("scale_twice", [node("Relu", "x", "r"), node("Mul", "r c", "t"), node("Add", "t c", "u"),
                               node("Conv", "u w")], X, constants=c, rounds=True)


def move_cases():
    w = {"w": weights(4, 10, 1, 1), "w5": weights(4, 5, 1, 1), "fc": weights(6, 630)}
    yield from slice_cases(w)
    yield from pad_cases()
    yield from reshape_cases(w)


def slice_cases(w):
    """Layers that select or join channels and pixels."""
    crop = {"starts": ints(1, 2), "ends": ints(-1, 2**63 - 1), "axes": ints(2, 3)}
    yield Case("slice", [node("Slice", "x starts ends axes")], X, constants=crop)
    yield Case("slice_conv", [node("Slice", "x starts ends axes", "t"), node("Conv", "t w")], X,
               constants={**crop, **w})
    yield Case("slice_channels", [node("Slice", "x starts ends axes steps", "t"), node("Conv", "t w5")], X,
               constants={"starts": ints(3), "ends": ints(8), "axes": ints(1), "steps": ints(1), **w})
    centre = {"starts": ints(1, 1), "ends": ints(-1, -1), "axes": ints(2, 3), "w": weights(10, 1, 3, 3)}
    yield Case("centre_slice", [node("Conv", "x w", "t", group=10), node("Slice", "x starts ends axes", "s"),
                                node("Add", "s t")], X,
               constants=centre)
    yield Case("split", [node("Split", "x", "a b c", axis=1, split=[3, 5, 2]), node("Conv", "b w5")], X, opset=11,
               constants=w)
    yield Case("split", [node("Split", "x sizes", "a b c", axis=1), node("Conv", "b w5")], X, opset=13,
               constants={"sizes": ints(3, 5, 2), **w})
    yield Case("split", [node("Split", "x", "a b", axis=1, num_outputs=2), node("Conv", "b w5")], X, opset=18,
               constants=w)
    yield Case("concat", [node("Relu", "x", "r"), node("Conv", "x w", "t"), node("Concat", "r t x", axis=1)], X,
               constants=w)
    yield Case("concat_conv", [node("Relu", "x", "r"), node("Concat", "r x", "t", axis=1), node("Conv", "t v")], X,
               constants={"v": weights(7, 20, 3, 3)})
    yield Case("split_and_swap", [node("Split", "x", "a b", axis=1), node("Concat", "b a", axis=1)], X)
    yield Case("split_and_join", [node("Relu", "x", "r"), node("Split", "r", "a b", axis=1),
                                  node("Concat", "a b", axis=1)], X)
    yield Case("concat_vectors", [node("Tanh", "x", "t"), node("Concat", "t x", "u", axis=1),
                                  node("Gemm", "u m", transB=1)], VECTOR,
               constants={"m": weights(5, 26)})
    shuffle = {"a": ints(1, 2, 5, 9, 7), "b": ints(1, 10, 9, 7), **w}
    yield Case("channel_shuffle", [node("Reshape", "x a", "t"), node("Transpose", "t", "u", perm=[0, 2, 1, 3, 4]),
                                   node("Reshape", "u b", "v"), node("Conv", "v w")], X, constants=shuffle)


def pad_cases():
    pads = {"p": ints(0, 0, 1, 2, 0, 0, 1, 0), "v": weights(6, 10, 3, 3)}
    for opset in (11, 13):
        yield Case("pad_conv", [node("Pad", "x p", "t"), node("Conv", "t v")], X, opset=opset, constants=pads)
    padded = helper.make_node("Pad", ["x", "p", "", "axes"], ["t"])
    yield Case("pad_conv", [padded, node("Conv", "t v", pads=[1, 0, 0, 0])], X, opset=18,
               constants={"p": ints(0, 2, 1, 0), "axes": ints(2, 3), "v": pads["v"]})
    yield Case("pad_max_pool", [node("Pad", "x p", "t"), node("MaxPool", "t", kernel_shape=[2, 2])], X, constants=pads,
               first_output=padded_and_pooled)


def reshape_cases(w):
    """Layers that change the shape or the order of the axes, and constants."""
    yield Case("flatten", [node("Relu", "x", "r"), node("Flatten", "r", "f"), node("Gemm", "f fc", transB=1)], X,
               constants=w)
    yield Case("reshape", [node("Reshape", "x shape", "f"), node("Gemm", "f fc", transB=1)], X,
               constants={"shape": ints(0, -1), **w})
    last = node("Transpose", "x", "t", perm=[0, 3, 2, 1])
    yield Case("transposed_flatten", [last, node("Flatten", "t", "f"), node("Gemm", "f fc", transB=1)], X, constants=w)
    shape = [node("Shape", "x", "s"), node("Gather", "s zero", "n"), node("Unsqueeze", "n", "u", axes=[0]),
             node("Concat", "u minus", "shape", axis=0), node("Reshape", "x shape", "f"),
             node("Gemm", "f fc", transB=1)]
    yield Case("shape_arithmetic", shape, X, opset=11,
               constants={"zero": np.array(0, np.int64), "minus": ints(-1), **w})
    pooled = node("GlobalAveragePool", "x", "p")
    yield Case("squeeze", [pooled, node("Squeeze", "p", "q", axes=[2, 3]), node("Gemm", "q m", transB=1)], X, opset=11,
               constants={"m": weights(5, 10)})
    yield Case("squeeze", [pooled, node("Squeeze", "p axes", "q"), node("Unsqueeze", "q axes", "u"),
                           node("Conv", "u w")], X, opset=13,
               constants={"axes": ints(2, 3), **w})
    yield Case("dropout", [node("Dropout", "x", "t"), node("Identity", "t", "u"), node("Relu", "u")], X, opset=12)
    constant = helper.make_node("Constant", [], ["c"], value=numpy_helper.from_array(weights(10, 1, 1)))
    yield Case("constant", [constant, node("Add", "x c")], X)
    zeros = helper.make_node("ConstantOfShape", ["shape"], ["z"], value=numpy_helper.from_array(floats(0)))
    yield Case("constant_of_shape", [zeros, node("Concat", "z x", "t", axis=1),
                                     node("Conv", "t w5")], {"x": [1, 3, 4, 4]},
               constants={"shape": ints(1, 2, 4, 4), **w}, refusal="mixes constants with computed values")
    yield Case("channels_last", [node("Transpose", "x", "t", perm=[0, 3, 1, 2]),
                                 node("Conv", "t v")], {"x": [1, 9, 7, 3]}, layout="hwc",
               constants={"v": weights(6, 3, 3, 3)})


def padded_and_pooled(case, x):
    x = np.pad(x, ((0, 0), (0, 0), (1, 1), (2, 0)))
    return np.max([x[:, :, y:x.shape[2] - 1 + y, c:x.shape[3] - 1 + c] for y in (0, 1) for c in (0, 1)], 0)


def dense_cases():
    m = {"m": weights(5, 13), "n": weights(13, 5), "b": weights(5)}
    yield Case("gemm", [node("Gemm", "x m b", transB=1)], VECTOR, opset=11, constants=m)
    yield Case("gemm_scaled", [node("Gemm", "x n b", alpha=0.5, beta=2.0)], VECTOR, constants=m)
    yield Case("gemm_plain", [node("Gemm", "x n")], VECTOR, constants=m)
    yield Case("matmul_add", [node("MatMul", "x n", "t"), node("Add", "t b", "u"), node("LeakyRelu", "u", alpha=0.25)],
               VECTOR, constants=m)
    yield Case("matmul_of_part", [node("Slice", "x s e a", "t"), node("MatMul", "t n")], {"x": [1, 20]},
               constants={"s": ints(4), "e": ints(17), "a": ints(1), **m})
    pixels = [node("Transpose", "x", "t", perm=[0, 2, 3, 1]), node("MatMul", "t v", "u"),
              node("Transpose", "u", perm=[0, 3, 1, 2])]
    yield Case("matmul_at_every_pixel", pixels, X, constants={"v": weights(10, 6)})
    yield Case("gemm_of_two_maps", [node("Relu", "x", "r"), node("GlobalAveragePool", "r", "g"),
                                    node("Flatten", "g", "f"),
                                    node("Flatten", "x", "h"), node("Concat", "f h", "t", axis=1),
                                    node("Gemm", "t v", transB=1)], X,
               constants={"v": weights(6, 640)})


def lstm_weights(inputs, hidden):
    return {"w": weights(1, 4 * hidden, inputs), "r": weights(1, 4 * hidden, hidden), "b": weights(1, 8 * hidden)}


def cell_of_steps(case, x):
    """Outputs [steps,hidden] of an LSTM for x [1,steps,inputs], from the definition of the operator."""
    w, r, b = (case.constants[key][0].astype(np.float64) for key in "wrb")
    h = c = np.zeros(r.shape[1])
    steps = []
    for step in x[0]:
        i, o, f, g = np.split(w @ step + r @ h + b[:len(b) // 2] + b[len(b) // 2:], 4)
        c = c / (1 + np.exp(-f)) + np.tanh(g) / (1 + np.exp(-i))
        h = np.tanh(c) / (1 + np.exp(-o))
        steps.append(h)
    return np.array(steps)


def lstm_cases():
    def lstm(inputs, outputs="y", hidden=8, **attributes):
        return helper.make_node("LSTM", inputs.split(" "), outputs.split(" "), name="the_lstm", hidden_size=hidden,
                                **attributes)
    squeeze = node("Squeeze", "t axes", "y")
    sequence = {"x": [12, 1, 5]}
    for hidden in (8, 5):
        yield Case(f"lstm_{hidden}", [lstm("x w r b", "t", hidden), squeeze], sequence, rounds=True,
                   constants={**lstm_weights(5, hidden), "axes": ints(1)})
    yield Case("lstm_without_bias", [lstm("x w r", "t"), squeeze], sequence,
               constants={**lstm_weights(5, 8), "axes": ints(1)})
    yield Case("lstm_batch_first", [lstm("x w r b", "t", layout=1), squeeze], {"x": [1, 12, 5]}, opset=14,
               rounds=True, constants={**lstm_weights(5, 8), "axes": ints(2)}, first_output=cell_of_steps)
    zeros = {"z": np.zeros((1, 1, 8), np.float32)}
    yield Case("lstm_zeros", [lstm("x w r b  z z", "t"), squeeze], sequence, rounds=True,
               constants={**lstm_weights(5, 8), **zeros, "axes": ints(1)})
    yield Case("lstm_last", [lstm("x w r b", "t h"), node("Squeeze", "h axes", "s"), node("Gemm", "s m", transB=1)],
               sequence, rounds=True, constants={**lstm_weights(5, 8), "axes": ints(0), "m": weights(3, 8)})
    yield Case("lstm_last_of_steps", [lstm("x w r b", "t"), node("Gather", "t last", "u", axis=0),
                                      node("Reshape", "u flat", "v"),
                                      node("Gemm", "v m", transB=1)], sequence, rounds=True,
               constants={**lstm_weights(5, 8), "last": np.array(-1, np.int64), "flat": ints(1, 8), "m": weights(3, 8)})
    frames = [node("Conv", "x k", "c"), node("Relu", "c", "a"), node("GlobalAveragePool", "a", "g"),
              node("Squeeze", "g axes", "f"),
              node("Unsqueeze", "f one", "s"), lstm("s w r b", "t"), node("Squeeze", "t one", "y")]
    yield Case("lstm_of_frames", frames, {"x": [6, 3, 9, 7]}, rounds=True,
               constants={**lstm_weights(5, 8), "k": weights(5, 3, 3, 3), "axes": ints(2, 3), "one": ints(1)})
    two = [lstm("x w r b", "t", 6), node("Squeeze", "t axes", "u"), lstm("u w2 r2 b2", "v"),
           node("Squeeze", "v axes", "y")]
    second = {key + "2": value for key, value in lstm_weights(6, 8).items()}
    yield Case("lstm_two", two, sequence, rounds=True, constants={**lstm_weights(5, 6), **second, "axes": ints(1)})
    yield Case("lstm_scaled", [node("Mul", "x s", "u"), node("Add", "u s", "v"), lstm("v w r b", "t"), squeeze],
               sequence, rounds=True, constants={**lstm_weights(5, 8), "axes": ints(1), "s": weights(5)})
    yield Case("lstm_states", [lstm("x w r b  h c", "t h_out c_out"), node("Squeeze", "t axes", "y")],
               {"x": [1, 1, 5], "h": [1, 1, 8], "c": [1, 1, 8]}, ("y", "h_out", "c_out"), rounds=True,
               constants={**lstm_weights(5, 8), "axes": ints(1)}, steps=9, feedback={"h": "h_out", "c": "c_out"})


def causal_cases():
    stream = {"x": [1, 5, 12]}
    conv = {"w": weights(6, 5, 2), "b": weights(6)}
    yield Case("causal", [node("Conv", "x w b", pads=[1, 0])], stream, constants=conv)
    yield Case("causal_unpadded", [node("Conv", "x w b")], stream, constants=conv, arguments=["--time-axis", "2"])
    yield Case("causal_relu", [node("Conv", "x w b", "t", pads=[1, 0]), node("LeakyRelu", "t", "u"),
                               node("Conv", "u v", pads=[1, 0])], stream,
               constants={**conv, "v": weights(3, 6, 2)})
    yield Case("causal_padded_by_pad", [node("Pad", "x p", "t"), node("Conv", "t w b")], stream,
               constants={**conv, "p": ints(0, 0, 1, 0, 0, 0)}, arguments=["--time-axis", "2"])
    chop = {"s": ints(0), "e": ints(-1), "a": ints(2)}
    yield Case("causal_chopped", [node("Conv", "x w b", "t", pads=[1, 1]), node("Slice", "t s e a")], stream,
               constants={**conv, **chop}, arguments=["--time-axis", "2"])
    for name, taps, dilation in (("causal_3", 3, 1), ("causal_dilated", 2, 3), ("causal_3_dilated", 3, 2)):
        yield Case(name, [node("Conv", "x w b", pads=[(taps - 1) * dilation, 0], dilations=[dilation])], stream,
                   constants={"w": weights(6, 5, taps), "b": weights(6)})
    yield Case("causal_depthwise", [node("Conv", "x w", pads=[1, 0], group=5)], stream,
               constants={"w": weights(5, 1, 2)})
    yield Case("causal_scaled", [node("Concat", "z x", "t", axis=2), node("Mul", "t s", "u"), node("Add", "u s", "v"),
                                 node("Conv", "v w b")],
               stream, rounds=True, constants={**conv, "s": weights(5, 1), "z": np.zeros((1, 5, 1), np.float32)},
               arguments=["--time-axis", "2"])
    yield Case("causal_after_scaling", [node("Add", "x s", "t"), node("Conv", "t w b", pads=[1, 0])], stream,
               constants={**conv, "s": weights(5, 1)})
    yield Case("causal_state", [node("Concat", "before x", "t", axis=2), node("Conv", "t w b"),
                                node("Slice", "t s e a", "after")],
               {"x": [1, 5, 1], "before": [1, 5, 1]}, ("y", "after"), steps=9, feedback={"before": "after"},
               arguments=["--time-axis", "2"], constants={**conv, "s": ints(-1), "e": ints(2**31), "a": ints(2)})
    dense = [node("MatMul", "x m", "t"), node("Add", "t b", "u"), node("Softmax", "u", axis=2)]
    yield Case("dense_over_time", dense, {"x": [1, 12, 5]}, constants={"m": weights(5, 7), "b": weights(7)},
               arguments=["--time-axis", "1"])


def accepted():
    for cases in (conv_cases, norm_cases, activation_cases, pool_cases, arithmetic_cases, move_cases, dense_cases,
                  lstm_cases, causal_cases):
        yield from (case for case in cases() if case.refusal is None)
