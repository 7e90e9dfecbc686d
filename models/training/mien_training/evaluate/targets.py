"""Goals of mien, and where each figure is in the results."""
from dataclasses import dataclass
from statistics import fmean
from typing import Callable

from mien_training.evaluate.evaluate_wild import POSES
from mien_training.evaluate.teacher import MOVES


def of_levels(first, fourth):
    """Bounds of level 1 and of level 4; None without a goal."""
    return {"LOD1": first, "LOD4": fourth}


SIDEWAYS = of_levels(None, 0.7)  # level 1 has no gaze
FOLLOWED = {"jawOpen": of_levels(0.87, 0.9), "eyeBlinkLeft": of_levels(0.85, 0.88),
            "eyeBlinkRight": of_levels(0.85, 0.88),
            "mouthSmileLeft": of_levels(0.82, 0.85), "mouthSmileRight": of_levels(0.82, 0.85),
            "mouthPucker": of_levels(0.65, 0.75),
            "browInnerUp": of_levels(0.65, 0.75), "mouthLowerDownLeft": of_levels(0.5, 0.5),
            "mouthLowerDownRight": of_levels(0.5, 0.5),
            "eyeLookInLeft": SIDEWAYS, "eyeLookOutLeft": SIDEWAYS, "eyeLookInRight": SIDEWAYS,
            "eyeLookOutRight": SIDEWAYS}  # least correlation with MediaPipe, where MediaPipe's moves
CORRELATION = "correlation, "  # begins the title of a goal of agreement with MediaPipe
NOT_DRIVEN = float("-inf")  # the figure of a control that should be driven and is not


@dataclass
class Goal:
    part: str        # whose results
    title: str
    sign: str        # "<=", ">=", "<" or ">"
    bound: object    # in the unit shown; or one for each level, None where the level has no goal
    pick: Callable   # (results, level) -> figure; None where it does not apply
    scale: float = 1.0
    digits: int = 2

    def figure(self, results, level):
        """In the unit shown; None where it was not measured or does not apply."""
        if self.bound_of(level) is None:
            return None
        try:
            value = self.pick(results, level)
        except KeyError:
            return None
        return None if value is None or value != value else self.scale * value

    def bound_of(self, level):
        return self.bound[level] if isinstance(self.bound, dict) else self.bound

    def shown(self):
        bounds = self.bound.values() if isinstance(self.bound, dict) else [self.bound]
        return f"{self.sign} " + " / ".join("-" if b is None else f"{b:g}" for b in bounds)

    def met(self, figure, level):
        bound = self.bound_of(level)
        return {"<=": figure <= bound, ">=": figure >= bound, "<": figure < bound, ">": figure > bound}[self.sign]


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
    goal = lambda title, *rest: Goal("synthetic", title, *rest)
    return [goal("supported controls", ">=", of_levels(36, 44), score("supported"), 1, 0),
            goal("their error, relative to the best constant", "<=", 0.5,
                ratio(error, score("constant_median_supported"))),
            goal("their mean correlation", ">=", of_levels(0.75, 0.8), score("correlation_mean")),
            goal("their lowest correlation", ">=", 0.5, score("correlation_lowest")),
            goal("their jitter, relative to the truth's", "<=", 1,
                ratio(score("jitter_supported"), score("truth_jitter_supported"))),
            goal("asymmetry x 1e-3", "<=", 3.6, score("asymmetry"), 1e3, 1)]


def probes():
    goal = lambda title, *rest: Goal("response", title, *rest)
    return [goal("% of them that reach 0.6 alone", ">=", 80,
                over("reached", share(lambda v: v >= 0.6), "controls"), 100, 0),
            goal("% of them below 0.15 while others move", ">=", 80,
                over("others_at_most", share(lambda v: v < 0.15), "controls"), 100, 0),
            goal("winks: lowest closed eye", ">", 0.8, over("closed", min, "winks")),
            goal("winks: highest open eye", "<", 0.2, over("other", max, "winks")),
            Goal("leakage", "largest change on a turning neutral face", "<=", 0.1, at(at, "largest"))]


def levels():
    of_hifinet = lambda pick: lambda results, level: pick(results, level) if level == "LOD4" else None
    row = lambda name, key: of_hifinet(at("levels", name, key))
    goal = lambda title, *rest: Goal("levels", title, *rest)
    return [goal("error of level 2 against level 4", "<=", 0.0123, row("LOD2", "error"), 1, 4),
            goal("error of level 3 against level 4", "<=", 0.0059, row("LOD3", "error"), 1, 4),
            goal("time of level 2 relative to level 4", "<=", 0.55, row("LOD2", "cost_ratio")),
            goal("memory without weights, MB", "<=", 6, at("levels", at, "tracker_bytes"), 1e-6)]


def agreement(control, *path):
    """Picks the correlation of a control with MediaPipe's, where that one moves."""
    def pick(results, level):
        row = at(*path, "controls", control)(results, level)
        if row["spread"] < MOVES:
            return None
        return NOT_DRIVEN if row["correlation"] is None else row["correlation"]
    return pick


