#!/usr/bin/env python3
"""Compares mien with its peers from the rounds of bench.sh.

usage: peers.py WORK_DIR ROUNDS OUT_DIR MEASURED...
       peers.py --page OUT_DIR          only writes the page from OUT_DIR/peers.json
"""
import json
import statistics
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ENGINES = {"onnxruntime": "ONNX Runtime", "onnxruntime_int8": "ONNX Runtime, int8", "openvino": "OpenVINO",
           "openvino_bf16": "OpenVINO, bf16", "openvino_int8": "OpenVINO, int8", "ncnn": "ncnn",
           "ncnn_16bit": "ncnn, 16 bits", "litert": "LiteRT (XNNPACK)", "litert_int8": "LiteRT (XNNPACK), int8"}
OTHERS = {"mediapipe": "MediaPipe", "voice_silero": "Silero VAD"}
LESS_EXACT = ("onnxruntime_int8", "openvino_bf16", "openvino_int8", "ncnn_16bit", "litert_int8")
ERROR = "relative error of the output on faces"
VISIBLE = 5e-4  # error of outputs from which tables show it
ENCODER_GOALS = {"basenet_encoder": 0.8, "hifinet_encoder": 0.8}  # of the fastest peer's time, by minima and by medians
FRAME_GOAL = 20  # times faster than MediaPipe
MILLION = 1e6


class Runs:
    def __init__(self, work, rounds, measured):
        self.work, self.rounds, self.measured = work, rounds, measured

    def load(self, kind, rounds=None):
        return [json.loads((self.work / f"{kind}_{i}.json").read_text()) for i in range(rounds or self.rounds)]


def least(rows):
    return {"min_ms": min(r["min_ms"] for r in rows), "median_ms": statistics.median(r["median_ms"] for r in rows),
            "difference": rows[0].get("difference")}


def shown(times, digits=4):
    """The fastest run, and the error of the output where it is visible."""
    error = times.get("difference") or 0
    return f"{times['min_ms']:.{digits}f}" + (f" ({100 * error:.1f} %)" if error >= VISIBLE else "")


def networks(runs):
    """[{network, mien: {tier: times}, peers: {engine: times}}]"""
    ours, errors = runs.load("mien"), runs.load("errors", 1)[0]
    theirs = {engine: runs.load(engine) for engine in ENGINES if engine in runs.measured}
    report = []
    for name in dict.fromkeys(r["name"] for r in ours[0]["results"]):
        peers = {e: least([run["networks"][name] for run in rows]) for e, rows in theirs.items()
                 if name in rows[0]["networks"]}
        if not peers:
            continue
        tiers = {r["tier"] for r in ours[0]["results"] if r["name"] == name} - {"ref"}
        mine = {tier: least([r for run in ours for r in run["results"] if (r["name"], r["tier"]) == (name, tier)])
                for tier in sorted(tiers)}
        for tier, error in errors.get(name, {}).items():
            mine[tier]["difference"] = error
        report.append({"network": name, "mien": mine, "peers": peers})
    return report


def fastest(times):
    return min(times, key=lambda name: times[name]["min_ms"])


def frames(runs):
    """Times of both trackers: the mean over frames in the fastest round."""
    levels = {level["lod"]: min(run["levels"][i]["mean_us"] for run in runs.load("levels"))
              for i, level in enumerate(runs.load("levels")[0]["levels"])}
    theirs = runs.load("mediapipe")
    return {"mien_us": levels, "mediapipe_us": min(r["mean_us"] for r in theirs), "mediapipe_faces": theirs[0]["faces"]}


def sound(runs):
    steps = [next(s for s in run if s["sample_rate"] == 16000) for run in runs.load("sound")]
    theirs, per_second = runs.load("voice_silero"), 16000 / 256
    return {"mien": {"min_us": per_second * min(s["min_us"] for s in steps),
                     "median_us": per_second * statistics.median(s["median_us"] for s in steps),
                     "heard": runs.load("voice_mien", 1)[0]["heard"]},
            "silero": {"min_us": min(r["second_min_us"] for r in theirs),
                       "median_us": statistics.median(r["second_median_us"] for r in theirs),
                       "heard": theirs[0]["heard"]}}


def shipped(runs):
    """[(what, version, bytes)]"""
    weights = lambda *names: sum((ROOT / f"models/{name}.mien").stat().st_size for name in names)
    library = (ROOT / "build/release/tracker/libmien.so").stat().st_size
    rows = [["mien, level 1: library and weights", "", library + weights("basenet", "proposal")],
            ["mien, all levels and audio: library and weights", "",
             library + weights("basenet", "proposal", "hifinet", "audionet")]]
    engines = [n for n in ENGINES if n in runs.measured and n not in LESS_EXACT]
    for name in engines + [n for n in OTHERS if n in runs.measured]:
        run = runs.load(name, 1)[0]
        what = {"mediapipe": "MediaPipe: library and model",
                "voice_silero": "Silero VAD: network alone"}.get(name, f"{ENGINES.get(name)}: library alone")
        rows.append([what, run["version"], run["bytes"]])
    return rows


def table(header, rows):
    return ["| " + " | ".join(header) + " |",
            "|" + "---|" * len(header)] + ["| " + " | ".join(row) + " |" for row in rows] + [""]


def met(right):
    return "met" if right else "**missed**"


