"""Functions of the converter's tests: converting, running, comparing. The program is their first argument."""
import contextlib
import io
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

from mien_convert import onnx_to_mien

PROGRAM = sys.argv[1]
MODULES = Path(os.environ.get("MIEN_CACHE", Path.home() / ".cache/mien")) / "peers"


def runtime_is_here():
    return shutil.which("node") and (MODULES / "node_modules/onnxruntime-node").is_dir()


def convert(arguments):
    """Exit status (0 or the message), and the output."""
    output = io.StringIO()
    try:
        with contextlib.redirect_stdout(output):
            onnx_to_mien.main([str(a) for a in arguments])
    except SystemExit as stop:
        return stop.code or 0, output.getvalue()
    return 0, output.getvalue()


def run_network(folder, model, x, layout="chw", network=()):
    """The outputs of `mien run` for x: one array each."""
    np.save(folder / "x.npy", np.ascontiguousarray(x))
    info = json.loads(subprocess.run([PROGRAM, "inspect", model, "--json"], check=True, capture_output=True,
                                     text=True).stdout)
    paths = [folder / f"y{i}.npy" for i in range(output_count(info, network))]
    command = [PROGRAM, "run", model, "--input", folder / "x.npy", "--layout", layout, *network]
    for path in paths:
        command += ["--output", path]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise AssertionError(done.stderr)
    return [np.load(path) for path in paths]


def output_count(info, network):
    networks = [n for n in info["networks"] if not network or n["name"] == network[1]]
    return networks[0]["outputs"]


def time_axis(model):
    """The time axis of the first input, which the converter stores as metadata; None if the network has none."""
    info = json.loads(subprocess.run([PROGRAM, "inspect", model, "--json"], check=True, capture_output=True,
                                     text=True).stdout)
    note = next(value for key, value in info["metadata"].items() if key.endswith(".onnx"))
    return int(note.rsplit("time axis ", 1)[1]) if "time axis " in note else None


def difference(got, wanted):
    """The largest difference, relative to the largest expected value."""
    if got.size != wanted.size:
        return f"{got.size} numbers, not {wanted.size}"
    return float(np.abs(got.reshape(-1) - wanted.reshape(-1)).max() / max(np.abs(wanted).max(), 1e-3))


class Runtime:
    """ONNX Runtime, all jobs in one process."""

    def __init__(self, folder):
        self.folder, self.jobs = folder, []

    def add(self, model, steps, feedback):
        """steps: arrays by name, one after another."""
        number, described = len(self.jobs), []
        for at, step in enumerate(steps):
            described.append({})
            for name, array in step.items():
                path = self.folder / f"{number}.{at}.{name}.f32"
                path.write_bytes(np.ascontiguousarray(array, np.float32).tobytes())
                described[-1][name] = {"file": str(path), "shape": list(array.shape)}
        self.jobs.append({"model": str(model), "steps": described, "feedback": feedback,
                          "out": str(self.folder / str(number))})

    def run(self):
        (self.folder / "jobs.json").write_text(json.dumps(self.jobs))
        done = subprocess.run(["node", Path(__file__).resolve().parent / "onnxruntime_run.mjs", MODULES,
                               self.folder / "jobs.json"], capture_output=True, text=True,
                              check=True)
        return json.loads(done.stdout)

    def outputs(self, number):
        paths = sorted((path for path in self.folder.glob(f"{number}.*") if path.suffix[1:].isdigit()),
                       key=lambda path: int(path.suffix[1:]))
        return [np.frombuffer(path.read_bytes(), np.float32) for path in paths]
