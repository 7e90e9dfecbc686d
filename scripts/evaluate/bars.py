"""What mien is meant to reach, and where in the results of the parts each figure is."""
from dataclasses import dataclass
from statistics import fmean
from typing import Callable

from teacher import MOVES

FOLLOWED = {"jawOpen": 0.9, "eyeBlinkLeft": 0.8, "eyeBlinkRight": 0.8, "mouthPucker": 0.7, "mouthFunnel": 0.7, "mouthSmileLeft": 0.7,
            "mouthSmileRight": 0.7, "browInnerUp": 0.7}  # least correlation with MediaPipe, where MediaPipe's moves
NOT_DRIVEN = float("-inf")  # the figure of a control that should be driven and is not


@dataclass
class Bar:
    part: str        # whose results
    title: str
    sign: str        # "<=", ">=", "<" or ">"
    bound: float     # in the unit shown
    pick: Callable   # (results, level) -> figure; None where it does not apply
    scale: float = 1.0
    digits: int = 2

    def figure(self, results, level):
        """In the unit shown; None where it was not measured or does not apply."""
        try:
            value = self.pick(results, level)
        except KeyError:
            return None
        return None if value is None or value != value else self.scale * value

    def met(self, figure):
        compare = {"<=": figure <= self.bound, ">=": figure >= self.bound, "<": figure < self.bound, ">": figure > self.bound}
        return bool(compare[self.sign])


def at(*path):
    """Picks results[...][level][...], the level standing in the path as a bare `at`."""
    def pick(results, level):
        for step in path:
            results = results[level if step is at else step]
        return results
    return pick


def over(key, combine, *path):
    """Combines a figure of every row of a table of a level."""
    return lambda results, level: combine(row[key] for row in at(at, *path)(results, level).values())


def share(test):
    """Combines figures into the share that passes a test."""
    return lambda figures: fmean(test(f) for f in figures)


def ratio(above, below):
    return lambda results, level: above(results, level) / below(results, level)


def synthetic():
    score = lambda key: at(at, "program", key)
    error = score("facs_error_supported")
    bar = lambda title, *rest: Bar("synthetic", f"synthetic test identities: {title}", *rest)
    return [bar("FACS error, supported controls", "<=", 0.06, error, 1, 4),
            bar("the same over that of the best constant answer (medians)", "<=", 0.4, ratio(error, score("constant_median_supported"))),
            bar("mean correlation, supported controls", ">=", 0.8, score("correlation_mean")),
            bar("lowest correlation of a supported control", ">=", 0.5, score("correlation_lowest")),
            bar("jitter x 1e-4, supported controls", "<=", 7.2, score("jitter_supported"), 1e4, 1),
            bar("asymmetry x 1e-3", "<=", 3.6, score("asymmetry"), 1e3, 1)]


def probes():
    bar = lambda title, *rest: Bar("response", title, *rest)
    return [bar("% of driven controls that reach 0.6 alone", ">=", 100, over("reached", share(lambda v: v >= 0.6), "controls"), 100, 0),
            bar("% of driven controls below 0.15 while only others move", ">=", 100,
                over("others_at_most", share(lambda v: v < 0.15), "controls"), 100, 0),
            bar("winks: least of a closed eye", ">", 0.8, over("closed", min, "winks")),
            bar("winks: most of the other eye", "<", 0.2, over("other", max, "winks")),
            Bar("leakage", "largest drift of a control on a neutral face that turns", "<=", 0.1, at(at, "largest"))]


def levels():
    of_hifinet = lambda pick: lambda results, level: pick(results, level) if level == "LOD4" else None
    row = lambda name, key: of_hifinet(at("levels", name, key))
    bar = lambda title, *rest: Bar("levels", title, *rest)
    return [bar("error of level 2 against level 4", "<=", 0.0123, row("LOD2", "error"), 1, 4),
            bar("error of level 3 against level 4", "<=", 0.0059, row("LOD3", "error"), 1, 4),
            bar("time of level 2 over level 4's", "<=", 0.55, row("LOD2", "cost_ratio")),
            bar("memory besides the weights, MB", "<=", 6, at("levels", at, "tracker_bytes"), 1e-6)]


def agreement(control, *path):
    """Picks the correlation of a control with MediaPipe's, where that one moves."""
    def pick(results, level):
        row = at(*path, "controls", control)(results, level)
        if row["spread"] < MOVES:
            return None
        return NOT_DRIVEN if row["correlation"] is None else row["correlation"]
    return pick


def beside_mediapipe(part, where, path, numbers):
    """Bars of landmarks, pose and controls; `numbers` leads to the first two, `path` to the controls."""
    bar = lambda title, *rest: Bar(part, f"{where}: {title}", *rest)
    key = lambda name: at(*numbers, name)
    return [bar("landmark error, % of the outer eye corner distance", "<=", 4, key("landmark_error_outer_eyes"), 100),
            bar("head pose, degrees", "<=", 3, key("pose_difference_deg")),
            *(bar(f"correlation, {c}", ">=", least, agreement(c, *path)) for c, least in FOLLOWED.items())]


def clips():
    total = lambda key: at(at, "all", key)
    bar = lambda title, *rest: Bar("clips", f"clips: {title}", *rest)
    return [bar("% of MediaPipe's frames with a face", ">=", 99, total("face_share"), 100, 1),
            bar("jitter on still stretches over MediaPipe's", "<=", 1, ratio(total("still_jitter"), total("teacher_still_jitter"))),
            *beside_mediapipe("clips", "clips", (at,), (at, "all"))]


def pictures():
    path = ("levels", at, "portraits")
    return [Bar("pictures", "portraits: % with the face found", ">=", 99, at(*path, "found"), 100, 1),
            *beside_mediapipe("pictures", "portraits", path, path)]


def voice():
    """Of sound; they have no level."""
    figure = lambda *path: lambda results, _: at(*path)(results, None)
    bar = lambda title, *rest: Bar("voice", title, *rest)
    ratio = lambda decibels: figure("activity", str(decibels), "accuracy")
    best_lag = lambda results, _: abs(results["controls"]["held-out clips"]["jawOpen"]["lag"])
    return [bar("phoneme errors, held-out reader, %", "<=", 40, figure("phonemes", "real speech"), 100, 1),
            bar("phoneme errors, held-out synthetic voices, %", "<=", 15, figure("phonemes", "synthetic voices"), 100, 1),
            bar("the same, searched with n-grams, %", "<=", 15,
                figure("phonemes", "synthetic voices, searched with n-grams of phonemes"), 100, 1),
            bar("voice activity at 20 dB, % of frames", ">=", 96, ratio(20), 100, 1),
            bar("voice activity at 5 dB, % of frames", ">=", 90, ratio(5), 100, 1),
            bar("noise alone: mouth at rest, % of the time", ">=", 95, figure("noise", "all"), 100, 1),
            bar("jawOpen beside the teacher, held-out clips", ">=", 0.7, figure("controls", "held-out clips", "jawOpen", "all frames")),
            bar("its lag, video frames", "<=", 1, best_lag, 1, 0),
            bar("jawOpen beside the teacher, other people", ">=", 0.5, figure("controls", "other people", "jawOpen", "all frames")),
            bar("lips closed for p b m, %", ">=", 85, figure("controls", "lips", "closed for p b m"), 100, 1)]


def every():
    return [*synthetic(), *probes(), *levels(), *clips(), *pictures()]
