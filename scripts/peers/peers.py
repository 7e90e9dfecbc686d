#!/usr/bin/env python3
"""Puts the rounds of bench.sh together: mien beside its peers.  usage: peers.py WORK_DIR ROUNDS OUT_DIR MEASURED..."""
import json
import os
import statistics
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ENGINES = {"onnxruntime": "ONNX Runtime", "openvino": "OpenVINO", "openvino_bf16": "OpenVINO, bf16", "ncnn": "ncnn",
           "ncnn_16bit": "ncnn, 16 bits", "litert": "LiteRT (XNNPACK)", "pytorch": "PyTorch"}
OTHERS = {"mediapipe": "MediaPipe", "voice_silero": "Silero VAD"}
LESS_EXACT = ("openvino_bf16", "ncnn_16bit")
BARS = {"basenet_encoder": 0.8, "hifinet_encoder": 0.8}  # of the fastest peer's time, by minima and by medians
BAR_FRAMES = 20  # times faster than MediaPipe
MILLION = 1e6


class Runs:
    def __init__(self, work, rounds, measured):
        self.work, self.rounds, self.measured = work, rounds, measured

    def load(self, kind, rounds=None):
        return [json.loads((self.work / f"{kind}_{i}.json").read_text()) for i in range(rounds or self.rounds)]


def least(rows):
    return {"min_ms": min(r["min_ms"] for r in rows), "median_ms": statistics.median(r["median_ms"] for r in rows)}


def networks(runs):
    """[{network, mien: {tier: times}, peers: {engine: times}}]"""
    ours = runs.load("mien")
    theirs = {engine: runs.load(engine) for engine in ENGINES if engine in runs.measured}
    report = []
    for name in dict.fromkeys(r["name"] for r in ours[0]["results"]):
        peers = {e: least([run["networks"][name] for run in rows]) for e, rows in theirs.items() if name in rows[0]["networks"]}
        if not peers:
            continue
        tiers = {r["tier"] for r in ours[0]["results"] if r["name"] == name} - {"ref"}
        mine = {tier: least([r for run in ours for r in run["results"] if (r["name"], r["tier"]) == (name, tier)]) for tier in sorted(tiers)}
        report.append({"network": name, "mien": mine, "peers": peers})
    return report


def fastest(times):
    return min(times, key=lambda name: times[name]["min_ms"])


def frames(runs):
    """Of both the fastest of each frame, and the mean of these; the least of the rounds."""
    levels = {level["lod"]: min(run["levels"][i]["mean_us"] for run in runs.load("levels")) for i, level in enumerate(runs.load("levels")[0]["levels"])}
    theirs = runs.load("mediapipe")
    return {"mien_us": levels, "mediapipe_us": min(r["mean_us"] for r in theirs), "mediapipe_faces": theirs[0]["faces"]}


def sound(runs):
    steps = [next(s for s in run if s["sample_rate"] == 16000) for run in runs.load("sound")]
    theirs, per_second = runs.load("voice_silero"), 16000 / 256
    return {"mien": {"min_us": per_second * min(s["min_us"] for s in steps), "median_us": per_second * statistics.median(s["median_us"] for s in steps),
                     "heard": runs.load("voice_mien", 1)[0]["heard"]},
            "silero": {"min_us": min(r["second_min_us"] for r in theirs), "median_us": statistics.median(r["second_median_us"] for r in theirs),
                       "heard": theirs[0]["heard"]}}


def shipped(runs):
    """[(what, version, bytes)]"""
    weights = lambda *names: sum((ROOT / f"models/{name}.mien").stat().st_size for name in names)
    library = (ROOT / "build/release/tracker/libmien.so").stat().st_size
    rows = [["mien, level 1: library and weights", "", library + weights("basenet", "proposal")],
            ["mien, all levels and sound: library and weights", "", library + weights("basenet", "proposal", "hifinet", "audionet")]]
    engines = [n for n in ENGINES if n in runs.measured and n not in LESS_EXACT]
    for name in engines + [n for n in OTHERS if n in runs.measured]:
        run = runs.load(name, 1)[0]
        what = {"mediapipe": "MediaPipe: library and model", "voice_silero": "Silero VAD: network alone"}.get(name, f"{ENGINES.get(name)}: library alone")
        rows.append([what, run["version"], run["bytes"]])
    return rows


def table(header, rows):
    return ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)] + ["| " + " | ".join(row) + " |" for row in rows] + [""]


def met(right):
    return "met" if right else "**missed**"


def network_lines(report):
    lines = ["## Networks", "", "Minimum / median in ms of one run of a network, its input at hand; every peer's answer is checked. LiteRT has the encoders alone: "
             "what of its format `onnx_to_tflite.py` writes has no LSTM.", ""]
    engines = [e for e in ENGINES if any(e in row["peers"] for row in report)]
    show = lambda t: f"{t['min_ms']:.4f} / {t['median_ms']:.4f}" if t else ""
    lines += table(["network", *(ENGINES[e] for e in engines)], [[r["network"], *(show(r["peers"].get(e)) for e in engines)] for r in report])
    rows = []
    for r in report:
        full = fastest({e: t for e, t in r["peers"].items() if e not in LESS_EXACT})
        of_all = fastest(r["peers"])
        for tier, t in r["mien"].items():
            ratios = [t["min_ms"] / r["peers"][e]["min_ms"] for e in (full, of_all)]
            rows.append([r["network"], tier, show(t), f"{ratios[0]:.2f} of {ENGINES[full]}", f"{ratios[1]:.2f} of {ENGINES[of_all]}"])
    lines += ["Ratios of minima: below 1 mien is faster. bf16 and 16 bits are what an engine computes in when it is allowed to. Peers take what they choose of the "
              "processor's vectors, so a row of a lesser tier says what mien's program would lose without the better one, not how they compare where nobody has it.", ""]
    lines += table(["network", "mien's tier", "mien", "of the fastest in fp32", "of the fastest"], rows)
    for r in report:
        if r["network"] in BARS:
            peer, tier = fastest(r["peers"]), fastest(r["mien"])
            ratios = [r["mien"][tier][k] / r["peers"][peer][k] for k in ("min_ms", "median_ms")]
            lines.append(f"* {r['network']}, `{tier}`: {ratios[0]:.2f} of the fastest peer's time ({ENGINES[peer]}) by minima, {ratios[1]:.2f} by medians; "
                         f"at most {BARS[r['network']]} wanted: {met(max(ratios) <= BARS[r['network']])}.")
    return lines + [""]


