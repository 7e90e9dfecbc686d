#!/usr/bin/env python3
"""Puts the rounds of bench_peers.sh together.  usage: report.py WORK_DIR ROUNDS OUT_DIR"""
import json
import statistics
import sys
from pathlib import Path


def load(work, kind, rounds):
    return [json.loads((work / f"{kind}_{i}.json").read_text()) for i in range(rounds)]


def main():
    work, rounds, out = Path(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3])
    ours, theirs = load(work, "mien", rounds), load(work, "peer", rounds)
    rows = []
    for name in theirs[0]:
        tiers = {r["tier"] for r in ours[0]["results"] if r["name"] == name} - {"ref"}
        for tier in sorted(tiers):
            mine = [r for run in ours for r in run["results"]
                    if r["name"] == name and r["tier"] == tier]
            row = {"network": name, "tier": tier}
            for label, values in (("mien", mine), ("onnxruntime", [t[name] for t in theirs])):
                row[f"{label}_min_ms"] = min(v["min_ms"] for v in values)
                row[f"{label}_median_ms"] = statistics.median(v["median_ms"] for v in values)
            row["min_ratio"] = row["mien_min_ms"] / row["onnxruntime_min_ms"]
            row["median_ratio"] = row["mien_median_ms"] / row["onnxruntime_median_ms"]
            rows.append(row)
    out.mkdir(parents=True, exist_ok=True)
    (out / "peers.json").write_text(json.dumps(rows, indent=1) + "\n")
    lines = ["# Speed beside ONNX Runtime", "",
             f"One thread each, {rounds} rounds in turns on one machine; "
             "`scripts/bench_peers.sh` reproduces it. Only the ratio means something elsewhere.", "",
             "| network | tier | mien min / median ms | ONNX Runtime 1.30 min / median ms | ratio of minima | ratio of medians |",
             "|---|---|---|---|---|---|"]
    for r in rows:
        lines.append(f"| {r['network']} | {r['tier']} | {r['mien_min_ms']:.3f} / {r['mien_median_ms']:.3f} "
                     f"| {r['onnxruntime_min_ms']:.3f} / {r['onnxruntime_median_ms']:.3f} "
                     f"| {r['min_ratio']:.2f} | {r['median_ratio']:.2f} |")
    (out / "peers.md").write_text("\n".join(lines) + "\n")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
