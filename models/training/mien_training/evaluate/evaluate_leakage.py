"""Effect of turning the head on the controls of a neutral face, on rendered test people."""
import numpy as np

from mien_training.data.expressions import CONTROLS
from mien_training.evaluate import metrics, probe_images
from mien_training.evaluate import report as out
from mien_training.evaluate.evaluate_response import program_answers, read
from mien_training.evaluate.probes import PITCH, YAW, pose_plan


def scores(found):
    """Drift from the frontal answer, mean of |difference| over identities; found: {(axis, degrees):
    [identities,52]}."""
    front = np.mean([v for (axis, _), v in found.items() if axis == "front"], 0)
    driven = np.isfinite(front).all(0)
    drift = {mark: metrics.known_mean(np.abs(v - front)) for mark, v in found.items() if mark[0] != "front"}
    worst = {axis: np.max([d for (a, _), d in drift.items() if a == axis], 0) for axis in ("yaw", "pitch")}
    rows = {c: {"front": out.rounded(front[:, i].mean()), **{axis: out.rounded(d[i]) for axis, d in worst.items()}}
            for i, c in enumerate(CONTROLS) if driven[i]}
    by_angle = {axis: {degrees: out.rounded(d[driven].max()) for (a, degrees), d in sorted(drift.items()) if a == axis}
                for axis in ("yaw", "pitch")}
    largest = max(rows, key=lambda c: max(rows[c]["yaw"], rows[c]["pitch"]))
    followed = np.mean([np.isfinite(v).any(1).mean() for v in found.values()])
    return {"identities": len(front), "face_share": out.rounded(followed),
            "largest": max(rows[largest]["yaw"], rows[largest]["pitch"]), "largest_control": largest,
            "below_0.1": sum(max(r["yaw"], r["pitch"]) <= 0.1 for r in rows.values()), "controls": rows,
            "by_angle": by_angle}


def measure(setting):
    plan, levels = pose_plan(), setting.levels("leakage")
    found = {name: [] for name in levels}
    for images, labels in probe_images.identities("pose"):
        for name, lod in levels.items():
            found[name].append(read(program_answers(setting.program, lod)(images, labels, plan.order), plan))
    return {name: scores({mark: np.stack([r[mark] for r in rows]) for mark in plan.marks})
            for name, rows in found.items()}


def markdown(report):
    first = next(iter(report.values()))
    largest = lambda r: f"{r['largest_control']} by {out.number(r['largest'])}"
    lines = ["# Neutral faces that turn", "", "For users whose subjects look around, and for trainers.",
             ""] + out.prose(f"""Turning the head changes
        {out.by_level(report, largest)} most; the goal is 0.1 at most. The data are {first['identities']} rendered test
        people with all controls at 0, turned by up to {YAW} degrees of yaw and {PITCH} of pitch. Drift is the mean
        absolute difference to the output of the same face looking ahead.""")
    return "\n".join(lines + ["![Drift by angle](leakage.png)", ""])


def plot(report, folder):
    figure, axes = out.plt.subplots(1, 2, figsize=(8, 3), sharey=True)
    for axis, panel in zip(("yaw", "pitch"), axes):
        for name, r in report.items():
            degrees = sorted(int(d) for d in r["by_angle"][axis])
            values = {int(k): v for k, v in r["by_angle"][axis].items()}
            panel.plot(degrees, [values[d] for d in degrees], marker=".", label=out.level(name))
        panel.axhline(0.1, color="grey", linewidth=0.8)
        panel.set_xlabel(f"{axis}, degrees")
    axes[0].set_ylabel("largest drift of a control")
    axes[0].legend()
    out.save(figure, folder / "leakage.png")
