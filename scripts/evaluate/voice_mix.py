"""Sound, picture and both beside the truth: the demo clip, whose face is drawn and whose voice is one that was held out."""
import csv

import numpy as np

import report as out
from program import FPS
from videos import DEMO
from voice_model import SPEECH_CONTROLS

MODES = {"picture": "video", "sound": "audio", "both": "av"}


def truth():
    with open(DEMO.with_name("demo_truth.csv"), newline="") as file:
        rows = list(csv.DictReader(file))
    return {c: np.array([float(row[c]) for row in rows]) for c in SPEECH_CONTROLS}


def errors(program, lod):
    """{mode: {control: mean absolute error}}; what is not driven rests at 0, as it would on a rig."""
    exact, report = truth(), {}
    for name, mode in MODES.items():
        table = program.track(DEMO, lod, mode=mode).table
        frames = np.rint(table["t_ms"] * FPS / 1000).astype(int)
        known = frames < len(exact["jawOpen"])
        report[name] = {c: float(np.abs(np.nan_to_num(table[c][known]) - exact[c][frames[known]]).mean()) for c in SPEECH_CONTROLS}
    return report


def measure(setting):
    return {name: errors(setting.program, lod) for name, lod in setting.levels("sound_and_picture").items()}


def markdown(report):
    header = ["mean absolute error", *(f"{level}, {mode}" for level in report for mode in MODES)]
    cells = lambda pick: [out.number(pick(by[mode])) for by in report.values() for mode in MODES]
    rows = [["all 18 speech controls", *cells(lambda e: np.mean(list(e.values())))], *([c, *cells(lambda e, c=c: e[c])] for c in SPEECH_CONTROLS)]
    return out.table(header, rows)
