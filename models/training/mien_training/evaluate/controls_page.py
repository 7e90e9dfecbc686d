"""docs/results/controls.md: the figures of each control from all parts."""
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


def supported(results, level):
    return {c for c in CONTROLS if find(results, "response", level, "controls", c)}


def sides(control):
    """The control, and that of the right side if this is the left one."""
    return (control, control.removesuffix("Left") + "Right") if control.endswith("Left") else (control,)


def page(results):
    known = {level: supported(results, level) for level in LEVELS}
    counts = " and ".join(f"{len(known[level])} controls at {out.level(level)}" for level in LEVELS)
    lines = ["# Accuracy by control", "", "For users who ask how well a certain control works.",
             ""] + out.prose(f"""mien supports {counts}. The table has correlations with the truth on
        [rendered people](synthetic.md) and with MediaPipe on [clips](clips.md), of the left and the right control of
        a pair, or once if both are equal. A dash: not supported, or constant in MediaPipe's output.
        [response.json](response.json) has ranges, [amplitude.json](amplitude.json) deviations.""")
    one = lambda figure, level, c: out.number(figure(results, level, c), 2) if c in known[level] else "-"
    cell = lambda figure, level, c: ", ".join(dict.fromkeys(one(figure, level, side) for side in sides(c)))
    rows = [["/".join((c, *("Right" for _ in sides(c)[1:]))), *(cell(figure, level, c) for _, figure in COLUMNS
            for level in LEVELS)] for c in CONTROLS
            if not c.endswith("Right") and any(c in names for names in known.values())]
    header = ["control", *(f"{title}, {out.level(level)}" for title, _ in COLUMNS for level in LEVELS)]
    return "\n".join([*lines, *out.table(header, rows)])