def network_lines(report):
    encoders = [r for r in report if r["network"].endswith("_encoder")]
    row = lambda name, times: [name, *(shown(t) if t else "" for t in times)]
    tiers = dict.fromkeys(tier for r in encoders for tier in r["mien"])
    rows = [row(f"mien, {tier}", [r["mien"].get(tier) for r in encoders]) for tier in tiers]
    engines = [e for e in ENGINES if any(e in r["peers"] for r in encoders)]
    rows += [row(ENGINES[e], [r["peers"].get(e) for r in encoders]) for e in engines]
    lines = ["## Networks", "",
             "Fastest run in ms, with checked results; [peers.json](peers.json) has all networks. In parentheses, if "
             f"visible: {ERROR}.", "", *table(["", *(r["network"] for r in encoders)], rows)]
    lines += [f"* Goal for {name}: at most {ENCODER_GOALS[name]} of the fastest peer, by minima and by medians: "
              f"{met(max(ratios) <= ENCODER_GOALS[name])}." for name, (_, _, ratios) in best_ratios(report).items()]
    return lines + [""]


def best_ratios(report):
    """{encoder: (tier, peer, [of minima, of medians])} of the fastest tier and the fastest peer."""
    found = {}
    for r in report:
        if r["network"] in ENCODER_GOALS:
            peer, tier = fastest(r["peers"]), fastest(r["mien"])
            found[r["network"]] = tier, peer, [r["mien"][tier][k] / r["peers"][peer][k]
                                               for k in ("min_ms", "median_ms")]
    return found


def frame_lines(report):
    levels = {int(level): us for level, us in report["mien_us"].items()}
    rows = [[str(level), f"{us:.0f}", f"{report['mediapipe_us'] / us:.1f}"] for level, us in levels.items()
            if level in (1, 4)]
    best = report["mediapipe_us"] / levels[4]
    return ["## Frames", "",
            "The demo clip, 640 x 480: mien with audio, MediaPipe Face Landmarker with blendshapes and head pose. Mean "
            f"over frames of the fastest of several passes; MediaPipe takes {report['mediapipe_us']:.0f} us.", "",
            *table(["level", "us", "times as fast as MediaPipe"], rows),
            f"* Goal for level 4: {FRAME_GOAL} times as fast: {met(best >= FRAME_GOAL)}.", ""]


def decibels(ratio):
    return ratio if ratio == "clean" else f"{ratio} dB"


def sound_lines(report):
    ratios = list(report["mien"]["heard"])
    name = {"mien": "mien: resampler, features, AudioNet, both decoders", "silero": "Silero VAD in ONNX Runtime"}
    rows = [[name[who], f"{r['min_us']:.0f} / {r['median_us']:.0f}", *(f"{r['heard'][k]['area']:.3f}" for k in ratios)]
            for who, r in report.items()]
    seconds = report["mien"]["heard"]["clean"]["seconds"]
    return ["## Audio", "",
            "Time per second of audio, minimum / median in us, and area under ROC of voice activity on "
            f"{seconds:.0f} s of held-out speakers in held-out noises, each at its best delay. The truth is the energy "
            "of clean speech, which only mien's network was trained for; its time includes the controls of the mouth.",
            "", *table(["", "us per second", *map(decibels, ratios)], rows)]


def in_short(report):
    """How fast, on which data."""
    found = best_ratios(report["networks"]).items()
    text = "Relative to the fastest other engine, " + ", ".join(
        f"{name} takes {ratios[0]:.2f} of the time ({ENGINES[peer]})" for name, (_, peer, ratios) in found)
    if "frames" in report:
        frames = report["frames"]
        level_4_us = {int(k): v for k, v in frames["mien_us"].items()}[4]
        text += f"; a frame at level 4 is {frames['mediapipe_us'] / level_4_us:.0f} times as fast as MediaPipe"
    return text


def page(report):
    lines = ["# Speed compared with other engines and trackers", "", "For users who choose an engine or a tracker.", "",
             f"{in_short(report)}. The data are the networks of `models/`, the demo clip and held-out speech. One "
             f"thread each, {report['rounds']} interleaved rounds on one machine "
             f"({report['processor']}; load {report['load']:.0f}), by `scripts/peers/bench.sh`. Only ratios carry over "
             "to similar processors.", ""]
    lines += network_lines(report["networks"])
    lines += frame_lines(report["frames"]) if "frames" in report else []
    lines += sound_lines(report["sound"]) if "sound" in report else []
    lines += ["## Sizes", "", "Files of the packages for x86-64 Linux, not stripped; engines without a network.", ""]
    lines += table(["", "MB"], [[f"{what} {version}".strip(), f"{size / MILLION:.1f}"]
                                           for what, version, size in report["shipped"] if size])
    return "\n".join(lines).rstrip() + "\n"


def measure(runs):
    report = {"rounds": runs.rounds, "processor": processor(), "load": float((runs.work / "load").read_text().split()[
        2]), "networks": networks(runs), "shipped": shipped(runs)}
    if "mediapipe" in runs.measured:
        report["frames"] = frames(runs)
    if "voice_silero" in runs.measured:
        report["sound"] = sound(runs)
    return report


def main():
    if sys.argv[1] == "--page":
        out = Path(sys.argv[2])
        report = json.loads((out / "peers.json").read_text())
    else:
        out = Path(sys.argv[3])
        report = measure(Runs(Path(sys.argv[1]), int(sys.argv[2]), sys.argv[4:]))
        (out / "peers.json").write_text(json.dumps(report, indent=1) + "\n")
    (out / "peers.md").write_text(page(report))
    print(page(report))


def processor():
    """Family, model and relevant instruction sets of the processor."""
    words = Path("/proc/cpuinfo").read_text().split()
    sets = [name for name in ("avx2", "avx512f", "avx512_bf16", "avx512_fp16", "amx_tile") if name in words]
    fields = dict(line.split(":", 1) for line in Path("/proc/cpuinfo").read_text().splitlines() if ":" in line)
    fields = {k.strip(): v.strip() for k, v in fields.items()}
    return f"{fields['vendor_id']} family {fields['cpu family']}, model {fields['model']}, with {', '.join(sets)}"


if __name__ == "__main__":
    main()
