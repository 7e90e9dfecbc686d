"""docs/results/README.md: what mien is meant to reach, what it reaches, and what is missed."""
import json
from dataclasses import dataclass
from typing import Callable

import numpy as np

import report as out
from setting import PARTS
from teacher import MOVES

LEVELS = ("LOD1", "LOD4")
FOLLOWED = {"jawOpen": 0.9, "eyeBlinkLeft": 0.8, "eyeBlinkRight": 0.8, "mouthPucker": 0.7, "mouthFunnel": 0.7, "mouthSmileLeft": 0.7,
            "mouthSmileRight": 0.7, "browInnerUp": 0.7}  # least correlation with MediaPipe, where MediaPipe's moves
PLACES = {"clips": "clips of real people", "pictures": "held-out portraits"}


@dataclass
class Bar:
    part: str                # whose results
    title: str
    sign: str                # "<=", ">=", "<" or ">"
    bound: object            # a number, or a function (report, level) -> number
    pick: Callable           # (report, level) -> figure
    scale: float = 1.0       # of what is shown
    digits: int = 3


def met(figure, sign, bound):
    return {"<=": figure <= bound, ">=": figure >= bound, "<": figure < bound, ">": figure > bound}[sign]


def of_level(key, *path):
    """Picks report[key][level][...] (no key: report[level][...])."""
    def pick(report, level):
        value = (report[key] if key else report)[level]
        for step in path:
            value = value[step]
        return value
    return pick


def every_control(key, combine):
    """Combines a figure of all driven controls of the response."""
    return lambda report, level: combine(r[key] for r in report[level]["controls"].values())


def wink(key, combine):
    return lambda report, level: combine(w[key] for w in report[level]["winks"].values())


def synthetic_bars():
    score = lambda key: of_level(None, "program", key)
    ratio = lambda constant: lambda report, level: score("facs_error_supported")(report, level) / score(constant)(report, level)
    return [Bar("synthetic", "FACS error, supported controls", "<=", 0.06, score("facs_error_supported"), digits=4),
            Bar("synthetic", "the same over that of the best constant answer, each control's median", "<=", 0.4, ratio("constant_median_supported"), digits=2),
            Bar("synthetic", "mean correlation, supported controls", ">=", 0.8, score("correlation_mean"), digits=2),
            Bar("synthetic", "lowest correlation of a supported control", ">=", 0.5, score("correlation_lowest"), digits=2),
            Bar("synthetic", "jitter x 1e-4, supported controls", "<=", 7.2, score("jitter_supported"), 1e4, 1),
            Bar("synthetic", "asymmetry x 1e-3", "<=", 3.6, score("asymmetry"), 1e3, 1)]


def probe_bars():
    return [Bar("response", "least range of a driven control that moves alone", ">=", 0.6, every_control("reached", min), digits=2),
            Bar("response", "most that a driven control answers when only another moves", "<", 0.15, every_control("others_at_most", max), digits=2),
            Bar("response", "winks: least of a closed eye", ">", 0.8, wink("closed", min), digits=2),
            Bar("response", "winks: most of the other eye", "<", 0.2, wink("other", max), digits=2),
            Bar("leakage", "largest drift of a control on a neutral face that turns", "<=", 0.1, of_level(None, "largest"), digits=3)]


def level_bars():
    row = lambda name, key: lambda report, level: report["levels"][name][key] if level == "LOD4" else None
    return [Bar("levels", "error of level 2 against level 4", "<=", 0.0123, row("LOD2", "error"), digits=4),
            Bar("levels", "error of level 3 against level 4", "<=", 0.0059, row("LOD3", "error"), digits=4),
            Bar("levels", "time of level 2 over level 4's", "<=", 0.55, row("LOD2", "cost_ratio"), digits=2),
            Bar("levels", "memory besides the weights, MB", "<=", 6, lambda report, _: report["tracker_bytes"], 1e-6, 2)]


def teacher_bars(part, of):
    """Bars against MediaPipe; `of` leads to a level's results."""
    def correlation(control):
        def pick(report, level):
            row = of(report, level)["controls"].get(control)
            return None if row is None or row["spread"] < MOVES else row["correlation"]
        return pick
    return [Bar(part, f"correlation of {c} with MediaPipe, {PLACES[part]}", ">=", least, correlation(c), digits=2) for c, least in FOLLOWED.items()]


