#!/usr/bin/env python3
"""How much faster following a face is than searching it on every frame, on the demo clip and the clips of real people."""
import argparse
import json
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "train"))
from paths import ROOT, data  # noqa: E402

VIDEOS = (".mp4", ".mkv", ".mpg")


def clips():
    found = sorted(p for p in (data() / "clips").glob("*") if p.suffix in VIDEOS)
    return [ROOT / "tests/data/demo.mp4", *found]


def markdown(report):
    lines = ["# Following a face against searching it", "",
             "Made by `scripts/evaluate/evaluate_following.py` with `mien bench --clip`: one core, decoding not counted. The published",
             "figure is 10x.", "",
             "| clip | frames | proposals | followed, mean ms | proposed on every frame, mean ms | times as fast |",
             "|---|---|---|---|---|---|"]
    for name, r in report.items():
        lines.append(f"| {name} | {r['frames']} | {r['proposal_runs']} | {r['followed']['mean_ms']:.3f} "
                     f"| {r['proposed_on_every_frame']['mean_ms']:.2f} | {r['speedup']:.1f} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--mien", required=True, help="the built program")
    parser.add_argument("--out", type=Path, default=ROOT / "docs/results")
    args = parser.parse_args()
    report = {}
    for clip in clips():
        answer = subprocess.run([args.mien, "bench", "--clip", clip, "--json"], check=True, capture_output=True, text=True)
        report[clip.stem] = json.loads(answer.stdout)
    (args.out / "following.json").write_text(json.dumps(report, indent=1) + "\n")
    (args.out / "following.md").write_text(markdown(report))
    print(markdown(report))


if __name__ == "__main__":
    main()
