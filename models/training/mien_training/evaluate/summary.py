"""docs/results/README.md: every figure and its goal."""
import json

from mien_training.evaluate import controls_page, targets
from mien_training.evaluate import report as out
from mien_training.evaluate.controls_page import LEVELS, find
from mien_training.evaluate.inputs import PARTS

SHOWN = ("synthetic", "response", "leakage", "levels", "clips", "images", "wild", "amplitude")


def cell(goal, figure, level=None):
    if figure is None:
        return "-"
    shown = "not driven" if figure == targets.NOT_DRIVEN else f"{figure:.{goal.digits}f}"
    return shown if goal.met(figure, level) else f"**{shown}**"


def line(goal, results):
    """Cells of a goal."""
    cells = [cell(goal, goal.figure(results.get(goal.part, {}), level), level) for level in LEVELS]
    return [goal.title, goal.shown(), *cells]


def rows_of(part, results):
    """Cells of the goals of a part, those of correlations counted in one row, and lines about the missed ones."""
    goals = [goal for goal in targets.every() if goal.part == part]
    single = [goal for goal in goals if not goal.title.startswith(targets.CORRELATION)]
    rows, cells, missed = [line(goal, results) for goal in single], [], []
    for level in LEVELS:
        known = [(goal, goal.figure(results.get(part, {}), level)) for goal in goals if goal not in single]
        known = [(goal, figure) for goal, figure in known if figure is not None]
        fails = [f"{goal.title.removeprefix(targets.CORRELATION)} {cell(goal, figure, level).strip('*')}"
                 for goal, figure in known if not goal.met(figure, level)]
        cells.append(f"{len(known) - len(fails)} of {len(known)} met")
        missed += [f"* [{part}]({part}.md), {out.level(level)}: {', '.join(fails)}"] if fails else []
    if len(goals) > len(single):
        rows.append([f"correlations with MediaPipe, {part}", "", *cells])
    return [[f"[{title}]({part}.md)", *rest] for title, *rest in rows], missed


def counts(results):
    """A line for every level that was measured: the number of goals it meets."""
    for level in LEVELS:
        figures = [(goal, goal.figure(results.get(goal.part, {}), level)) for goal in targets.every()]
        known = [goal.met(figure, level) for goal, figure in figures if figure is not None]
        if known:
            yield f"* {out.level(level)}: {sum(known)} of {len(known)} goals met."


def in_short(results):
    """How accurate, how fast, on which data."""
    known = lambda digits, scale, *path: " and ".join(out.number(None if v is None else scale * v, digits) for v in (
        find(results, *(level if p is None else p for p in path)) for level in LEVELS))
    speed = ""
    if frames := find(results, "peers", "frames"):
        first, last = (frames["mien_us"][level] for level in ("1", "4"))
        speed = f"""a frame takes {first / 1000:.3f} ms at level 1 and {last / 1000:.3f} ms at level 4 on one core
            ({results["peers"]["processor"]}),
            {frames["mediapipe_us"] / first:.0f} and {frames["mediapipe_us"] / last:.0f} times as fast as MediaPipe."""
    if "tracking" in results:
        ratios = [clip["speedup"] for clip in results["tracking"].values()]
        speed += f" Detection on every frame would take {min(ratios):.0f} to {max(ratios):.0f} times as long."
    return out.prose(
        f"""**Accuracy** at level 1 and level 4. Rendered test people, whose controls are known: mean correlation
        {known(2, 1, "synthetic", None, "program", "correlation_mean")} over
        {known(0, 1, "synthetic", None, "program", "supported")} supported controls. Clips of real people, compared with
        MediaPipe: jawOpen {known(2, 1, "clips", None, "controls", "jawOpen", "correlation")}, left smile
        {known(2, 1, "clips", None, "controls", "mouthSmileLeft", "correlation")}, landmarks within
        {known(1, 100, "clips", None, "all", "landmark_error_pupils")} % of the distance between the pupils.
        [By control](controls.md).""") + out.prose(
            f"""**Speed**: {speed} [Comparison](peers.md).""") + out.prose("""**Data**: rendered people with exact
        labels, clips and portraits with labels of MediaPipe, held-out voices. None of it was used for training, except
        as the [model card](../../models/README.md) states.""")


def page(results, skipped, has_hifinet):
    lines = ["# Results", "",
             "For users who judge whether mien is good enough for them, and for developers who change it.", "",
             "![Correlations of every control](controls.png)", "", *in_short(results)]
    lines += out.prose(
        """Most goals are those of the published method or MediaPipe's own quality; two bounds are for level 1 and level
        4. Bold figures miss their goal; a dash: not measured or without a goal. Pages that name no command are made by
        `python3 -m mien_training.evaluate`.""")
    if not has_hifinet:
        lines += ["**HiFiNet is not trained yet**: levels 2 to 4 are unknown.", ""]
    lines += [*counts(results), ""]
    rows, missed = (sum(parts, []) for parts in zip(*(rows_of(part, results) for part in SHOWN)))
    lines += out.table(["figure", "goal", *map(out.level, LEVELS)], rows)
    lines += ["Correlations below their goal:", "", *missed, ""] if missed else []
    if "audio" in results:
        sound = [(goal, goal.figure(results["audio"], None)) for goal in targets.audio()]
        rows = [[goal.title, goal.shown(), cell(goal, value)] for goal, value in sound]
        lines += ["## [Audio](audio.md)", "", *out.table(["figure", "goal", "AudioNet"], rows)]
    if skipped:
        lines += ["## Skipped in the last run", "", *(f"* {s}" for s in skipped), ""]
    return "\n".join(lines)


def write(folder, skipped, has_hifinet):
    """Writes the page from the results of all parts that are there."""
    results = {part: json.loads((folder / f"{part}.json").read_text())["results"] for part in PARTS
               if (folder / f"{part}.json").exists()}
    if (folder / "peers.json").exists():
        results["peers"] = json.loads((folder / "peers.json").read_text())
    controls_page.plot(results, folder / "controls.png")
    (folder / "controls.md").write_text(controls_page.page(results))
    (folder / "README.md").write_text(page(results, skipped, has_hifinet))
