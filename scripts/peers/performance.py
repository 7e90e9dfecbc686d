#!/usr/bin/env python3
"""Reports the speed of mien from the rounds of bench.sh: tiers, fused blocks, share of the peak.

usage: performance.py WORK_DIR ROUNDS OUT_DIR [MEASURED...]
       performance.py --page OUT_DIR          only writes the page from OUT_DIR/performance.json
"""
import json
import sys
from pathlib import Path


def load(work, kind, rounds):
    return [json.loads((work / f"{kind}_{i}.json").read_text()) for i in range(rounds)]


def least(runs, name, tier):
    """Minimum in ms over all rounds."""
    return min(r["min_ms"] for run in runs for r in run["results"] if (r["name"], r["tier"]) == (name, tier))


def peaks(runs):
    """GFLOP/s by tier: the best of any round."""
    return {tier: max(run["peak_gflops"][tier] for run in runs) for tier in runs[0]["peak_gflops"]}


def measure(work, rounds):
    fused, unfused = load(work, "mien", rounds), load(work, "unfused", rounds)
    sound = load(work, "sound", rounds)
    peer = [run["networks"] for run in load(work, "onnxruntime", rounds)]
    peak, rows = peaks(fused), []
    for result in fused[0]["results"]:
        name, tier = result["name"], result["tier"]
        if tier == "ref":
            continue
        row = {"network": name, "tier": tier, "macs": result["macs"], "min_us": least(fused, name, tier) * 1e3}
        row["peak_share"] = 2e-3 * row["macs"] / row["min_us"] / peak[tier]
        row["to_unfused"] = least(fused, name, tier) / least(unfused, name, tier)
        if name in peer[0]:
            row["to_onnxruntime"] = least(fused, name, tier) / min(run[name]["min_ms"] for run in peer)
        rows.append(row)
    heard = [{"sample_rate": s["sample_rate"], "min_us": min(run[i]["min_us"] for run in sound),
              "median_us": min(run[i]["median_us"] for run in sound)} for i, s in enumerate(sound[0])]
    return {"rounds": rounds, "peak_gflops": peak, "networks": rows, "sound_step": heard,
            "frames": frames(load(work, "levels", rounds))}


def frames(runs):
    """The fastest round of each level."""
    networks = min(run["networks_of_highest_us"] for run in runs)
    in_turn = min(run["networks_in_turn_us"] for run in runs)
    levels = [min((run["levels"][i] for run in runs), key=lambda level: level["mean_us"])
              for i in range(len(runs[0]["levels"]))]
    return {"start_ms": min(run["start_ms"] for run in runs), "networks_of_highest_us": networks,
            "highest_of_networks": levels[-1]["mean_us"] / networks,
            "networks_in_turn_us": in_turn, "highest_of_networks_in_turn": levels[-1]["mean_us"] / in_turn,
            "levels": [{**level, "of_highest": level["mean_us"] / levels[-1]["mean_us"]} for level in levels]}


def table(header, rows):
    return ["| " + " | ".join(header) + " |",
            "|" + "---|" * len(header)] + ["| " + " | ".join(row) + " |" for row in rows]


def to_text(figures):
    levels = ", ".join(f"level {f['lod']} {f['mean_us']:.0f} us" for f in figures["frames"]["levels"])
    lines = ["# Speed", "", "For developers of kernels, and for users who plan a budget.", "",
             f"A tracked frame of 640 x 480 pixels takes: {levels}. One thread, minima of {figures['rounds']} rounds "
             "interleaved with [other engines](peers.md) on one machine, by "
             "`scripts/peers/bench.sh`. `avx512fp16` computes the encoders' "
             "blocks [with 16 bits](../architecture.md#half-precision). The peak is that of a loop of fused "
             "multiply-adds in registers.", "",
             "## Networks", "", "[performance.json](performance.json) has all networks; "
             "`scripts/measure/bench_history.sh` prints their history.", ""]
    shown = [r for r in figures["networks"] if r["macs"] > 1e6 and "encoder" in r["network"]]
    lines += table(("network", "tier", "us", "of the peak", "of ONNX Runtime"),
                   [(r["network"], r["tier"], f"{r['min_us']:.1f}", f"{100 * r['peak_share']:.0f} %",
                     f"{r['to_onnxruntime']:.2f}" if "to_onnxruntime" in r else "") for r in shown])
    heard = ", ".join(f"{s['min_us']:.1f} us at {s['sample_rate']} Hz" for s in figures["sound_step"])
    lines += ["", f"16 ms of audio, from samples to controls (`mien bench --sound`), take {heard}."]
    lines += ["", "## A frame", "",
              "Mean over tracked frames of the demo clip, 640 x 480 NV12, with audio (`mien bench --levels`); us.", ""]
    stages = ("warp", "encoder", "heads", "decoders")
    lines += table(("level", "frame", "of level 4", *stages),
                   [(str(f["lod"]), f"{f['mean_us']:.0f}", f"{f['of_highest']:.2f}",
                     *(f"{f['stages_us'][s]:.1f}" for s in stages))
                    for f in figures["frames"]["levels"]])
    f = figures["frames"]
    lines += ["",
              f"The networks of level 4 take {f['networks_of_highest_us']:.0f} us if each is repeated, with its "
              f"weights in the cache, and {f['networks_in_turn_us']:.0f} us in sequence, as in a frame. "
              f"Creating a tracker from the weight files takes {f['start_ms']:.1f} ms."]
    return "\n".join(lines) + "\n"


def main():
    if sys.argv[1] == "--page":
        out = Path(sys.argv[2])
        figures = json.loads((out / "performance.json").read_text())
    else:
        out = Path(sys.argv[3])
        figures = measure(Path(sys.argv[1]), int(sys.argv[2]))
        (out / "performance.json").write_text(json.dumps(figures, indent=1) + "\n")
    (out / "performance.md").write_text(to_text(figures))


if __name__ == "__main__":
    main()
