"""Predictions of llvm-mca for an inner loop."""
import re
import subprocess

import inner_loops

# LLVM has models of the server cores that share A76's and X1's designs, and uses A57's for A76 and X1. For X2 it uses Neoverse N2's.
CPUS = {"Cortex-A53": "cortex-a53", "Cortex-A55": "cortex-a55", "Cortex-A76": "neoverse-n1", "Cortex-X1": "neoverse-v1",
        "Cortex-A510": "cortex-a510", "Cortex-X2": "cortex-x2"}
ITERATIONS = 200
PROGRAM = "llvm-mca-19"
HOST = "native"  # the CPU of this machine


def _report(loop, cpu):
    arm = [] if cpu == HOST else ["-mtriple=aarch64", "-mattr=+fullfp16,+dotprod,+i8mm"]
    out = subprocess.run([PROGRAM, *arm, f"-mcpu={cpu}", f"-iterations={ITERATIONS}"], input=inner_loops.assembly(loop), check=True,
                         capture_output=True, text=True).stdout
    cycles = int(re.search(r"Total Cycles:\s+(\d+)", out).group(1)) / ITERATIONS
    return cycles, float(re.search(r"Block RThroughput:\s+([\d.]+)", out).group(1))


def cycles_per_multiply(loop, cpu):
    return _report(loop, cpu)[0] / inner_loops.count(loop, *inner_loops.MULTIPLIES)


def share_of_limit(loop, cpu):
    """Cycles that the units need for the products alone, over the cycles the loop takes."""
    alone = [one for one in loop if one[1] in (*inner_loops.MULTIPLIES, "fmul")]
    return _report(alone, cpu)[1] / _report(loop, cpu)[0]
