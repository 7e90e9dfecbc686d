"""Tables and plots of the results."""
import json
import re
import textwrap

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np


def table(header, rows):
    """Lines of a Markdown table; cells are text."""
    line = lambda cells: f"|{'|'.join(cells)}|"
    return [line(header), "|---" * len(header) + "|", *(line(row) for row in rows), ""]


def prose(text):
    """A paragraph, broken into lines, and an empty line."""
    return [*textwrap.wrap(" ".join(text.split()), 132), ""]


def number(value, digits=3):
    """A figure for a page; a dash if it was not measured."""
    return "-" if value is None or not np.isfinite(value) else f"{value:.{digits}f}"


def level(name):
    """LOD4 -> level 4."""
    return name.replace("LOD", "level ")


def by_level(report, text):
    """`text` of the results of each level: 0.5 at level 1 and 0.7 at level 4."""
    return " and ".join(f"{text(r)} at {level(name)}" for name, r in report.items())


def save(figure, path):
    """A small PNG: a palette is enough for plots."""
    from PIL import Image
    figure.savefig(path, dpi=90, bbox_inches="tight")
    plt.close(figure)
    Image.open(path).convert("RGB").quantize(256, dither=Image.Dither.NONE).save(path, optimize=True)


def heat_map(values, rows, columns, title, path, limit=1.0):
    figure, axes = plt.subplots(figsize=(0.17 * len(columns) + 3, 0.17 * len(rows) + 2))
    shown = axes.imshow(values, vmin=0, vmax=limit, cmap="magma_r", aspect="auto")
    axes.set_xticks(range(len(columns)), columns, rotation=90, fontsize=6)
    axes.set_yticks(range(len(rows)), rows, fontsize=6)
    axes.set_title(title, fontsize=9)
    figure.colorbar(shown, ax=axes, fraction=0.03)
    save(figure, path)


def dump(report):
    """JSON with one line for every list of numbers."""
    text = json.dumps(report, indent=1)
    return re.sub(r"\[[^\[\]{}\"]*\]", lambda m: re.sub(r"\s+", " ", m[0]), text) + "\n"


def rounded(values, digits=4):
    """Nested lists of numbers for JSON; NaN becomes null."""
    if isinstance(values, (np.ndarray, list, tuple)):
        return [rounded(v, digits) for v in values]
    return None if not np.isfinite(values) else round(float(values), digits)
