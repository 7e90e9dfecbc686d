#!/usr/bin/env python3
"""Times the networks of export_onnx.py in an engine on one thread, and prints JSON.

usage: engines.py ENGINE DIR
       engines.py ENGINE DIR check               only compares the outputs, and prints the differences
       engines.py ENGINE DIR NETWORK RUNS        only runs a network, for a program that counts instructions
It is an error if the engine is not installed or its output differs from PyTorch's. Networks without a file for the
engine are skipped. Engines with 8 bits run the files of quantize.py.
"""
import json
import sys
import time
from importlib.metadata import distribution
from pathlib import Path

import numpy as np

WARM_UP, RUNS = 200, 2000
# Largest root mean square difference from the expected output, relative to the output. 16 and 8 bits lose more where an
# engine or its tool does not suit the network: that is a result, but not one of another network.
EXACT, ROUNDED = 1e-3, 0.8


def onnxruntime(file, inputs):
    import onnxruntime as ort
    options = ort.SessionOptions()
    options.intra_op_num_threads = options.inter_op_num_threads = 1
    session = ort.InferenceSession(file, options, providers=["CPUExecutionProvider"])
    bound = session.io_binding()  # a third faster than run() where networks are small
    for name, x in inputs.items():
        bound.bind_cpu_input(name, x)  # read where it lies: `inputs` outlives the session
    for output in session.get_outputs():
        bound.bind_output(output.name)
    return lambda: session.run_with_iobinding(bound), lambda: bound.copy_outputs_to_cpu()[0]


def openvino(precision):
    def engine(file, inputs):
        import openvino as ov
        settings = {"INFERENCE_NUM_THREADS": 1, "NUM_STREAMS": 1, "PERFORMANCE_HINT": "LATENCY",
                    "INFERENCE_PRECISION_HINT": precision}
        request = ov.Core().compile_model(file, "CPU", settings).create_infer_request()
        for name, x in inputs.items():
            request.set_tensor(name, ov.Tensor(x))
        return request.infer, lambda: request.get_output_tensor(0).data
    return engine


def ncnn(half):
    def engine(file, inputs):
        import ncnn
        net = ncnn.Net()
        net.opt.num_threads, net.opt.use_vulkan_compute = 1, False
        net.opt.use_fp16_packed = net.opt.use_fp16_storage = net.opt.use_fp16_arithmetic = half
        net.opt.use_bf16_packed = net.opt.use_bf16_storage = half
        net.load_param(file)
        net.load_model(file.replace(".param", ".bin"))
        mats = [ncnn.Mat(np.ascontiguousarray(x[0])).clone() for x in inputs.values()]
        outputs = sorted(net.output_names())  # out0, out1, ...

        def run():
            extractor = net.create_extractor()
            for i, mat in enumerate(mats):
                extractor.input(f"in{i}", mat)
            return [extractor.extract(name)[1] for name in outputs]
        return run, lambda: np.array(run()[0])
    return engine


def litert(file, inputs):
    from ai_edge_litert.interpreter import Interpreter
    interpreter = Interpreter(file, num_threads=1)
    interpreter.allocate_tensors()
    (image,), (taken,), given = inputs.values(), interpreter.get_input_details(), interpreter.get_output_details()[0]
    image = np.ascontiguousarray(image.transpose(0, 2, 3, 1))
    if taken["dtype"] == np.int8:
        scale, zero = taken["quantization"]
        image = np.clip(np.round(image / scale) + zero, -128, 127).astype(np.int8)
    interpreter.set_tensor(taken["index"], image)

    def output():
        scale, zero = given["quantization"] if given["dtype"] == np.int8 else (1, 0)
        return (interpreter.get_tensor(given["index"]).astype(np.float32) - zero) * scale
    return interpreter.invoke, output


OPENVINO = ["openvino/libs/libopenvino.so.*", "openvino/libs/libopenvino_intel_cpu_plugin.so",
            "openvino/libs/libopenvino_onnx_frontend.so.*"]
