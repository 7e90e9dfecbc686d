#!/usr/bin/env python3
"""Writes docs/results/arm.md.  usage: arm_report.py WORK_DIR OUT_FILE   (see arm_report.sh)"""
import re
import subprocess
import sys
from pathlib import Path

import inner_loops
import predict
from count_instructions import Machine

NETWORKS = [("basenet", "encoder"), ("hifinet", "encoder"), ("hifinet", "controls_decoder"),
            ("audionet", "encoder")]
FAMILIES = ["conv2d", "depthwise", "pointwise"]  # the others share code
ARITHMETIC = ("fmla", "fmax", "fmin", "fcvtl", "fcvtl2")
LOOPS = [  # family, pattern of the function's name, what it is
    ("pointwise", r"tile<5, 4, .*Widened", "pointwise, 5 pixels x 16 channels, weights widened before"),
    ("pointwise", r"tile<9, 2, .*Widened", "pointwise, 9 pixels x 8 channels, weights widened before"),
    ("pointwise", r"tile<9, 2, .*Halves", "pointwise, 9 pixels x 8 channels, weights widened inside"),
    ("depthwise", r"whole_outputs<2, 1>", "depthwise 3x3, stride 1, 2x2 outputs"),
    ("depthwise", r"whole_outputs<2, 2>", "depthwise 3x3, stride 2, 2x2 outputs"),
]


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def loop_of(objects, family, pattern):
    found = inner_loops.functions("aarch64-linux-gnu-objdump", objects / family / "neon.cpp.o")
    body = next(body for name, body in found.items()
                if re.search(pattern, name) and "tile_of" not in name)
    return inner_loops.busiest_loop(body)


def predictions(objects):
    rows = []
    for family, pattern, what in LOOPS:
        loop = loop_of(objects, family, pattern)
        shares = []
        for cpu in predict.CPUS:
            fma = predict.share_of_limit(loop, cpu, "fmla")
            every = predict.share_of_limit(loop, cpu, *ARITHMETIC)
            shares.append(f"{fma:.0%} ({every:.0%})")
        rows.append([what, str(len(loop)), str(inner_loops.count(loop, "fmla")),
                     str(inner_loops.spills(loop)), *shares])
    return rows


def counted(machines, plugin, work):
    rows = []
    for model, network in NETWORKS:
        results = [machine.one_run(plugin, work, f"models/{model}.mien", network)
                   for machine in machines]
        macs = results[0][1]
        for family in [*(f for f in FAMILIES if macs[f]), "all"]:
            every = family == "all"
            total = sum(macs.values()) if every else macs[family]
            per_mac = [(sum(i.values()) if every else i[family]) / total for i, _ in results]
            rows.append([f"{model}_{network}", family, str(total),
                         *(f"{one:.3f}" for one in per_mac), f"{per_mac[0] / per_mac[1]:.2f}"])
    return rows


def version(program):
    out = subprocess.run([program, "--version"], capture_output=True, text=True).stdout
    return next(line for line in out.splitlines() if re.search(r"\d+\.\d+", line)).strip()


def main():
    work, out = Path(sys.argv[1]), Path(sys.argv[2])
    kernels = Path("kernels/CMakeFiles")
    arm_objects = work / "report-arm64" / kernels / "mien_kernels_neon.dir"
    clang_objects = work / "clang"
    machines = [
        Machine("neon", ["qemu-aarch64", "-cpu", "max"], work / "run_neon", arm_objects,
                "aarch64-linux-gnu-nm"),
        Machine("avx2", ["qemu-x86_64", "-cpu", "max"], work / "run_avx2",
                work / "report-x64" / kernels / "mien_kernels_avx2.dir", "nm"),
    ]
    header = ["inner loop", "instructions", "FMAs", "spills", *predict.CPUS]
    text = f"""# ARM, without an ARM machine

Nothing here was timed: there was no ARM hardware. `scripts/cross/arm_report.sh` writes this file.

## Inner loops

Predicted by llvm-mca ({version("llvm-mca")}) from the objects as they are linked: the cycles that
the loop's fused multiply-adds need if nothing else limits, over the cycles the loop takes. In brackets
the same for all of its vector arithmetic: the clamping of ReLU6 (two instructions for every output of a
depthwise loop that has nine multiply-adds) and the widening of fp16 weights run on the same units, so
that share cannot be won from the first. llvm-mca 14 uses the model of Cortex-A57 for A76 and X1, and
that of Cyclone for M1; loads that miss a cache are not modelled.

gcc ({version("aarch64-linux-gnu-g++")}):

{table(header, predictions(arm_objects))}
clang ({version("clang++")}):

{table(header, predictions(clang_objects))}
## Instructions per multiply-accumulate

One run of a network, counted by qemu-user on the same weights and input; gcc on both sides. `all` is
everything that a run executes. The ratio is NEON's over AVX2's, whose vectors are twice as wide.

{table(["network", "layers", "MACs", "neon", "avx2", "ratio"], counted(machines, work / "libcount.so", work))}"""
    out.write_text(text)


main()
