"""Instructions of a run of a network per kernel family, counted by qemu-user."""
import re
import subprocess
from collections import Counter


class Machine:
    """A tier, how to run its programs, and the objects of its kernels."""

    def __init__(self, tier, emulator, program, objects, nm):
        self.tier, self.emulator, self.program = tier, emulator, program
        self.family_of = self._families(objects, nm)

    @staticmethod
    def _families(objects, nm):
        """{symbol: family}; what several families share belongs to none."""
        owners = {}
        for path in (path for folder in objects for path in folder.rglob("*.o")):
            listing = subprocess.run([nm, "--defined-only", path], check=True, capture_output=True, text=True).stdout
            for line in listing.splitlines():
                symbol = line.split()[-1]
                owners.setdefault(symbol, set()).add(path.parent.name)
        return {symbol: names.pop() for symbol, names in owners.items() if len(names) == 1}

    def _counts(self, work, network, runs, mode):
        output, (model, name) = work / "counts.txt", network
        layers = subprocess.run([*self.emulator, "-plugin", f"{work / 'libcount.so'},output={output}", self.program,
                                 f"models/{model}.mien", name, self.tier, str(runs), mode],
                                check=True, capture_output=True, text=True).stdout
        counts = Counter()
        for line in output.read_text().splitlines():
            number, symbol = line.split(" ", 1)
            counts[symbol] += int(number)
        return counts, layers

    def one_run(self, work, network, mode="fused"):
        """({family: instructions}, {family: multiply-accumulates}) of one run."""
        once, _ = self._counts(work, network, 1, mode)
        twice, layers = self._counts(work, network, 2, mode)
        instructions, macs = Counter(), Counter()
        for symbol, number in (twice - once).items():
            instructions[self.family_of.get(symbol, "other")] += number
        for op, number in re.findall(r"^(\w+) (\d+)$", layers, re.MULTILINE):
            macs[op] += int(number)
        return instructions, macs
