"""Response of controls when one of them moves alone, on rendered test people: range, cross-talk, winks.

Responses are means over the last frames of a pause with the control at 1, and, for rest, of the pause before.
"""
import numpy as np

from mien_training.data.expressions import CONTROLS, INDEX
from mien_training.evaluate import metrics, probe_images
from mien_training.evaluate import report as out
from mien_training.evaluate.probes import control_plan
from mien_training.evaluate.program import y4m

WORST, WORST_SHOWN = 25, 1


def program_answers(program, lod):
    """A function (images, order) -> controls [frames,52] of the program, NaN where it has no face."""
    def answers(images, _, order):
        table = program.track(y4m(images, order), lod).table
        controls = np.stack([table[c] for c in CONTROLS], 1)
        controls[table["status"] != "tracking"] = np.nan
        return controls
    return answers


def read(controls, plan):
    """{mark: answer [52]} of one identity."""
    return {mark: controls[frames].mean(0) for mark, frames in plan.marks.items()}


def collect(sources, identities=probe_images.IDENTITIES):
    """{source: {mark: answers [identities,52]}} of functions (images, labels, order) -> controls [frames,52]."""
    plan, found = control_plan(), {name: [] for name in sources}
    for images, labels in probe_images.identities("controls", identities):
        for name, answers in sources.items():
            found[name].append(read(answers(images, labels, plan.order), plan))
    return {name: {mark: np.stack([r[mark] for r in rows]) for mark in plan.marks} for name, rows in found.items()}


def scores(found):
    """Numbers of one source from {mark: answers [identities,52]}."""
    rest = metrics.known_mean([v for k, v in found.items() if k[-1] == "rest"], (0, 1))
    driven = np.isfinite(rest)
    matrix = np.stack([metrics.known_mean(found[c, "alone"]) for c in CONTROLS])
    controls = {}
    for i, c in enumerate(CONTROLS):
        if driven[i]:
            alone, with_others = found[c, "alone"][:, i], found.get((c, "with companions"))
            controls[c] = {"rest": rest[i], "reached": metrics.known_mean(alone), "lowest_identity": np.nanmin(alone),
                           "with_companions": np.nan if with_others is None else metrics.known_mean(with_others[:, i]),
                           "others_at_most": np.delete(matrix[:, i], i).max()}
    controls = {c: {k: out.rounded(v) for k, v in row.items()} for c, row in controls.items()}
    others = np.where(np.eye(len(CONTROLS), dtype=bool) | ~driven, -np.inf, matrix)
    worst = np.argsort(others, axis=None)[::-1][:WORST]
    worst = [(CONTROLS[k // len(CONTROLS)], CONTROLS[k % len(CONTROLS)], out.rounded(others.flat[k])) for k in worst]
    answered = np.mean([np.isfinite(v).any(1).mean() for v in found.values()])
    return {"identities": len(found[CONTROLS[0], "alone"]), "face_share": out.rounded(answered), "controls": controls,
            "reached_0.6": sum(r["reached"] >= 0.6 for r in controls.values()),
            "reached_0.6_with_companions": sum(max(r["reached"], r["with_companions"] or 0) >= 0.6
                                               for r in controls.values()),
            "others_below_0.15": sum(r["others_at_most"] < 0.15 for r in controls.values()),
            "worst": worst, "winks": winks(found), "matrix": out.rounded(matrix, 3)}


def winks(found):
    """Means of the closed and the open eye, by mouth, and the share of identities above 0.8 and below 0.2."""
    table = {}
    for mouth, kind in (("closed", "alone"), ("open", "mouth open")):
        for side, other in (("Left", "Right"), ("Right", "Left")):
            answers = found["eyeBlink" + side, kind]
            shut, open_eye = (answers[:, INDEX["eyeBlink" + s]] for s in (side, other))
            table[f"{side.lower()} eye, mouth {mouth}"] = {
                "closed": out.rounded(metrics.known_mean(shut)), "other": out.rounded(metrics.known_mean(open_eye)),
                "share": out.rounded(np.mean((shut > 0.8) & (open_eye < 0.2)))}
    return table


def measure(setting):
    levels = setting.levels("response")
    found = collect({name: program_answers(setting.program, lod) for name, lod in levels.items()})
    return {name: scores(answers) for name, answers in found.items()}


def markdown(report):
    first = next(iter(report.values()))
    lines = ["# Single controls", "", "For users who need single expressions, and for trainers.",
             ""] + out.prose(f"""One control of a rendered face
        moves to 1 while the others stay at 0. The number of supported controls that reach 0.6, and of those that stay
        below 0.15 while others move:
        {out.by_level(report, lambda r: f"{r['reached_0.6']} and {r['others_below_0.15']} of {len(r['controls'])}")}.
        With companions, as on real faces (eyes turn together; tongue and mouthClose need an open jaw),
        {out.by_level(report, lambda r: str(r['reached_0.6_with_companions']))} reach 0.6. Figures are means over
        {first['identities']} rendered test people, near-frontal, without glasses, hat or occluder.""")
    worst = lambda r: ", ".join(f"{a} moves {b} by {out.number(v, 2)}" for a, b, v in r["worst"][:WORST_SHOWN])
    lines += out.prose(f"Strongest cross-talk: {out.by_level(report, worst)}.")
    return "\n".join(
        lines + [line for name in report for line in (f"![Cross-talk at {out.level(name)}](response_{name}.png)", "")])


def plot(report, folder):
    for name, r in report.items():
        values = np.array([[np.nan if v is None else v for v in row] for row in r["matrix"]])
        out.heat_map(values, CONTROLS, CONTROLS, f"{out.level(name)}: mean response (column) to one control at 1 (row)",
                     folder / f"response_{name}.png")
