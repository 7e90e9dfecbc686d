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


def reached(row):
    """The highest response to the control at 1, alone or with its companions."""
    return row and max(row["reached"], row["with_companions"] or 0)


# Title and figure of a control at a level.
COLUMNS = (
    ("rendered", lambda results, level, c: find(results, "synthetic", level, "program", "correlation", c)),
    ("clips", lambda results, level, c: agreement(find(results, "clips", level, "controls"), c)),
    ("portraits", lambda results, level,
     c: agreement(find(results, "images", "levels", level, "portraits", "controls"), c)),
    ("at 1", lambda results, level, c: reached(find(results, "response", level, "controls", c))),
    ("others", lambda results, level, c: find(results, "response", level, "controls", c, "others_at_most")),
    ("deviation", lambda results, level, c: find(results, "amplitude", level, "renders", "controls", c, "ratio")),
)


def supported(results, level):
    return {c for c in CONTROLS if find(results, "response", level, "controls", c)}


def cells(results, level, control):
    if control not in supported(results, level):
        return ["-"] * len(COLUMNS)
    return [out.number(figure(results, level, control), 2) for _, figure in COLUMNS]


def page(results):
    counts = " and ".join(f"{len(supported(results, level))} controls at {out.level(level)}" for level in LEVELS)
    lines = ["# Accuracy by control", "", "For users who ask how well a certain control works.",
             ""] + out.prose(f"""mien supports {counts}. Rendered:
        correlation with the truth on [rendered people](synthetic.md). Clips, portraits: correlation with MediaPipe on
        [clips](clips.md) and across [portraits](images.md). At 1, others: response to the [control at 1](response.md),
        alone or with companions, and the largest response while another control moves. Deviation: standard deviation
        relative to the truth on rendered people ([amplitude](amplitude.md)). A dash: not supported, not measured, or
        constant in MediaPipe's output.""")
    for level in LEVELS:
        rows = [[c, *cells(results, level, c)] for c in CONTROLS if c in supported(results, level)]
        lines += [f"## {out.level(level).capitalize()}", "",
                  *out.table(["control", *(title for title, _ in COLUMNS)], rows)]
    return "\n".join(lines + ["Made by `python3 -m mien_training.evaluate`.", ""])
