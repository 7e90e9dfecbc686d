"""Writes the errors by group of people from docs/results into the model card, models/README.md.

usage: python3 -m mien_training.evaluate.model_card      the evaluation runs it as well
"""
import json

from mien_training.evaluate import report as out
from mien_training.paths import ROOT

CARD = ROOT / "models/README.md"
BEGIN, END = "<!-- made by mien_training.evaluate.model_card -->", "<!-- to here -->"
LEVELS = ("LOD1", "LOD4")


def wild(results):
    """Lines of the portraits in the wild: the worst group relative to all, and each group."""
    levels = [results["levels"][name] for name in LEVELS]
    cells = lambda r: [f"{100 * r['found']:.1f} %", out.number(r["error"] and 100 * r["error"], 2),
                       out.number(r["correlation"], 2)]
    lines = [["all", str(levels[0]["pictures"]), *cells(levels[0]), *cells(levels[1])]]
    for key in ("by_group", "by_sex", "by_age"):
        for name, first in levels[0][key].items():
            lines.append([name, str(first["pictures"]), *cells(first), *cells(levels[1][key][name])])
    worst = [f"level {name[-1]}: {r['worst_group_ratio']:.2f}" for name, r in zip(LEVELS, levels)]
    text = out.prose(
        f"""Landmark error of the worst ethnic group relative to all (goal: 1.15 at most): {", ".join(worst)}.""")
    return text + out.table(["portraits in the wild", "images", "level 1: detected", "landmarks, %", "controls",
                             "level 4: detected", "landmarks, %", "controls"], lines)


def tones(results):
    """Lines of the single portraits by skin tone."""
    first, last = (results["levels"][name]["portraits"]["by_tone"] for name in LEVELS)
    cells = lambda r: [str(r["lost"]), out.number(r["error"] and 100 * r["error"], 2)]
    lines = [[name, str(group["pictures"]), *cells(group), *cells(last[name])] for name, group in first.items()]
    return out.table(["portraits by skin tone", "images", "level 1: lost", "landmarks, %", "level 4: lost",
                      "landmarks, %"], lines)


def write(folder):
    """Replaces the text between the comments with the results in that folder, if it has both parts."""
    parts = [folder / "wild.json", folder / "images.json"]
    if not all(part.exists() for part in parts):
        return
    found, single = (json.loads(part.read_text())["results"] for part in parts)
    card = CARD.read_text()
    before, _, rest = card.partition(BEGIN)
    after = rest.partition(END)[2]
    CARD.write_text("\n".join([before + BEGIN, *wild(found), *tones(single)]).rstrip() + "\n" + END + after)


if __name__ == "__main__":
    write(ROOT / "docs/results")
