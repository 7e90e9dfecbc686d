"""Controls from audio, video and both on the demo clip, whose voice is held out, compared with the truth."""
import csv

import numpy as np

from mien_training.evaluate import report as out
from mien_training.evaluate.audio_model import SPEECH_CONTROLS
from mien_training.evaluate.program import FPS
from mien_training.evaluate.videos import DEMO

MODES = {"picture": "video", "sound": "audio", "both": "av"}


def truth():
    with open(DEMO.with_name("demo_truth.csv"), newline="") as file:
        rows = list(csv.DictReader(file))
    return {c: np.array([float(row[c]) for row in rows]) for c in SPEECH_CONTROLS}


def errors(program, lod):
    """{mode: {control: mean absolute error}}; controls that are not driven are 0, as on a rig."""
    exact, report = truth(), {}
    for name, mode in MODES.items():
        table = program.track(DEMO, lod, mode=mode).table
        frames = np.rint(table["t_ms"] * FPS / 1000).astype(int)
        known = frames < len(exact["jawOpen"])
        report[name] = {c: float(np.abs(np.nan_to_num(table[c][known]) - exact[c][frames[known]]).mean())
                        for c in SPEECH_CONTROLS}
    return report


def measure(setting):
    return {name: errors(setting.program, lod) for name, lod in setting.levels("audio_and_video").items()}


SOURCES = {"picture": "video", "sound": "audio", "both": "both"}


def markdown(report):
    mean = lambda by, mode: out.number(np.mean(list(by[mode].values())))
    told = out.by_level(report, lambda by: ", ".join(f"{title} {mean(by, mode)}" for mode, title in SOURCES.items()))
    lines = ["# Audio and video", "", "For users who combine camera and microphone.", ""] + out.prose(f"""Mean absolute
        error of all {len(SPEECH_CONTROLS)} controls of speech: {told}. The data are the demo clip, whose true controls
        are known and whose voice, a variant of eSpeak NG, was held out.""")
    return "\n".join(lines)
