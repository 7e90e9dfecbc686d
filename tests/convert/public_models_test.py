#!/usr/bin/env python3
"""Converts every ONNX file of a folder and compares the outputs for noise with ONNX Runtime's, one line per file.

usage: public_models_test.py MIEN_PROGRAM [FOLDER]      default: $MIEN_ONNX_MODELS, else ~/.cache/mien/onnx_models
Exit status 1: an output differs by more than 1e-3 of its largest value, or an error has no reason. 77: no folder or
no ONNX Runtime (npm package, scripts/peers/install_onnxruntime.sh).
"""
import os
import sys
import tempfile
from pathlib import Path

try:
    import numpy as np
    import onnx
    from conversion import MODULES, Runtime, convert, difference, run_network, runtime_is_here
except ModuleNotFoundError as missing:
    print("skipped: missing Python module", missing.name + "; scripts/setup.sh convert installs it")
    sys.exit(77)
FOLDER = Path(sys.argv[2] if len(sys.argv) > 2 else os.environ.get("MIEN_ONNX_MODELS", MODULES.parent / "onnx_models"))
ALLOWED = 1e-3  # of the largest value


def noise(model):
    """Random values by input, in the declared shape. Open dimensions are 1."""
    random, constants = np.random.default_rng(0), {tensor.name for tensor in model.graph.initializer}
    return {i.name: random.standard_normal([d.dim_value or 1 for d in i.type.tensor_type.shape.dim]).astype(np.float32)
            for i in model.graph.input if i.name not in constants}


def check(path, folder):
    """(whether the outcome is correct, its description)"""
    network = folder / "y.mien"
    status, report = convert([path, "-o", network, "--name", "net"])
    if status:
        return " -> " in status or "'" in status, f"refused: {status}"
    inputs, runtime = noise(onnx.load(str(path), load_external_data=False)), Runtime(folder)
    runtime.add(path, [inputs], {})
    failures = runtime.run()
    if failures:
        return False, f"ONNX Runtime: {failures}"
    x = next(iter(inputs.values()))
    wanted = [y for y in runtime.outputs(0) if y.size]
    got = run_network(folder, network, x[0] if x.ndim == 4 else x)
    errors = [difference(a, b) for a, b in zip(got, wanted)]
    wrong = len(got) != len(wanted) or any(isinstance(error, str) or error > ALLOWED for error in errors)
    worst = max((error for error in errors if not isinstance(error, str)), default=0)
    layers = report.split(" layers")[0].split()[-1]
    return not wrong, f"{worst:.1e} of the largest value off, {layers} layers, {network.stat().st_size} bytes" + (
        f" WRONG {errors}" if wrong else "")


def main():
    models = sorted(FOLDER.glob("*.onnx")) if FOLDER.is_dir() else []
    if not models or not runtime_is_here():
        print(f"skipped: no ONNX file in {FOLDER}" if not models
              else "skipped: ONNX Runtime; scripts/peers/install_onnxruntime.sh fetches it")
        sys.exit(77)
    right = 0
    for path in models:
        with tempfile.TemporaryDirectory(prefix="mien_models_") as folder:
            good, line = check(path, Path(folder))
        right += good
        print(f"{path.stem}: {line}", flush=True)
    print(f"{right} of {len(models)} models are right")
    sys.exit(right < len(models))


if __name__ == "__main__":
    main()