def beside_mediapipe(part, path, numbers, landmarks):
    """Goals of landmarks, pose and controls; `numbers` leads to pose, `path` to the controls; landmarks: (title, key,
    bound)."""
    goal = lambda title, *rest: Goal(part, title, *rest)
    key = lambda name: at(*numbers, name)
    title, name, bound = landmarks
    return [goal(f"landmark error, % of {title}", "<=", bound, key(name), 100),
            goal("head pose, degrees", "<=", 2, key("pose_difference_deg")),
            *(goal(f"{CORRELATION}{c}", ">=", least, agreement(c, *path)) for c, least in FOLLOWED.items())]


def clips():
    total = lambda key: at(at, "all", key)
    goal = lambda title, *rest: Goal("clips", title, *rest)
    return [goal("% of MediaPipe's frames with a face", ">=", 99, total("face_share"), 100, 1),
            goal("jitter at rest, relative to MediaPipe", "<=", 1,
                ratio(total("still_jitter"), total("teacher_still_jitter"))),
            *beside_mediapipe("clips", (at,), (at, "all"),
                              ("the pupils' distance", "landmark_error_pupils", of_levels(4.2, 3.5)))]


def images():
    path = ("levels", at, "portraits")
    return [Goal("images", "% detected", ">=", 99, at(*path, "found"), 100, 1),
            *beside_mediapipe("images", path, path,
                              ("the outer eye corner distance", "landmark_error_outer_eyes", 4))]


def wild():
    figure = lambda key: at("levels", at, key)
    goal = lambda title, *rest: Goal("wild", title, *rest)
    found = lambda pose: at("levels", at, "by_pose", pose, "found")
    ahead, turned = POSES
    return [goal(f"% correctly detected, {ahead}", ">=", 97, found(ahead), 100, 1),
            goal(f"% correctly detected, {turned}", ">=", 75, found(turned), 100, 1),
            goal("landmark error, % of the pupils' distance", "<=", 3.5, figure("error"), 100),
            goal("the same for the worst ethnic group, relative to all", "<=", 1.15, figure("worst_group_ratio"))]


def amplitude():
    """How far faces move."""
    goal = lambda title, *rest: Goal("amplitude", title, *rest)
    peaks = at(at, "clips", "blinks", "peaks")
    portraits, renders = (lambda key: at(at, "portraits", key)), (lambda key: at(at, "renders", key))
    known = lambda rows, key: (row[key] for row in rows.values() if row[key] is not None)
    fits = lambda v: 0.8 <= v <= 1.25
    right = lambda results, level: fmean(fits(renders("controls")(results, level)[c]["ratio"])
                                         for c in results[level]["supported"])
    return [goal("mean peak of eyeBlink in blinks", ">=", of_levels(0.7, 0.8), lambda *a: fmean(peaks(*a))),
            goal("% of blinks above 0.5", ">=", 95, lambda *a: fmean(p > 0.5 for p in peaks(*a)), 100, 0),
            goal("false blinks on clips", "<=", 1, at(at, "clips", "blinks", "false"), 1, 0),
            goal("mean eyeBlink of closed eyes on portraits", ">=", of_levels(0.7, 0.8), portraits("closed")),
            goal("neutral portraits: largest mean of a control", "<=", 0.1, portraits("neutral_largest")),
            goal("neutral portraits: mean of all controls", "<=", 0.03, portraits("neutral_mean"), 1, 3),
            goal("% of controls with 0.8 to 1.25 of the true deviation", ">=", 100, right, 100, 0),
            goal("rendered neutral faces: largest mean of a control", "<=", 0.1,
                lambda *a: max(known(renders("at_rest")(*a), "mean")))]


def audio():
    """Goals for audio, which have no level."""
    figure = lambda *path: lambda results, _: at(*path)(results, None)
    goal = lambda title, *rest: Goal("audio", title, *rest)
    ratio = lambda decibels: figure("activity", str(decibels), "accuracy")
    best_lag = lambda results, _: abs(results["controls"]["held-out clips"]["jawOpen"]["lag"])
    return [goal("voice activity at 20 dB, % of frames", ">=", 96, ratio(20), 100, 1),
            goal("voice activity at 5 dB, % of frames", ">=", 90, ratio(5), 100, 1),
            goal("noise alone: mouth at rest, % of the time", ">=", 95, figure("noise", "all"), 100, 1),
            goal("jawOpen, correlation with MediaPipe, held-out clips", ">=", 0.7,
                figure("controls", "held-out clips", "jawOpen", "all frames")),
            goal("its lag, video frames", "<=", 1, best_lag, 1, 0),
            goal("jawOpen, other people, GRID clips, mean of clips", ">=", 0.65, clips_of("grid_")),
            goal("jawOpen, other people, free speech, mean of clips", ">=", 0.4, clips_of("hdtf_", "whitehouse_")),
            goal("lips closed for p b m, %", ">=", 95, figure("controls", "lips", "closed for p b m"), 100, 1),
            *(goal(f"{control} on {where}, 95th percentile", ">=", 0.4, figure("controls", "strength", control))
              for control, where in (("jawOpen", "open vowels"), ("mouthPucker", "rounded vowels"),
                                     ("mouthFunnel", "rounded vowels")))]


def clips_of(*prefixes):
    """Mean over the clips of audio_jaw.py whose names start with a prefix."""
    def pick(results, _):
        rows = [row["lag 0"] for name, row in results["jaw"]["clips"].items() if name.startswith(prefixes)]
        return fmean(rows) if rows else None
    return pick


def every():
    return [*synthetic(), *probes(), *levels(), *clips(), *images(), *wild(), *amplitude()]