ONNXRUNTIME = ["onnxruntime/capi/libonnxruntime.so.*"]
LITERT = ["ai_edge_litert/libpywrap_litert_common.so"]
# name: (runner, end of the file's name, tolerance, package, files that a program ships)
ENGINES = {
    "onnxruntime": (onnxruntime, ".onnx", EXACT, "onnxruntime", ONNXRUNTIME),
    "onnxruntime_int8": (onnxruntime, ".onnxruntime_int8.onnx", ROUNDED, "onnxruntime", ONNXRUNTIME),
    "openvino": (openvino("f32"), ".onnx", EXACT, "openvino", OPENVINO),
    "openvino_bf16": (openvino("bf16"), ".onnx", ROUNDED, "openvino", OPENVINO),
    "openvino_int8": (openvino("f32"), ".openvino_int8.xml", ROUNDED, "openvino", OPENVINO),
    "ncnn": (ncnn(False), ".ncnn.param", EXACT, "ncnn", ["ncnn/*.so"]),
    "ncnn_16bit": (ncnn(True), ".ncnn.param", ROUNDED, "ncnn", ["ncnn/*.so"]),
    "litert": (litert, ".tflite", EXACT, "ai-edge-litert", LITERT),
    "litert_int8": (litert, ".litert_int8.tflite", ROUNDED, "ai-edge-litert", LITERT),
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


def difference(load, file, inputs, answers):
    """Of the outputs of all samples, root mean square, relative to the expected ones."""
    outputs = []
    for i in range(len(answers)):
        run, output = load(file, {name: np.ascontiguousarray(x[i:i + 1]) for name, x in inputs.items()})
        run()
        outputs.append(np.ravel(output()).copy())
    return float(np.linalg.norm(np.stack(outputs) - answers) / np.linalg.norm(answers))


def repeat(load, file, inputs, runs):
    run, _ = load(file, {name: np.ascontiguousarray(x[:1]) for name, x in inputs.items()})
    for _ in range(runs):
        run()


def networks_in(directory, suffix):
    """(name, file for the engine, inputs, answers) of each network that has such a file."""
    for samples in sorted(directory.glob("*.npz")):
        file = f"{directory / samples.stem}{suffix}"
        if Path(file).exists():
            inputs = dict(np.load(samples))
            answer = inputs.pop("answer")
            yield samples.stem, file, inputs, answer.reshape(len(answer), -1)


def checked(engine, directory):
    """(name, file, inputs, error) of each network; ends the program if an output is wrong."""
    load, suffix, tolerance, *_ = ENGINES[engine]
    for name, file, inputs, answers in networks_in(directory, suffix):
        error = difference(load, file, inputs, answers)
        if not error <= tolerance:
            sys.exit(f"engines.py: {engine}: {name}: wrong output (differs by {error:.2g} of its size)")
        yield name, file, inputs, error


def measure(engine, directory):
    load, _, _, package, files = ENGINES[engine]
    networks = {}
    for name, file, inputs, error in checked(engine, directory):
        run, _ = load(file, {key: np.ascontiguousarray(x[:1]) for key, x in inputs.items()})
        times = timed(run)
        networks[name] = {"min_ms": times[0], "median_ms": times[RUNS // 2], "difference": error}
    return {"version": distribution(package).version, "bytes": shipped_bytes(package, files), "networks": networks}


def main():
    engine, directory, *only = sys.argv[1], Path(sys.argv[2]), *sys.argv[3:]
    if only == ["check"]:
        print(json.dumps({name: error for name, _, _, error in checked(engine, directory)}))
    elif only:
        found = {name: (file, inputs) for name, file, inputs, _ in networks_in(directory, ENGINES[engine][1])}
        repeat(ENGINES[engine][0], *found[only[0]], int(only[1]))
    else:
        print(json.dumps(measure(engine, directory)))


if __name__ == "__main__":
    main()
