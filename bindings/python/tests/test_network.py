import re
import subprocess
import sys

import mien
import numpy as np
import pytest
from mien import errors

onnx = pytest.importorskip("onnx")
from onnx import TensorProto, helper, numpy_helper  # noqa: E402


def convolution(path, channels=3, steps=None):
    """3x3, then a ReLU: something to compute by hand."""
    random = np.random.default_rng(3)
    weight = random.standard_normal((5, channels, 3, 3)).astype(np.float16).astype(np.float32) / 4
    nodes = [helper.make_node("Conv", ["x", "w"], ["t"], pads=[1, 1, 1, 1]), helper.make_node("Relu", ["t"], ["y"])]
    graph = helper.make_graph(nodes, "g", [helper.make_tensor_value_info("x", TensorProto.FLOAT, [1, channels, 6, 7])],
                              [helper.make_tensor_value_info("y", TensorProto.FLOAT, [1, 5, 6, 7])], [numpy_helper.from_array(weight, "w")])
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 13)])
    model.ir_version = 8
    onnx.save(model, str(path))
    return weight


def expected(x, weight):
    padded = np.pad(x, ((0, 0), (1, 1), (1, 1)))
    out = np.zeros((len(weight), *x.shape[1:]), np.float64)
    for i in range(3):
        for j in range(3):
            out += np.einsum("oc,chw->ohw", weight[:, :, i, j], padded[:, i:i + x.shape[1], j:j + x.shape[2]])
    return np.maximum(out, 0)


def convert(*arguments):
    return subprocess.run([sys.executable, "-m", "mien.convert", *map(str, arguments)], capture_output=True, text=True)


@pytest.mark.parametrize("channels", [3, 11])  # interleaved, and in blocks of 8
def test_a_converted_network_gives_the_expected_output(tmp_path, channels):
    weight = convolution(tmp_path / "net.onnx", channels)
    done = convert(tmp_path / "net.onnx", "-o", tmp_path / "net.mien")
    assert done.returncode == 0, done.stderr
    assert "network net: input 6x7x" in done.stdout
    x = np.random.default_rng(5).standard_normal((channels, 6, 7)).astype(np.float32)
    y, = mien.run(tmp_path / "net.mien", x)
    assert y.shape == (5, 6, 7)
    np.testing.assert_allclose(y, expected(x, weight), atol=2e-3)
    for leading in [(1,), (1, 1)]:  # outputs have the leading axes of the input
        batch, = mien.run((tmp_path / "net.mien").read_bytes(), x.reshape(leading + x.shape))
        np.testing.assert_array_equal(batch, y.reshape(leading + y.shape))
    with mien.Network(tmp_path / "net.mien", "net") as network:
        assert network.input_shape == mien.Shape(channels, 6, 7)
        steps, = network.run(np.stack([x, 2 * x]))
        np.testing.assert_allclose(steps[1], 2 * steps[0], rtol=1e-4, atol=1e-5)
        streamed, = network.run(np.stack([x, 2 * x])[:, None])
        np.testing.assert_array_equal(streamed, steps[:, None])
        for shape in [(3,), (6, 7, channels), (channels, 7, 6), (channels * 42,), (1, channels, 42), (2, 2, channels, 6, 7), (0, channels, 6, 7)]:
            with pytest.raises(ValueError, match=rf"array: wrong shape \(got {re.escape(str(shape))}, expected \({channels}, 6, 7\)"):
                network.run(np.zeros(shape))
    with pytest.raises(mien.MienError, match="closed"):
        network.run(x)


def test_invalid_input_is_rejected(tmp_path):
    graph = helper.make_graph([helper.make_node("Sin", ["x"], ["y"], name="the_sin")], "g",
                              [helper.make_tensor_value_info("x", TensorProto.FLOAT, [1, 3])],
                              [helper.make_tensor_value_info("y", TensorProto.FLOAT, [1, 3])])
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 13)])
    model.ir_version = 8
    onnx.save(model, str(tmp_path / "bad.onnx"))
    done = convert(tmp_path / "bad.onnx", "-o", tmp_path / "bad.mien")
    assert done.returncode == 1 and done.stderr.count("\n") == 1 and "Sin 'the_sin'" in done.stderr
    (tmp_path / "text.mien").write_text("not a weight file" * 20)
    with pytest.raises(errors.WeightsNotMienError):
        mien.run(tmp_path / "text.mien", np.zeros(3))
    with pytest.raises(errors.WeightsTruncatedError):
        mien.run(b"", np.zeros(3))
