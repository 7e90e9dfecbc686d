#!/usr/bin/env python3
"""Times the networks of export_onnx.py in an engine on one thread, and prints JSON.

usage: engines.py ENGINE DIR
It is an error if the engine is not installed or its output differs from PyTorch's. Networks without a file for the
engine are skipped.
"""
import json
import sys
import time
from importlib.metadata import distribution
from pathlib import Path

import numpy as np

WARM_UP, RUNS = 200, 2000
EXACT, HALF = 1e-3, 5e-2  # largest difference from the expected output, relative to its largest value


def onnxruntime(stem, inputs):
    import onnxruntime as ort
    options = ort.SessionOptions()
    options.intra_op_num_threads = options.inter_op_num_threads = 1
    session = ort.InferenceSession(f"{stem}.onnx", options, providers=["CPUExecutionProvider"])
    bound = session.io_binding()  # a third faster than run() where networks are small
    for name, x in inputs.items():
        bound.bind_cpu_input(name, x)  # read where it lies: `inputs` outlives the session
    for output in session.get_outputs():
        bound.bind_output(output.name)
    return lambda: session.run_with_iobinding(bound), lambda: bound.copy_outputs_to_cpu()[0]


def openvino(precision):
    def engine(stem, inputs):
        import openvino as ov
        settings = {"INFERENCE_NUM_THREADS": 1, "NUM_STREAMS": 1, "PERFORMANCE_HINT": "LATENCY",
                    "INFERENCE_PRECISION_HINT": precision}
        request = ov.Core().compile_model(f"{stem}.onnx", "CPU", settings).create_infer_request()
        for name, x in inputs.items():
            request.set_tensor(name, ov.Tensor(x))
        return request.infer, lambda: request.get_output_tensor(0).data
    return engine


def ncnn(half):
    def engine(stem, inputs):
        import ncnn
        net = ncnn.Net()
        net.opt.num_threads, net.opt.use_vulkan_compute = 1, False
        net.opt.use_fp16_packed = net.opt.use_fp16_storage = net.opt.use_fp16_arithmetic = half
        net.opt.use_bf16_packed = net.opt.use_bf16_storage = half
        net.load_param(f"{stem}.ncnn.param")
        net.load_model(f"{stem}.ncnn.bin")
        mats = [ncnn.Mat(np.ascontiguousarray(x[0])).clone() for x in inputs.values()]
        outputs = sorted(net.output_names())  # out0, out1, ...

        def run():
            extractor = net.create_extractor()
            for i, mat in enumerate(mats):
                extractor.input(f"in{i}", mat)
            return [extractor.extract(name)[1] for name in outputs]
        return run, lambda: np.array(run()[0])
    return engine


def litert(stem, inputs):
    from ai_edge_litert.interpreter import Interpreter
    interpreter = Interpreter(f"{stem}.tflite", num_threads=1)
    interpreter.allocate_tensors()
    (image,) = inputs.values()
    interpreter.set_tensor(interpreter.get_input_details()[0]["index"],
                           np.ascontiguousarray(image.transpose(0, 2, 3, 1)))
    return interpreter.invoke, lambda: interpreter.get_tensor(interpreter.get_output_details()[0]["index"])


OPENVINO = ["openvino/libs/libopenvino.so.*", "openvino/libs/libopenvino_intel_cpu_plugin.so",
            "openvino/libs/libopenvino_onnx_frontend.so.*"]
# name: (runner, file format, tolerance, package, files that a program ships)
ENGINES = {
    "onnxruntime": (onnxruntime, ".onnx", EXACT, "onnxruntime", ["onnxruntime/capi/libonnxruntime.so.*"]),
    "openvino": (openvino("f32"), ".onnx", EXACT, "openvino", OPENVINO),
    "openvino_bf16": (openvino("bf16"), ".onnx", HALF, "openvino", OPENVINO),
    "ncnn": (ncnn(False), ".ncnn.param", EXACT, "ncnn", ["ncnn/*.so"]),
    "ncnn_16bit": (ncnn(True), ".ncnn.param", HALF, "ncnn", ["ncnn/*.so"]),
    "litert": (litert, ".tflite", EXACT, "ai-edge-litert", ["ai_edge_litert/libpywrap_litert_common.so"]),
}


def shipped_bytes(package, patterns):
    """0 where it is not known."""
    root = Path(distribution(package).locate_file(""))
    return sum(file.stat().st_size for pattern in patterns for file in root.glob(pattern))


def timed(run):
    """Sorted times in ms."""
    times = []
    for _ in range(WARM_UP + RUNS):
        begin = time.perf_counter_ns()
        run()
        times.append((time.perf_counter_ns() - begin) / 1e6)
    return sorted(times[WARM_UP:])


def main():
    engine, directory = sys.argv[1], Path(sys.argv[2])
    load, suffix, tolerance, package, files = ENGINES[engine]
    networks = {}
    for file in sorted(directory.glob("*.npz")):
        stem = directory / file.stem
        if not Path(f"{stem}{suffix}").exists():
            continue
        inputs = dict(np.load(file))
        answer = inputs.pop("answer").ravel()
        run, output = load(stem, inputs)
        run()
        difference = float(np.abs(np.ravel(output()) - answer).max() / np.abs(answer).max())
        if not difference <= tolerance:
            sys.exit(
                f"engines.py: {engine}: {file.stem}: wrong output (differs by {difference:.2g} of its largest value)")
        times = timed(run)
        networks[file.stem] = {"min_ms": times[0], "median_ms": times[RUNS // 2], "difference": difference}
    print(json.dumps({"version": distribution(package).version, "bytes": shipped_bytes(package, files),
                      "networks": networks}))


if __name__ == "__main__":
    main()