def clip_bars():
    key = lambda name: of_level(None, "all", name)
    jitter = Bar("clips", "jitter x 1e-4 on still stretches; the bound is MediaPipe's", "<=", lambda report, level: 1e4 * key("teacher_still_jitter")(report, level),
                 key("still_jitter"), 1e4, 1)
    return [Bar("clips", "% of MediaPipe's frames with a face", ">=", 99, key("face_share"), 100, 1),
            Bar("clips", "landmark error, % of the outer eye corner distance", "<=", 4, key("landmark_error_outer_eyes"), 100, 2),
            Bar("clips", "head pose, degrees", "<=", 3, key("pose_difference_deg"), digits=2), jitter, *teacher_bars("clips", of_level(None))]


def picture_bars():
    key = lambda name: of_level("levels", "portraits", name)
    return [Bar("pictures", "% of portraits with the face found", ">=", 99, key("found"), 100, 1),
            Bar("pictures", "landmark error of portraits, % of the outer eye corner distance", "<=", 4, key("landmark_error_outer_eyes"), 100, 2),
            Bar("pictures", "head pose of portraits, degrees", "<=", 3, key("pose_difference_deg"), digits=2),
            *teacher_bars("pictures", of_level("levels", "portraits"))]


def bars():
    return [*synthetic_bars(), *probe_bars(), *level_bars(), *clip_bars(), *picture_bars()]


def figure(bar, report, level):
    """(figure, bound) as shown, the figure None where it was not measured."""
    try:
        value = bar.pick(report, level)
    except KeyError:
        value = None
    if value is None or not np.isfinite(value):
        return None, None if callable(bar.bound) else bar.bound
    return bar.scale * value, bar.bound(report, level) if callable(bar.bound) else bar.bound


def cell(bar, value, bound):
    if value is None:
        return "-"
    return f"{value:.{bar.digits}f} {'met' if met(value, bar.sign, bound) else '**missed**'}"


def line(bar, reports):
    """Cells of one bar and its verdicts [level]."""
    found = [figure(bar, reports.get(bar.part, {}), level) for level in LEVELS]
    bound = next((b for _, b in found if b is not None), None)
    verdicts = [None if v is None else bool(met(v, bar.sign, b)) for v, b in found]
    return [bar.title, f"{bar.sign} {bound if bound is None else f'{bound:.4g}'}", *(cell(bar, v, b) for v, b in found), f"[{bar.part}]({bar.part}.md)"], verdicts


def page(reports, seconds, skipped, has_hifinet):
    rows, verdicts = zip(*(line(bar, reports) for bar in bars()))
    lines = ["# Results", "", "Made by `scripts/evaluate/evaluate.py`. LOD1 answers with BaseNet, LOD4 with HiFiNet; both are the program with its defaults,"
             " smoothing included. A dash: not measured, or MediaPipe's control hardly moves there.", ""]
    if not has_hifinet:
        lines += ["**HiFiNet is not trained yet**: no figure of LOD4.", ""]
    for k, level in enumerate(LEVELS):
        known = [v[k] for v in verdicts if v[k] is not None]
        lines += [f"* {level}: {sum(known)} of {len(known)} bars met."] if known else []
    lines += [""] + out.table(["", "bar", *LEVELS, "more"], rows)
    truth = next((r["program"]["truth_jitter"] for r in reports.get("synthetic", {}).values()), None)
    if truth:
        lines += [f"The true curves of the synthetic test sequences have a jitter of {1e4 * truth:.1f}e-4 themselves: they tremble a little.", ""]
    lines += ["## Parts", ""] + out.table(["part", "minutes"], [[f"[{p}]({p}.md)", f"{s / 60:.1f}"] for p, s in seconds.items()])
    lines += ["[Speed beside ONNX Runtime](peers.md) is measured by `scripts/bench_peers.sh`.", ""]
    if skipped:
        lines += ["## Skipped in the last run", "", *(f"* {s}" for s in skipped), ""]
    return "\n".join(lines)


def write(folder, skipped, has_hifinet):
    """Writes the page from the results of all parts that are there."""
    stored = {part: json.loads((folder / f"{part}.json").read_text()) for part in PARTS if (folder / f"{part}.json").exists()}
    seconds = {part: r["seconds"] for part, r in stored.items()}
    (folder / "README.md").write_text(page({part: r["results"] for part, r in stored.items()}, seconds, skipped, has_hifinet))
