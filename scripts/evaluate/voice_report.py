#!/usr/bin/env python3
"""AudioNet's figures on what was held out, beside what they should be: voice.md and voice.json.

usage: voice_report.py ENCODER.pt DECODERS.pt [--out FOLDER] [--parts phonemes activity controls]
"""
import argparse
from pathlib import Path

import voice_activity
import voice_controls
import voice_phonemes
from report import dump, number, table
from voice_model import Model


def phonemes(model):
    rates = voice_phonemes.measure(model)
    rows = [[name, number(100 * rate, 1), number(100 * voice_phonemes.BARS.get(name, float("nan")), 0)] for name, rate in rates.items()]
    return rates, ["## Phoneme error rate", "", *table(["held out", "%", "at most"], rows)]


def activity(model):
    ratios, noise = voice_activity.by_ratio(model), voice_activity.on_noise(model)
    rows = [[str(r), *(number(100 * row[k], 1) for k in ("accuracy", "found", "false")), number(row["area"]),
             number(100 * voice_activity.BARS.get(r, float("nan")), 0)] for r, row in ratios.items()]
    lines = ["## Voice activity, held-out speakers in held-out noises", "",
             *table(["dB", "frames right %", "speech found %", "rest taken for speech %", "area under ROC", "at least %"], rows),
             "## Noise alone", "", *table(["noise", "mouth at rest, % of the time"], [[k, number(100 * v, 1)] for k, v in noise.items()])]
    return {"by ratio": ratios, "noise": noise}, lines


def controls(model):
    others = voice_controls.other_clips(model) if model.split == "test" else {}
    report = {"held-out clips": voice_controls.agreement(voice_controls.held_clips(model)),
              "other people": voice_controls.agreement(list(others.values())) if others else {},
              "clips": {name: voice_controls.agreement([pair]) for name, pair in others.items()},
              "lips": voice_controls.lips(model), "spread": voice_controls.spread(model)}
    lines = ["## Controls beside the video teacher's", ""]
    rows = [[who, c, number(v["all frames"]), number(v["mean of clips"]), str(v["lag"])]
            for who in ("held-out clips", "other people") for c, v in report[who].items()]
    lines += table(["who", "control", "correlation", "mean of clips", "lag, frames"], rows)
    lines += table(["clip", "jawOpen", "lag"], [[n, number(v["jawOpen"]["all frames"]), str(v["jawOpen"]["lag"])]
                                                for n, v in report["clips"].items()])
    lines += table(["lips", "%"], [[k, number(100 * v, 1)] for k, v in report["lips"].items() if k != "count"])
    return report, lines


PARTS = {"phonemes": phonemes, "activity": activity, "controls": controls}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("checkpoints", type=Path, nargs=2)
    parser.add_argument("--out", type=Path, default=Path("."))
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=list(PARTS))
    parser.add_argument("--split", choices=("val", "test"), default="test", help="what to measure on: val while anything is being chosen")
    args = parser.parse_args()
    model, figures, lines = Model(*args.checkpoints, args.split), {}, ["# Voice", ""]
    for part in args.parts:
        figures[part], text = PARTS[part](model)
        lines += text
        print("\n".join(text), flush=True)
    args.out.mkdir(parents=True, exist_ok=True)
    lines.append("Made by `scripts/evaluate/voice_report.py ENCODER.pt DECODERS.pt`.")
    (args.out / "voice.md").write_text("\n".join(lines) + "\n")
    (args.out / "voice.json").write_text(dump(figures))


if __name__ == "__main__":
    main()
