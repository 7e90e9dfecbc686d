#!/usr/bin/env python3
"""Converts generated ONNX files, runs them with `mien run`, and compares the outputs with ONNX Runtime's and PyTorch's.

usage: onnx_to_mien_test.py MIEN_PROGRAM      exit 77: Python's onnx package is missing here
ONNX Runtime is the npm package that scripts/peers/install_onnxruntime.sh fetches. Skipped comparisons are listed
on standard output.
"""
import contextlib
import io
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import unittest
import warnings
from pathlib import Path

try:
    import arithmetic_cases
    import numpy as np
    import onnx
    import operator_cases
    import random_graphs
    import refused_cases
    from conversion import Runtime, convert, difference, run_network, runtime_is_here, time_axis
except ModuleNotFoundError as missing:
    print("skipped: missing Python module", missing.name + "; scripts/setup.sh convert installs it")
    sys.exit(77)
try:
    import modern_networks
    import network_cases
    import torch
except ModuleNotFoundError as missing:
    torch = None
    print("NOT TESTED: networks exported by PyTorch: missing Python module", missing.name)

if not runtime_is_here():
    print("NOT COMPARED: operators with ONNX Runtime; scripts/peers/install_onnxruntime.sh fetches it")
RANDOM_GRAPHS = int(os.environ.get("MIEN_RANDOM_GRAPHS", 60))
# Of the largest value. Weights of the operator cases are exact in fp16; a network's are rounded to 11 bits.
OPERATOR_TOLERANCE, ROUNDED_TOLERANCE = 2e-5, 2e-3


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="mien_convert_"))
        self.addCleanup(shutil.rmtree, self.folder)


class Operators(Folder):
    def test_outputs_match_onnx_runtime(self):
        self.check(list(operator_cases.accepted()))

    def test_arithmetic_matches_numpy_and_onnx_runtime(self):
        self.check(list(arithmetic_cases.accepted()))

    def test_graphs_drawn_by_chance(self):
        self.check(list(random_graphs.graphs(RANDOM_GRAPHS)))

    def check(self, cases):
        runtime, results, random = Runtime(self.folder), [], np.random.default_rng(3)
        for case in cases:
            model = self.folder / f"{case.name}.onnx"
            onnx.save(case.model(), str(model))
            with self.subTest(case.name):
                status, _ = convert([model, "-o", model.with_suffix(".mien"), *case.arguments])
                self.assertEqual(status, 0)
            steps = [{name: random.standard_normal(shape).astype(np.float32) for name, shape in case.shapes.items()
                      if name not in case.feedback}
                     for _ in range(case.steps)]
            begin = {name: np.zeros(case.shapes[name], np.float32) for name in case.feedback}
            runtime.add(model, [{**step, **begin} for step in steps], case.feedback)
            results.append(self.results(case, model.with_suffix(".mien"), steps))
            if case.expected:
                for result, want in zip(results[-1], case.expected(case, steps[0]["x"]), strict=True):
                    with self.subTest(case.name):
                        self.assertLess(difference(result, want), ROUNDED_TOLERANCE)
            if case.first_output:
                with self.subTest(case.name):
                    wanted = case.first_output(case, steps[0]["x"])
                    self.assertLess(difference(results[-1][0], wanted), ROUNDED_TOLERANCE)
        if not runtime_is_here():
            return
        failures = runtime.run()
        for number, (case, result) in enumerate(zip(cases, results)):
            with self.subTest(case.name):
                failure = failures.get(str(self.folder / f"{case.name}.onnx"))
                self.assertIsNone(failure if not case.first_output and not case.expected else None)
                if not case.first_output and not failure:
                    self.compare(case, result, runtime.outputs(number))

    def results(self, case, model, steps):
        """In the graph's order of elements: a stream's steps come first in the engine."""
        x = np.concatenate([step["x"] for step in steps]) if case.steps > 1 else steps[0]["x"]
        axis = time_axis(model)
        x = np.moveaxis(x, axis, 0) if axis is not None and case.steps == 1 else x
        x = x.reshape(len(x), -1) if axis is not None and x.ndim < 4 else x
        return run_network(self.folder, model, x, case.layout)

    def compare(self, case, results, wanted):
        streams = time_axis(self.folder / f"{case.name}.mien") is not None and case.steps == 1
        kept = [w for name, w in zip(case.outputs, wanted) if name not in case.feedback.values()]
        self.assertEqual(len(results), len(kept))
        for got, want in zip(results, kept):
            if streams and not case.name.startswith(("lstm", "dense")):  # [channels, steps] there
                channels = got.shape[-1]
                want = want.reshape(channels, -1).T
                got = got[-len(want):]  # an unpadded convolution begins later
            if case.layout == "hwc" and got.ndim == 4:
                got = got.transpose(0, 3, 1, 2)
            if case.name.startswith("lstm_last"):
                got = got[-1]
            self.assertLess(difference(got, want), case.rounds * ROUNDED_TOLERANCE or OPERATOR_TOLERANCE)

    def test_refusals_name_the_node_and_the_reason(self):
        for case in [*refused_cases.refused(), *arithmetic_cases.refused()]:
            with self.subTest(case.name):
                model = self.folder / f"{case.name}.onnx"
                onnx.save(case.model(), str(model))
                (self.folder / "y.mien").unlink(missing_ok=True)
                status, _ = convert([model, "-o", self.folder / "y.mien", *case.arguments])
                self.assertIsInstance(status, str)
                self.assertIn(case.refusal, status)
                self.assertNotIn("malformed", status)
                self.assertFalse((self.folder / "y.mien").exists())


