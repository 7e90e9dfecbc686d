"""Predictions of llvm-mca for an inner loop."""
import re
import subprocess

import inner_loops

CPUS = ["cortex-a53", "cortex-a55", "cortex-a76"]
ITERATIONS = 200


def _report(loop, cpu):
    out = subprocess.run(["llvm-mca", "-mtriple=aarch64", f"-mcpu={cpu}", f"-iterations={ITERATIONS}"],
                         input=inner_loops.assembly(loop), check=True, capture_output=True,
                         text=True).stdout
    cycles = int(re.search(r"Total Cycles:\s+(\d+)", out).group(1)) / ITERATIONS
    return cycles, float(re.search(r"Block RThroughput:\s+([\d.]+)", out).group(1))


def share_of_limit(loop, cpu, *mnemonics):
    """Cycles that the units need for these instructions alone, over the cycles the loop takes."""
    alone = [one for one in loop if one[1] in mnemonics]
    return _report(alone, cpu)[1] / _report(loop, cpu)[0]
