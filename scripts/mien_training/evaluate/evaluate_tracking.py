"""Speed of tracking a face relative to detection on every frame, on the demo clip and clips of real people."""
import json
import subprocess

from mien_training.evaluate import report as out
from mien_training.evaluate import videos


def measure(setting):
    report = {}
    for clip in [videos.DEMO, *videos.clips()]:
        command = [setting.program.path, "bench", "--clip", clip, "--models", setting.program.models, "--json"]
        report[clip.stem] = {**json.loads(subprocess.check_output(command, text=True)), "clip": clip.name}
    return report


def markdown(report):
    speedups = [r["speedup"] for r in report.values()]
    lines = ["# Tracking compared with detection", "", "For users who ask why the first frame is slower.", ""]
    lines += out.prose(
        f"""Tracking a face takes {min(speedups):.0f} to {max(speedups):.0f} times less time than detecting it on every
        frame; the published figure is 10. The data are the demo clip and the [clips](clips.md); `mien bench --clip`
        uses one core and excludes decoding.""")
    return "\n".join(lines)