def frame_lines(report):
    rows = [[str(lod), f"{us:.0f}", f"{report['mediapipe_us'] / us:.1f}"] for lod, us in report["mien_us"].items()]
    best = report["mediapipe_us"] / report["mien_us"][4]
    return ["## Whole frames", "", "The demo clip, 640 x 480, a face that is followed: mien from NV12, with sound to mix, MediaPipe's face landmarker from RGB "
            f"with blendshapes and head pose, {100 * report['mediapipe_faces']:.0f} % of its frames with a face. Of each frame the fastest of 30 passes of mien's and 5 of MediaPipe's, the mean of "
            f"these, the least of the rounds. MediaPipe: {report['mediapipe_us']:.0f} us.", "",
            *table(["mien's level", "us", "times faster than MediaPipe"], rows),
            f"* Level 4: {best:.1f} times faster, at least {BAR_FRAMES} wanted: {met(best >= BAR_FRAMES)}.", ""]


def decibels(ratio):
    return ratio if ratio == "clean" else f"{ratio} dB"


def sound_lines(report):
    ratios = list(report["mien"]["heard"])
    name = {"mien": "mien: resampler, features, AudioNet, both decoders", "silero": "Silero VAD in ONNX Runtime"}
    rows = [[name[who], f"{r['min_us']:.0f} / {r['median_us']:.0f}", *(f"{r['heard'][k]['area']:.3f}" for k in ratios)] for who, r in report.items()]
    shifts = {who: " / ".join(f"{r['heard'][k]['shift_ms']:.0f}" for k in ratios) for who, r in report.items()}
    seconds = report["mien"]["heard"]["clean"]["seconds"]
    better = [k for k in ratios if report["silero"]["heard"][k]["area"] > report["mien"]["heard"][k]["area"]]
    return ["## Sound", "", f"Time for a second of sound at 16 kHz, minimum / median in us; area under ROC on the same {seconds:.0f} s of held-out speakers, with "
            "silence around what they say, clean and in held-out noises. The truth is the energy of the clean speech, which mien's network was "
            f"trained to find and Silero's was not; what mien takes includes the controls of the mouth. Each is compared at its best delay, in ms: mien {shifts['mien']}, Silero {shifts['silero']}.", "",
            *table(["", "us for a second", *map(decibels, ratios)], rows),
            f"* Silero finds speech better: {', '.join(map(decibels, better)) or 'nowhere'}.", ""]


def main():
    work, rounds, out = Path(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3])
    runs = Runs(work, rounds, sys.argv[4:])
    report = {"rounds": rounds, "processor": processor(), "load": float((work / "load").read_text().split()[2]), "networks": networks(runs), "shipped": shipped(runs)}
    lines = ["# Speed beside other engines and trackers", "",
             f"One thread each, on one processor that is asked for first, {rounds} rounds in turns on one machine; `scripts/peers/bench.sh` reproduces it. "
             f"Only ratios mean something elsewhere, and they depend on what the processor has: here {report['processor']}. "
             f"Load of the machine meanwhile, a mean of 15 minutes: {report['load']:.0f} on {os.cpu_count()} processors. "
             "[Speed](performance.md) has the tier in half precision beside ONNX Runtime, on a processor that has it.", ""]
    lines += network_lines(report["networks"])
    if "mediapipe" in runs.measured:
        report["frames"] = frames(runs)
        lines += frame_lines(report["frames"])
    if "voice_silero" in runs.measured:
        report["sound"] = sound(runs)
        lines += sound_lines(report["sound"])
    lines += ["## What a program ships", "", "Files as the packages for x86-64 Linux have them, not stripped; engines without the network.", ""]
    lines += table(["", "version", "MB"], [[what, version, f"{size / MILLION:.1f}" if size else "-"] for what, version, size in report["shipped"]])
    (out / "peers.json").write_text(json.dumps(report, indent=1) + "\n")
    (out / "peers.md").write_text("\n".join(lines).rstrip() + "\n")
    print("\n".join(lines))


def processor():
    """Its family and what of its instruction sets matters."""
    words = Path("/proc/cpuinfo").read_text().split()
    sets = [name for name in ("avx2", "avx512f", "avx512_bf16", "avx512_fp16", "amx_tile") if name in words]
    fields = dict(line.split(":", 1) for line in Path("/proc/cpuinfo").read_text().splitlines() if ":" in line)
    fields = {k.strip(): v.strip() for k, v in fields.items()}
    return f"{fields['vendor_id']} family {fields['cpu family']}, model {fields['model']}, with {', '.join(sets)}"


if __name__ == "__main__":
    main()