@unittest.skipIf(torch is None, "no PyTorch here")
class Networks(Folder):
    def test_outputs_match_onnx_runtime_and_pytorch(self):
        torch.manual_seed(5)
        runtime, done = Runtime(self.folder), []
        for name, network, shapes, opset, folded, states in network_cases.networks_to_export():
            model = self.folder / f"{name}.onnx"
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                network_cases.exported(network, shapes, str(model), opset, folded)
            status, report = convert([model, "-o", model.with_suffix(".mien")])
            self.assertEqual(status, 0, name)
            steps = [{"x": torch.randn(shapes["x"])} for _ in range(network_cases.STEPS if states else 1)]
            wanted = self.pytorch(network, steps, states)
            x = torch.cat([step["x"] for step in steps]).numpy()
            results = run_network(self.folder, model.with_suffix(".mien"), x[:, 0] if states else x)
            for result, want in zip(results, wanted):
                with self.subTest(name):
                    self.assertLess(difference(result, want), ROUNDED_TOLERANCE)
            done.append((name, results))
            begin = {state: np.zeros(shape) for state, shape in states.items()}
            outputs = [o.name for o in onnx.load(str(model)).graph.output]
            runtime.add(model, [{"x": step["x"].numpy(), **begin} for step in steps], dict(zip(states, outputs[1:])))
        if not runtime_is_here():
            return
        failures = runtime.run()
        self.assertEqual(failures, {})
        for number, (name, results) in enumerate(done):
            for result, want in zip(results, runtime.outputs(number)):
                with self.subTest(name):
                    error = difference(result, want)
                    print(f"{name}: {error:.1e} of the largest value off ONNX Runtime")
                    self.assertLess(error, ROUNDED_TOLERANCE)

    def test_networks_of_today(self):
        """Also with PyTorch's default exporter, if available."""
        ways = [False] + [True] * modern_networks.has_default_export()
        if len(ways) == 1:
            print("NOT TESTED: PyTorch's default export: onnxscript or PyTorch 2.5 is missing")
        for by_default in ways:
            torch.manual_seed(6)
            for name, network in modern_networks.networks():
                with self.subTest(name, by_default=by_default):
                    self.check_network_of_today(name, network, by_default)

    def check_network_of_today(self, name, network, by_default):
        model = self.folder / f"{name}.onnx"
        with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
            warnings.simplefilter("ignore")
            modern_networks.exported(network, str(model), by_default)
        status, _ = convert([model, "-o", model.with_suffix(".mien")])
        self.assertEqual(status, 0)
        x = torch.randn(modern_networks.SHAPE)
        with torch.no_grad():
            wanted = network(x).numpy()
        got, = run_network(self.folder, model.with_suffix(".mien"), x.numpy())
        self.assertLess(difference(got, wanted), 1e-3)
        if by_default:
            self.assertGreaterEqual(onnx.load(str(model)).opset_import[0].version, 18)
            self.assertTrue(model.with_suffix(".onnx.data").exists())

    def pytorch(self, network, steps, states):
        with torch.no_grad():
            memory, outputs = [torch.zeros(shape) for shape in states.values()], []
            for step in steps:
                outputs = network(step["x"], *memory)
                outputs = outputs if isinstance(outputs, tuple) else (outputs,)
                if not states:
                    return [output.numpy() for output in outputs]
                memory = outputs[1:]
                self.stream = getattr(self, "stream", []) + [outputs[0]]
            stream, self.stream = self.stream, []
            return [torch.cat(stream).numpy()]


