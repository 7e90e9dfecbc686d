"""Inputs of an evaluation: program, checkpoints and features; and the parts that lack one."""
from dataclasses import dataclass, field
from pathlib import Path

import torch

from mien_training.evaluate.program import Program

PARTS = ("synthetic", "ablation", "levels", "response", "leakage", "images", "wild", "clips", "tracking", "audio",
         "audio_and_video", "yardstick", "amplitude", "orientation", "backward")  # modules evaluate_PART
# The encoder of a level. Levels 2 and 3 use LOD4's, on fewer frames.
NETWORKS = {"LOD1": "basenet", "LOD4": "hifinet"}


class Missing(Exception):
    """An input of a part is missing; the text says which, and how to create it."""


@dataclass
class Setting:
    program: Program
    checkpoints: dict   # network: (encoder, decoders), the files export.py was given
    features: Path      # folder of the features that phase 2 learns from
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

    def checkpoint(self, network):
        """(encoder, decoders), which must be those of the model file."""
        for path in self.checkpoints[network]:
            if not path.exists():
                raise Missing(
                    f"the checkpoint {path.name} of {network} is absent: train it (docs/training.md) or name it with "
                    f"--{network}")
        if not self.is_shipped(network):
            raise Missing(
                f"models/{network}.mien is no export of {' and '.join(p.name for p in self.checkpoints[network])}: "
                f"name the right checkpoints with --{network}, or export.py {network}")
        return self.checkpoints[network]

    def is_shipped(self, network):
        """Whether the last bias of the controls decoder, and of an image's encoder, are in the model file, as fp16."""
        encoder, decoders = (torch.load(p, map_location="cpu") for p in self.checkpoints[network])
        file = (self.program.models / f"{network}.mien").read_bytes()
        biases = [decoders["controls_decoder"]["output.bias"]]
        biases += [encoder["average"]["encoder.tail.2.bias"]] if "average" in encoder else []
        return all(b.detach().half().numpy().tobytes() in file for b in biases)
