"""docs/results/controls.md and controls.png: the figures of each control from all parts."""
import matplotlib.pyplot as plt
import numpy as np

from mien_training.data.expressions import CONTROLS
from mien_training.evaluate import report as out
from mien_training.evaluate.teacher import MOVES

LEVELS = ("LOD1", "LOD4")


def find(results, *path):
    """A figure of a part, or None if it was not measured."""
    for step in path:
        results = results.get(step) if results else None
    return results


def agreement(rows, control):
    """Correlation with MediaPipe, where MediaPipe's control moves."""
    row = find(rows, control)
    return row["correlation"] if row and row["spread"] >= MOVES else None


# Title and figure of a control at a level.
COLUMNS = (
    ("rendered", lambda results, level, c: find(results, "synthetic", level, "program", "correlation", c)),
    ("clips", lambda results, level, c: agreement(find(results, "clips", level, "controls"), c)),
)
TITLES = {"rendered": "Correlation with the truth, rendered people", "clips": "Correlation with MediaPipe, clips"}


def supported(results, level):
    return {c for c in CONTROLS if find(results, "response", level, "controls", c)}


def sides(control):
    """The control, and that of the right side if this is the left one."""
    return (control, control.removesuffix("Left") + "Right") if control.endswith("Left") else (control,)


def title_of(control):
    return control + "/Right" if control.endswith("Left") else control


def listed(known):
    """The supported controls, without the right ones of pairs; `known` has those of each level."""
    return [c for c in CONTROLS if not c.endswith("Right") and any(c in names for names in known.values())]


def plot(results, path):
    """Correlations of every control, the mean of both sides, as an image."""
    known = {level: supported(results, level) for level in LEVELS}
    controls = listed(known)
    figure, panels = plt.subplots(1, len(COLUMNS), figsize=(10, 6), sharey=True)
    for axes, (title, of) in zip(panels, COLUMNS):
        for level, fill in zip(LEVELS, ("white", "tab:blue")):
            sided = [[of(results, level, side) for side in sides(c) if c in known[level]] for c in controls]
            means = [np.mean(values) if values and None not in values else np.nan for values in sided]
            axes.scatter(means, range(len(controls)), 22, fill, edgecolors="tab:blue", label=out.level(level))
        axes.set(title=TITLES[title], xlim=(-0.05, 1), yticks=range(len(controls)), yticklabels=map(title_of, controls))
        axes.grid(alpha=0.3)
    panels[0].invert_yaxis()
    panels[0].tick_params(axis="y", labelsize=7)
    panels[0].legend(loc="upper left")
    out.save(figure, path)


def page(results):
    known = {level: supported(results, level) for level in LEVELS}
    counts = " and ".join(f"{len(known[level])} controls at {out.level(level)}" for level in LEVELS)
    lines = ["# Accuracy by control", "", "For users who ask how well a certain control works.",
             ""] + out.prose(f"""mien supports {counts} in video; sound adds jawForward. The table has
        correlations with the truth on [rendered people](synthetic.md) and with MediaPipe on [clips](clips.md), of the
        left and the right control of a pair, or once if both are equal. A dash: not supported, or constant in
        MediaPipe's output.
        [response.json](response.json) has ranges, [amplitude.json](amplitude.json) deviations.""")
    one = lambda figure, level, c: out.number(figure(results, level, c), 2) if c in known[level] else "-"
    cell = lambda figure, level, c: ", ".join(dict.fromkeys(one(figure, level, side) for side in sides(c)))
    rows = [[title_of(c), *(cell(figure, level, c) for _, figure in COLUMNS for level in LEVELS)]
            for c in listed(known)]
    header = ["control", *(f"{title}, {out.level(level)}" for title, _ in COLUMNS for level in LEVELS)]
    return "\n".join([*lines, *out.table(header, rows)])
