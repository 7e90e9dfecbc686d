"""Speed of tracking a face relative to detection on every frame, on the demo clip and clips of real people."""
import json
import subprocess

from mien_training.evaluate import videos


def measure(setting):
    report = {}
    for clip in [videos.DEMO, *videos.clips()]:
        command = [setting.program.path, "bench", "--clip", clip, "--models", setting.program.models, "--json"]
        report[clip.stem] = {**json.loads(subprocess.check_output(command, text=True)), "clip": clip.name}
    return report
