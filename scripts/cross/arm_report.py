#!/usr/bin/env python3
"""Writes docs/results/arm.md.  usage: arm_report.py WORK_DIR OUT_FILE   (see arm_report.sh)"""
import json
import re
import struct
import subprocess
import sys
from pathlib import Path

import inner_loops
import predict
from count_instructions import Machine

from mien_convert.weight_file import OPS, RECORD_BYTES, sealed

NETWORKS = [("basenet", "encoder"), ("hifinet", "encoder"), ("audionet", "encoder")]
LOOPS = [  # tier, object, pattern of the function's name, what it is
    ("neon", "pointwise/neon_product", r"tile<9, 2, .*Halves", "pointwise, 9 pixels x 8 channels, weights widened inside"),
    ("neon", "inverted_residual/neon", r"whole_outputs<.*Floats, 2, 1, 16, 8>", "depthwise 3x3, stride 1, 2x2 outputs"),
    ("neon", "lstm/neon", r"matvec_panel<4>", "matrix times vector, 16 outputs"),
    ("neonfp16", "inverted_residual/neonfp16_product", r"tile<9, 2>", "pointwise, 9 pixels x 16 channels"),
    ("neonfp16", "inverted_residual/neonfp16", r"whole_outputs<.*Halves, 2, 1, ", "depthwise 3x3, stride 1, 2x2 outputs"),
    ("neonfp16", "lstm/neon", r"matvec_panel<4>", "matrix times vector, 16 outputs"),
    ("neondot", "inverted_residual/neondot_product", r"tile<.*HalfPanel, .*ToStrip, 9>", "pointwise, 9 pixels x 8 channels"),
    ("neoni8mm", "inverted_residual/neoni8mm_product", r"tile<.*ToStrip, 12>", "pointwise, 12 pixels x 8 channels"),
]
TITLES = {"ncnn": "ncnn", "ncnn_16bit": "ncnn, fp16", "litert": "LiteRT (XNNPACK)", "litert_int8": "LiteRT, int8",
          "onnxruntime": "ONNX Runtime", "onnxruntime_int8": "ONNX Runtime, int8"}
VISIBLE = 5e-4  # error of an output
WITHOUT_FP16 = "Cortex-A53"
WITH_I8MM = "Cortex-A510", "Cortex-X2"
X86_LOOPS = [  # kernel, object, pattern of the function's name
    ("pointwise", "pointwise/avx2_product", r"tile<6, 2, float>"),
    ("fully_connected", "fully_connected/avx2", r"avx2::fully_connected"),
    ("causal_conv", "causal_conv/avx2", r"avx2::causal_conv"),
]


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def loop_of(folder, name, pattern, objdump="aarch64-linux-gnu-objdump"):
    found = inner_loops.functions(objdump, folder / f"{name}.cpp.o")
    return inner_loops.busiest_loop(next(body for function, body in found.items() if re.search(pattern, function)))


def has_tier(cpu, tier):
    return cpu in WITH_I8MM if tier == "neoni8mm" else tier == "neon" or cpu != WITHOUT_FP16


def predictions(folder_of):
    rows = []
    for tier, name, pattern, what in LOOPS:
        loop = loop_of(folder_of(tier), name, pattern)
        rows.append([tier, what, *(f"{predict.share_of_limit(loop, model):.0%}" if has_tier(cpu, tier) else "-"
                                   for cpu, model in predict.CPUS.items())])
    return rows


def i8mm_gain(folder_of):
    """A sentence about the cycles of neoni8mm's products; an instruction has twice as many as neondot's."""
    dot, i8mm = (loop_of(folder_of(tier), name, pattern) for tier, name, pattern, _ in LOOPS[-2:])
    ratios = [f"{predict.cycles_per_multiply(i8mm, predict.CPUS[cpu]) / predict.cycles_per_multiply(dot, predict.CPUS[cpu]) / 2:.2f} on {cpu}"
              for cpu in WITH_I8MM]
    return f"A product of `neoni8mm` takes, relative to `neondot`, {' and '.join(ratios)}."


def prediction_error(folder, conformance):
    """A sentence about kernels of this machine's CPU: predictions, and the shares of its peak that they reach."""
    measured = {row["name"]: row for row in json.loads(output_of(conformance, "--tier", "avx2", "--bench", "--json", "-"))["results"]}
    shares = [f"`{kernel}` {predict.share_of_limit(loop_of(folder, name, pattern, 'objdump'), predict.HOST):.0%} ({measured[kernel]['peak_share']:.0%})"
              for kernel, name, pattern in X86_LOOPS]
    return f"On x86, llvm-mca predicts for {', '.join(shares)}; in parentheses, measurements of whole kernels."


