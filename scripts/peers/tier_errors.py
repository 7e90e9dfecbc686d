#!/usr/bin/env python3
"""Prints, as JSON, how far the encoders of each tier of mien are from PyTorch's, as engines.py measures its engines.

usage: tier_errors.py MIEN DIR BENCH_JSON      BENCH_JSON: output of `mien bench --json`, which names the tiers
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

MODELS = Path(__file__).resolve().parents[2] / "models"


def error(program, tier, name, samples):
    with tempfile.TemporaryDirectory() as folder:
        given, taken = f"{folder}/in.npy", f"{folder}/out.npy"
        np.save(given, samples["image"])
        subprocess.run([program, "run", MODELS / f"{name}.mien", "--network", "encoder", "--tier", tier, "--input",
                        given, "--output", taken], check=True, stdout=subprocess.DEVNULL)
        answer = samples["answer"].reshape(len(samples["answer"]), -1)
        outputs = np.load(taken).reshape(answer.shape)
    return float(np.linalg.norm(outputs - answer) / np.linalg.norm(answer))


def main():
    program, folder = sys.argv[1], Path(sys.argv[2])
    tiers = {r["tier"] for r in json.loads(Path(sys.argv[3]).read_text())["results"]} - {"ref"}
    found = {}
    for calibration in sorted(folder.glob("*_encoder.npy")):
        samples, name = dict(np.load(calibration.with_suffix(".npz"))), calibration.stem.removesuffix("_encoder")
        found[calibration.stem] = {tier: error(program, tier, name, samples) for tier in sorted(tiers)}
    print(json.dumps(found))


if __name__ == "__main__":
    main()
