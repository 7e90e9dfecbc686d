"""Counts instructions per kernel family and cache traffic of one run of a network, with qemu-user."""
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
        """{symbol: family}, without symbols that several families share."""
        owners = {}
        for path in (path for folder in objects for path in folder.rglob("*.o")):
            listing = subprocess.run([nm, "--defined-only", path], check=True, capture_output=True, text=True).stdout
            for line in listing.splitlines():
                symbol = line.split()[-1]
                owners.setdefault(symbol, set()).add(path.parent.name)
        return {symbol: names.pop() for symbol, names in owners.items() if len(names) == 1}

    def _run(self, plugin, output, network, runs, mode="fused"):
        model, name = network
        return subprocess.run([*self.emulator, "-plugin", f"{plugin},output={output}", self.program,
                               f"models/{model}.mien", name, self.tier, str(runs), mode],
                              check=True, capture_output=True, text=True).stdout

    def _counts(self, work, network, runs, mode):
        output = work / "counts.txt"
        layers = self._run(work / "libcount.so", output, network, runs, mode)
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

    def traffic(self, work, network, mode="fused"):
        """Bytes into the first-level cache and into the second, of one run after another."""
        output = work / "traffic.txt"
        lines = []
        for runs in (1, 2):
            self._run(work / "libcache.so", output, network, runs, mode)
            lines.append([int(number) for number in output.read_text().split()[1:]])
        return [64 * (after - before) for before, after in zip(*lines)]
