"""Writes the instructions of other engines for a run of the encoders on a Cortex-A76.

usage: arm_peers.py WORK_DIR PYTHON_ROOT NETWORKS_DIR OUT_FILE      (see arm_peers.sh)
"""
import json
import subprocess
import sys
from pathlib import Path

CPU = "cortex-a76"  # has dot products and fp16
ENGINES = ("ncnn", "ncnn_16bit", "litert", "litert_int8", "onnxruntime", "onnxruntime_int8")
MORE = 41  # runs: the interpreter's own instructions vary by a million
NETWORKS = ("basenet_encoder", "hifinet_encoder")
SCRIPT = Path(__file__).resolve().parents[1] / "peers/engines.py"


def emulator(work, root, *options):
    return ["qemu-aarch64", "-cpu", CPU, *options, "-L", root, "-E", f"PYTHONPATH={work / 'packages'}", "-E",
            f"PYTHONHOME={root / 'usr'}", "-E", "OMP_NUM_THREADS=1", "-E", "PYTHONHASHSEED=0", root / "usr/bin/python3.11"]


def differences(work, root, networks, engine):
    """Of the outputs from PyTorch's, by network; none if the engine fails."""
    run = subprocess.run([*emulator(work, root), SCRIPT, engine, networks, "check"], capture_output=True, text=True)
    if run.returncode:
        print(f"NOT MEASURED: {engine} on ARM: {(run.stderr.splitlines() or [run.returncode])[-1]}", file=sys.stderr)
        return {}
    return json.loads(run.stdout)


def counts(work, root, networks, engine, network):
    def count(runs):
        output = work / "count.txt"
        command = emulator(work, root, "-plugin", f"{work / 'libcount.so'},output={output}")
        subprocess.run([*command, SCRIPT, engine, networks, network, str(runs)], check=True, capture_output=True)
        return int(output.read_text())
    return (count(MORE) - count(1)) // (MORE - 1)


def main():
    work, root, networks, out = map(Path, sys.argv[1:])
    found = {}
    for engine in ENGINES:
        errors = differences(work, root, networks, engine)
        rows = {network: {"instructions": counts(work, root, networks, engine, network), "difference": errors[network]}
                for network in NETWORKS if network in errors}
        found |= {engine: rows} if rows else {}
    out.write_text(json.dumps(found, indent=1) + "\n")


main()
