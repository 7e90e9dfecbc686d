"""docs/results/README.md: every figure beside what it should be."""
import json

import bars
import report as out
from setting import PARTS

LEVELS = ("LOD1", "LOD4")


def cell(bar, figure, level=None):
    if figure is None:
        return "-"
    shown = "not driven" if figure == bars.NOT_DRIVEN else f"{figure:.{bar.digits}f}"
    return f"{shown} {'met' if bar.met(figure, level) else '**missed**'}"


def line(bar, results):
    """Cells of a bar."""
    cells = [cell(bar, bar.figure(results.get(bar.part, {}), level), level) for level in LEVELS]
    return [bar.title, bar.shown(), *cells, f"[{bar.part}]({bar.part}.md)"]


def counts(results):
    """A line for every level that was measured: how many bars it meets."""
    for level in LEVELS:
        figures = [(bar, bar.figure(results.get(bar.part, {}), level)) for bar in bars.every()]
        known = [bar.met(figure, level) for bar, figure in figures if figure is not None]
        if known:
            yield f"* {level}: {sum(known)} of {len(known)} bars met."


def page(results, seconds, skipped, has_hifinet):
    lines = ["# Results", ""] + out.prose("""Made by `scripts/evaluate/evaluate.py`. LOD1 answers with BaseNet, LOD4 with HiFiNet; both are
        the program with its defaults, smoothing included. A dash: not measured, or MediaPipe's control hardly moves there, or a bar of
        one level. Two bounds are level 1's and level 4's.""")
    if not has_hifinet:
        lines += ["**HiFiNet is not trained yet**: nothing is known of LOD2-4.", ""]
    lines += [*counts(results), ""] + out.table(["", "bar", *LEVELS, "more"], [line(bar, results) for bar in bars.every()])
    if "voice" in results:
        sound = [(bar, bar.figure(results["voice"], None)) for bar in bars.voice()]
        rows = [[bar.title, bar.shown(), cell(bar, figure)] for bar, figure in sound]
        lines += ["## Sound", "", *out.table(["", "bar", "AudioNet"], rows), "More: [voice](voice.md).", ""]
    for level in results.get("synthetic", {}).values():
        lines += out.prose(f"""The true curves of the synthetic test sequences of {level["network"]} have a jitter of
            {1e4 * level["program"]["truth_jitter"]:.1f}e-4 themselves: a face is never quite still.""")
    lines += ["## Parts", ""] + out.table(["part", "minutes"], [[f"[{p}]({p}.md)", f"{s / 60:.1f}"] for p, s in seconds.items()])
    lines += ["[Speed beside other engines and trackers](peers.md) is measured by `scripts/peers/bench.sh`.", ""]
    if skipped:
        lines += ["## Skipped in the last run", "", *(f"* {s}" for s in skipped), ""]
    return "\n".join(lines)


def write(folder, skipped, has_hifinet):
    """Writes the page from the results of all parts that are there."""
    stored = {part: json.loads((folder / f"{part}.json").read_text()) for part in PARTS if (folder / f"{part}.json").exists()}
    results, seconds = ({part: r[key] for part, r in stored.items()} for key in ("results", "seconds"))
    (folder / "README.md").write_text(page(results, seconds, skipped, has_hifinet))
