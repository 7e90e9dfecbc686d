"""Instructions a network's run takes, counted by qemu-user, per kernel family."""
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
        for path in objects.rglob("*.o"):
            listing = subprocess.run([nm, "--defined-only", path], check=True,
                                     capture_output=True, text=True).stdout
            for line in listing.splitlines():
                symbol = line.split()[-1]
                owners.setdefault(symbol, set()).add(path.parent.name)
        return {symbol: names.pop() for symbol, names in owners.items() if len(names) == 1}

    def _counts(self, plugin, work, model, network, runs):
        output = work / "counts.txt"
        run = subprocess.run([*self.emulator, "-plugin", f"{plugin},output={output}", self.program,
                              model, network, self.tier, str(runs)],
                             check=True, capture_output=True, text=True)
        counts = Counter()
        for line in output.read_text().splitlines():
            number, symbol = line.split(" ", 1)
            counts[symbol] += int(number)
        return counts, run.stdout

    def one_run(self, plugin, work, model, network):
        """({family: instructions}, {family: multiply-accumulates}) of one run."""
        once, _ = self._counts(plugin, work, model, network, 1)
        twice, layers = self._counts(plugin, work, model, network, 2)
        instructions, macs = Counter(), Counter()
        for symbol, number in (twice - once).items():
            instructions[self.family_of.get(symbol, "other")] += number
        for op, number in re.findall(r"^(\w+) (\d+)$", layers, re.MULTILINE):
            macs[op] += int(number)
        return instructions, macs
