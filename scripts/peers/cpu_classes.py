#!/usr/bin/env python3
"""Adds a class of CPUs to docs/results/cpu_classes.md, from the rounds of bench.sh.

usage: cpu_classes.py WORK_DIR ROUNDS OUT_DIR CLASS
"""
import json
import sys
from pathlib import Path

from peers import ENCODER_GOALS, ENGINES, ERROR, Runs, fastest, frames, networks, processor, shown, table

# of the fastest peer's time at any precision: BaseNet's and HiFiNet's encoder; level 4 beside MediaPipe
GOALS = {"avx2": (0.6, 0.6, 15), "avx2+vnni": (0.45, 0.45, 20), "avx512": (0.4, 0.5, 25)}


def measure(runs):
    return {"rounds": runs.rounds, "processor": processor(),
            "networks": [r for r in networks(runs) if r["network"] in ENCODER_GOALS],
            "frames": frames(runs) if "mediapipe" in runs.measured else None}


def rows(name, found):
    goals = dict(zip(ENCODER_GOALS, GOALS[name]))
    for row in found["networks"]:
        tier, peer = fastest(row["mien"]), fastest(row["peers"])
        times = row["mien"][tier]["min_ms"], row["peers"][peer]["min_ms"]
        yield [name, row["network"], f"{tier}: {shown(row['mien'][tier], 3)}",
               f"{ENGINES[peer]}: {shown(row['peers'][peer], 3)}",
               f"{times[0] / times[1]:.2f}", f"<= {goals[row['network']]}"]
    if found["frames"]:
        ours, theirs = found["frames"]["mien_us"]["4"], found["frames"]["mediapipe_us"]
        yield [name, "frame at level 4", f"{ours / 1e3:.3f}", f"MediaPipe: {theirs / 1e3:.2f}",
               f"{theirs / ours:.1f}", f">= {GOALS[name][2]}"]


def page(report):
    lines = ["# Speed by class of CPU", "", "For users who know the CPUs of their users.", "",
             "Engines of a class run on one thread of one machine, on which CPUID hides the instruction sets "
             "that the class lacks (`tests/apps/mask_cpuid.c`); fastest runs, by `scripts/peers/bench.sh ROUNDS "
             f"CLASS...`. The ratio of a frame is how many times as fast mien is. In parentheses: {ERROR}.", ""]
    lines += table(["class", "what", "mien, ms", "fastest peer, ms", "ratio", "goal"],
                   [row for name, found in sorted(report.items()) for row in rows(name, found)])
    machines = {}
    for name, found in sorted(report.items()):
        peers = {peer for row in found["networks"] for peer in row["peers"]}
        missing = "" if any(peer.endswith("int8") for peer in peers) else ", without peers in 8 bits"
        machines.setdefault(f"{found['rounds']} interleaved rounds on {found['processor']}{missing}", []).append(name)
    lines += [f"* {', '.join(names)}: {where}." for where, names in machines.items()]
    return "\n".join(lines) + "\n"


def main():
    work, out = Path(sys.argv[1]), Path(sys.argv[3])
    path = out / "cpu_classes.json"
    report = json.loads(path.read_text()) if path.exists() else {}
    report[sys.argv[4]] = measure(Runs(work, int(sys.argv[2]), (work / "timed").read_text().split()))
    path.write_text(json.dumps(report, indent=1) + "\n")
    (out / "cpu_classes.md").write_text(page(json.loads(path.read_text())))


if __name__ == "__main__":
    main()
