"""Inputs of an evaluation, and the parts that lack one."""
from dataclasses import dataclass, field
from pathlib import Path

from mien_training.evaluate.program import Program

PARTS = ("synthetic", "levels", "response", "leakage", "images", "wild", "clips", "tracking", "audio",
         "audio_and_video", "yardstick", "amplitude", "orientation", "backward")  # modules evaluate_PART
# The encoder of a level. Levels 2 and 3 use LOD4's, on fewer frames.
NETWORKS = {"LOD1": "basenet", "LOD4": "hifinet"}


class Missing(Exception):
    """An input of a part is missing; the text says which, and how to create it."""


@dataclass
class Setting:
    program: Program
    out: Path
    skipped: list = field(default_factory=list)

    def skip(self, what, why):
        self.skipped.append(f"{what}: {why}")
        print(f"SKIPPED {self.skipped[-1]}", flush=True)

    def levels(self, part):
        """{"LOD1": 1} and, where HiFiNet is trained, {"LOD4": 4}."""
        if self.program.has_hifinet:
            return {"LOD1": 1, "LOD4": 4}
        self.skip(f"{part}, LOD2-4", f"HiFiNet is not trained yet: {self.program.models.name}/hifinet.mien is absent")
        return {"LOD1": 1}
