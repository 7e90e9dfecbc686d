"""How much faster following a face is than searching it on every frame, on the demo clip and the clips of real people."""
import json
import subprocess

import report as out
import videos


def measure(setting):
    report = {}
    for clip in [videos.DEMO, *videos.clips()]:
        command = [setting.program.path, "bench", "--clip", clip, "--models", setting.program.models, "--json"]
        report[clip.stem] = {**json.loads(subprocess.check_output(command, text=True)), "clip": clip.name}
    return report


def markdown(report):
    lines = ["# Following a face against searching it", ""]
    lines += out.prose("Measured with `mien bench --clip`: one core, decoding not counted. The published figure is 10x.")
    rows = [[name, str(r["frames"]), str(r["proposal_runs"]), out.number(r["followed"]["mean_ms"]),
             out.number(r["proposed_on_every_frame"]["mean_ms"], 2), out.number(r["speedup"], 1)] for name, r in report.items()]
    header = ["clip", "frames", "proposals", "followed, mean ms", "proposed on every frame, mean ms", "times as fast"]
    return "\n".join(lines + out.table(header, rows))