def largest_difference(rows, others):
    """The largest difference between the percentages of two tables of predictions, in points."""
    points = lambda cell: int(cell.removesuffix("%"))
    return max(abs(points(a) - points(b)) for row, other in zip(rows, others) for a, b in zip(row[2:], other[2:]) if a != "-")


def write_with_bounds(source, target):
    """Copies a weight file with input bounds for all pointwise layers; instructions do not depend on the value."""
    file = bytearray(source.read_bytes())
    networks, layers = struct.unpack_from("<II", file, 20)
    for at in (RECORD_BYTES * (1 + networks + i) for i in range(layers)):
        if struct.unpack_from("<H", file, at)[0] == OPS["pointwise"]:
            struct.pack_into("<H", file, 10, 3)  # minor version
            struct.pack_into("<f", file, at + 60, 6.0)
    target.write_bytes(sealed(bytes(file)))


def instructions(machines, work):
    """Rows of the networks: instructions per multiply-accumulate of each machine, and their ratio to the last one's;
    and multiply-accumulates by network."""
    rows, macs = [], {}
    for network in NETWORKS:
        counts = [machine.one_run(work, network) for machine in machines]
        per_mac, name = [count / macs_of_run for count, macs_of_run in counts], "_".join(network)
        macs[name] = counts[0][1]
        rows.append([name, *(f"{each:.3f} ({each / per_mac[-1]:.2f})" for each in per_mac[:-1]), f"{per_mac[-1]:.3f}"])
    return rows, macs


def others(file, macs):
    """The section about other engines, from the results of arm_peers.sh."""
    found = json.loads(file.read_text())
    names = list(next(iter(found.values())))
    error = lambda row: f" ({100 * row['difference']:.1f} %)" if row["difference"] > VISIBLE else ""
    cell = lambda row, name: f"{row['instructions'] / macs[name]:.3f}{error(row)}"
    rows = [[TITLES[engine], *(cell(networks[name], name) for name in names)] for engine, networks in found.items()]
    return f"""
Other engines on an emulated Cortex-A76 (`scripts/cross/arm_peers.sh`), with the relative error of the output on faces:

{table(["engine", *names], rows)}"""


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def version(program):
    return next(line for line in output_of(program, "--version").splitlines() if re.search(r"\d+\.\d+", line)).strip()


def main():
    work, out = Path(sys.argv[1]), Path(sys.argv[2])
    gcc = lambda tier: work / "report-arm64/kernels/CMakeFiles" / f"mien_kernels_{tier}.dir"
    arm = (["qemu-aarch64", "-cpu", "max"], work / "run_neon")
    neon, neonfp16 = (Machine(tier, *arm) for tier in ("neon", "neonfp16"))
    in_int8 = work / "int8"
    in_int8.mkdir(exist_ok=True)
    for model, _ in NETWORKS:
        write_with_bounds(Path(f"models/{model}.mien"), in_int8 / f"{model}.mien")
    neondot, neoni8mm = (Machine(tier, *arm, in_int8) for tier in ("neondot", "neoni8mm"))
    avx2 = Machine("avx2", ["qemu-x86_64", "-cpu", "max"], work / "run_avx2")
    header = ["tier", "inner loop", *predict.CPUS]
    by_gcc = predictions(gcc)
    difference = largest_difference(by_gcc, predictions(lambda tier: work / "clang" / tier))
    x64 = work / "report-x64"
    error = prediction_error(x64 / "kernels/CMakeFiles/mien_kernels_avx2.dir", x64 / "apps/conformance/mien-conformance")
    rows, macs = instructions((neon, neonfp16, neondot, neoni8mm, avx2), work)
    text = f"""# Predicted speed on ARM

For developers of kernels. No ARM machine was available: `scripts/cross/arm_report.sh` predicts loops and counts instructions.

## Inner loops

Predictions of llvm-mca ({version(predict.PROGRAM)}): the cycles that the multiply-adds of a loop need at least, as a share of the cycles that it takes. The
models of A76, X1 and X2 are those of Neoverse N1, V1 and N2. {WITHOUT_FP16} has no fp16 arithmetic. Code of gcc; that of clang differs by at most {difference} points.

{table(header, by_gcc)}
{i8mm_gain(gcc)}

{error}

## Instructions per multiply-accumulate

One run of a network, counted by qemu-user; in parentheses relative to AVX2, whose vectors have twice the width of NEON's.
`neondot` and `neoni8mm` have [8 bits](int8.md) in pointwise layers.

{table(["network", "neon", "neonfp16", "neondot", "neoni8mm", "avx2"], rows)}{others(out.parent / "arm_peers.json", macs)}"""
    out.write_text(text)


main()
