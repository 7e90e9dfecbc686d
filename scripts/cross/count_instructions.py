"""Instructions of a run of a network, counted by qemu-user."""
import re
import subprocess


class Machine:
    """A tier, and how to run its programs."""

    def __init__(self, tier, emulator, program, models="models"):
        self.tier, self.emulator, self.program, self.models = tier, emulator, program, models

    def _counts(self, work, network, runs):
        output, (model, name) = work / "count.txt", network
        layers = subprocess.run([*self.emulator, "-plugin", f"{work / 'libcount.so'},output={output}", self.program,
                                 f"{self.models}/{model}.mien", name, self.tier, str(runs)],
                                check=True, capture_output=True, text=True).stdout
        return int(output.read_text()), layers

    def one_run(self, work, network):
        """(instructions, multiply-accumulates) of one run."""
        once, _ = self._counts(work, network, 1)
        twice, layers = self._counts(work, network, 2)
        return twice - once, sum(int(macs) for macs in re.findall(r"^\w+ (\d+)$", layers, re.MULTILINE))