class Program(Folder):
    def model(self, name="net", nodes=None, shapes=None, **options):
        path = self.folder / f"{name}.onnx"
        onnx.save(operator_cases.Case("net", nodes or [operator_cases.node("Relu", "x")], shapes or {"x": [1, 3, 4, 5]},
                                      **options).model(),
                  str(path))
        return path

    def test_several_files_become_networks_of_one(self):
        first, second = self.model("First Net"), self.model("b", [operator_cases.node("Tanh", "x")], {"x": [1, 9]})
        status, report = convert([first, second, "-o", self.folder / "both.mien", "--name", "one"])
        self.assertEqual(status, 0)
        self.assertIn("network one: input 4x5x3", report)
        x = np.linspace(-1, 1, 9, dtype=np.float32)
        y, = run_network(self.folder, self.folder / "both.mien", x, network=("--network", "b"))
        np.testing.assert_allclose(y, np.tanh(x), atol=1e-6)

    def test_any_size(self):
        path = self.model(nodes=[operator_cases.node("Conv", "x w", "t"),
                                 operator_cases.node("GlobalAveragePool", "t", "y")],
                          shapes={"x": [1, 3, None, None]}, constants={"w": operator_cases.weights(5, 3, 3, 3)},
                          outputs=("t", "y"))
        status, _ = convert([path, "-o", self.folder / "any.mien", "--shape", "1,3,4,5", "--any-size"])
        self.assertEqual(status, 0)
        t, y = run_network(self.folder, self.folder / "any.mien",
                        np.random.default_rng(1).standard_normal((3, 9, 12)).astype(np.float32))
        self.assertEqual(t.shape, (5, 7, 10))
        np.testing.assert_allclose(y, t.mean((1, 2)), atol=1e-6)

    def test_any_size_with_a_layer_of_one_size_is_refused(self):
        path = self.model(nodes=[operator_cases.node("Flatten", "x", "t"), operator_cases.node("Gemm", "t w")],
                          constants={"w": operator_cases.weights(60, 3)})
        status, _ = convert([path, "-o", self.folder / "any.mien", "--any-size"])
        self.assertIn("Gemm 'the_gemm': net: fully_connected in a network of any size", status)

    def with_a_rate(self, shape):
        """A model that doubles its input when its second input, a whole number, is 16000, and else triples it."""
        case = operator_cases.Case("net", [operator_cases.node("Equal", "rate k", "same"),
                                           operator_cases.node("Where", "same two three", "factor"),
                                           operator_cases.node("Mul", "x factor")], {"x": [1, 3, 4, 5]},
                                   constants={"k": np.int64(16000), "two": np.float32(2), "three": np.float32(3)})
        model = case.model()
        model.graph.input.append(onnx.helper.make_tensor_value_info("rate", onnx.TensorProto.INT64, shape))
        path = self.folder / "rate.onnx"
        path.write_bytes(model.SerializeToString())
        return path

    def test_an_input_that_is_a_number_becomes_a_constant(self):
        x = np.random.default_rng(1).standard_normal((3, 4, 5)).astype(np.float32)
        for shape in ([], [1]):
            for rate, factor in ((16000, 2), (8000, 3)):
                status, _ = convert([self.with_a_rate(shape), "-o", self.folder / "y.mien", "--value", f"rate={rate}"])
                self.assertEqual(status, 0)
                y, = run_network(self.folder, self.folder / "y.mien", x)
                np.testing.assert_allclose(y, factor * x, rtol=1e-6)

    def test_an_input_that_is_a_number_and_is_not_given(self):
        for arguments, refusal in (((),
                                    "input 'rate' is an integer, which no layer reads; make it a constant: --value "
                                    "rate=NUMBER"),
                                   (("--value", "rate=0.5"), "input 'rate': not a whole number (got 0.5)"),
                                   (("--value", "none=1"), "no input 'none'; there is x, rate"),
                                   (("--value", "x=1"), "input 'x': not a single number (got a shape [1, 3, 4, 5])")):
            with self.subTest(refusal):
                self.assertIn(refusal, convert([self.with_a_rate([]), "-o", self.folder / "y.mien", *arguments])[0])
                self.assertFalse((self.folder / "y.mien").exists())
        with contextlib.redirect_stderr(io.StringIO()) as errors:
            self.assertEqual(convert([self.with_a_rate([]), "-o", self.folder / "y.mien", "--value", "rate"])[0], 2)
        self.assertIn("'rate' is not INPUT=NUMBER", errors.getvalue())

    def test_files_that_are_none(self):
        (self.folder / "text.onnx").write_text("not a network")
        (self.folder / "empty.onnx").write_bytes(b"")
        # protobuf reads the part before the error
        (self.folder / "half.onnx").write_bytes(self.model().read_bytes() + b"\x0c")
        for name in ("text", "empty", "half"):
            status, _ = convert([self.folder / f"{name}.onnx", "-o", self.folder / "y.mien"])
            self.assertIn("not an ONNX file", status)
        status, _ = convert([self.folder / "nowhere.onnx", "-o", self.folder / "y.mien"])
        self.assertIn("No such file", status)

    def test_graphs_that_are_malformed(self):
        """Graphs that caused tracebacks, found by fuzz/onnx_converter.py."""
        for nodes in ([operator_cases.node("Concat", "x x")], [operator_cases.node("Relu", "")],
                      [operator_cases.node("Conv", "x w", group=0)]):
            with self.subTest(nodes[0].op_type):
                status, _ = convert([self.model(nodes=nodes, constants={"w": operator_cases.weights(5, 3, 1, 1)}), "-o",
                                     self.folder / "y.mien"])
                self.assertIsInstance(status, str)
                self.assertIn(f"{nodes[0].op_type} 'the_{nodes[0].op_type.lower()}'", status)
                self.assertEqual(len(status.splitlines()), 1)

    def with_external_weights(self, **external):
        """Converts a model whose weights are in another file."""
        case = operator_cases.Case("net", [operator_cases.node("Conv", "x w")], {"x": [1, 3, 4, 5]},
                                   constants={"w": operator_cases.weights(5, 3, 1, 1)})
        model = case.model()
        weights = model.graph.initializer[0]
        data = weights.raw_data
        onnx.external_data_helper.set_external_data(weights, **external)
        weights.ClearField("raw_data")
        path = self.folder / "external.onnx"
        path.write_bytes(model.SerializeToString())
        return data, convert([path, "-o", self.folder / "y.mien"])[0]

    def test_weights_in_another_file_beside_the_model(self):
        (self.folder / "here").mkdir()
        data, _ = self.with_external_weights(location="weights.bin")
        (self.folder / "weights.bin").write_bytes(bytes(16) + data + b"more")
        (self.folder / "here/weights.bin").write_bytes(data)
        x = np.random.default_rng(1).standard_normal((3, 4, 5)).astype(np.float32)
        want = np.einsum("oi,ihw->ohw", np.frombuffer(data, np.float32).reshape(5, 3), x)
        for external in ({"location": "weights.bin", "offset": 16,
                          "length": len(data)}, {"location": "here/weights.bin"}):
            with self.subTest(external):
                self.assertEqual(self.with_external_weights(**external)[1], 0)
                y, = run_network(self.folder, self.folder / "y.mien", x)
                np.testing.assert_allclose(y, want, atol=1e-5)

    def test_weights_in_another_file_that_is_not_there_or_not_theirs(self):
        (self.folder / "short.bin").write_bytes(bytes(59))
        os.symlink("/etc/passwd", self.folder / "link.bin")
        for external, refusal in (({"location": "../../etc/passwd"},
                                   "outside the model's folder"), ({"location": "/etc/passwd"}, "outside the model"),
                                  ({"location": "link.bin"}, "outside the model"), ({"location": "none.bin"},
                                                                                    "no file 'none.bin' beside the "
                                                                                    "model"),
                                  ({"location": "."}, "no file '.'"), ({"location": "short.bin", "length": 60},
                                                                       "too short (got 59 bytes, expected 60)"),
                                  ({"location": "short.bin", "offset": 1 << 62, "length": 60},
                                   "too short"), ({"location": "short.bin"}, "malformed")):
            with self.subTest(external):
                _, status = self.with_external_weights(**external)
                self.assertIsInstance(status, str)
                self.assertIn("weights 'w'", status)
                self.assertIn(refusal, status)
                self.assertNotIn("\n", status)
                self.assertFalse((self.folder / "y.mien").exists())

    def test_as_a_program(self):
        program = [sys.executable, "-m", "mien_convert"]
        done = subprocess.run([*program, str(self.model()), "-o", str(self.folder / "y.mien")], capture_output=True,
                              text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        refused = self.model("bad", [operator_cases.node("Sin", "x")])
        done = subprocess.run([*program, str(refused), "-o", str(self.folder / "z.mien")], capture_output=True,
                              text=True)
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stderr.count("\n"), 1)
        self.assertIn("Sin 'the_sin': the engine has no such layer (opset 13); replace it with", done.stderr)
        self.assertFalse((self.folder / "z.mien").exists())
        self.assertEqual(subprocess.run([*program, "--shape", "0"], capture_output=True).returncode, 2)

    def test_an_attribute_without_name_and_type_is_said_in_a_line(self):
        model = operator_cases.Case("net", [operator_cases.node("Relu", "x")], {"x": [1, 3, 4, 5]}).model()
        model.graph.node[0].attribute.add(name="")
        path = self.folder / "nameless.onnx"
        path.write_bytes(model.SerializeToString())
        status, _ = convert([path, "-o", self.folder / "y.mien"])
        self.assertRegex(status, "^onnx_to_mien.py: .*nameless.onnx: .*$")
        self.assertNotIn("\n", status)

    def test_insufficient_memory_is_reported_in_one_line(self):
        """At any point: a map of 16 million numbers, with limits from less than the input to almost enough."""
        large = self.folder / "large.onnx"
        large.write_bytes(operator_cases.Case(
            "net", [operator_cases.node("Relu", "x")], {"x": [1, 64, 512, 512]}).model().SerializeToString())
        program = [sys.executable, "-m", "mien_convert", str(large), "-o", str(self.folder / "y.mien")]
        for megabytes in (250, 400, 550):
            room = (megabytes << 20,) * 2
            done = subprocess.run(program, capture_output=True, text=True,
                                  env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
                                  preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, room))
            self.assertEqual((done.returncode, done.stderr.count("\n")), (1, 1), done.stderr)
            self.assertIn("out of memory", done.stderr)
            self.assertFalse((self.folder / "y.mien").exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
