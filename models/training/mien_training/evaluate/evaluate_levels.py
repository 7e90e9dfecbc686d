"""Levels of detail: differences from level 4, and cost."""
import numpy as np

from mien_training.data.expressions import CONTROLS
from mien_training.evaluate import report as out
from mien_training.evaluate import videos

ROUNDS = 9  # of timing, all levels interleaved; the fastest counts
SHOWN = ("jawOpen", "mouthPucker", "eyeBlinkLeft")
PICTURED = "whitehouse_obama_weekly"


def followed_ms(stats):
    """Mean time of a frame, the search for a face not counted."""
    total = lambda stage: stats["stages"].get(stage, {"total_ms": 0.0})["total_ms"]
    return (total("frame") - total("proposal")) / stats["frames"]


def controls_of(tracked):
    """[frames,52]; NaN without a face and where the level does not drive a control."""
    values = np.stack([tracked.table[c] for c in CONTROLS], 1)
    values[tracked.table["status"] != "tracking"] = np.nan
    return values


def cost(rounds):
    """Mean ms of a frame of one level, from its rounds [[Tracked of every video]]: the fastest round of each video
    counts."""
    times = np.min([[followed_ms(t.stats) for t in videos_of] for videos_of in rounds], 0)
    return float(np.average(times, weights=[t.stats["frames"] for t in rounds[0]]))


def difference(answers, reference):
    """Mean absolute difference, and the number of controls that both support."""
    error = np.abs(answers - reference)
    return {"error": float(np.nanmean(error)), "controls": int(np.isfinite(error).any(0).sum())}


def measure(setting):
    program, paths = setting.program, [videos.DEMO, *videos.clips()]
    has_all = len(setting.levels("levels")) > 1
    levels = {f"LOD{k}": k for k in (range(1, 5) if has_all else (1,))}
    rounds = [{name: [program.track(p, lod) for p in paths] for name, lod in levels.items()} for _ in range(ROUNDS)]
    tracked, costs = rounds[0], {name: cost([r[name] for r in rounds]) for name in levels}
    answers = {name: np.concatenate([controls_of(t) for t in found]) for name, found in tracked.items()}
    report = {"frames": len(answers["LOD1"]), "levels": {}}
    for name in levels:
        row = report["levels"][name] = {"ms": costs[name], "tracker_bytes": tracked[name][0].stats["tracker_bytes"]}
        if has_all:
            row.update(difference(answers[name], answers["LOD4"]), cost_ratio=costs[name] / costs["LOD4"])
    stems = [p.stem for p in paths]
    shown = stems.index(PICTURED) if PICTURED in stems else 0
    report["clip"] = stems[shown]
    report["curves"] = {name: {c: out.rounded(found[shown].table[c], 3) for c in SHOWN}
                        for name, found in tracked.items()}
    return report


def markdown(report):
    first = next(iter(report["levels"].values()))
    lines = ["# Levels of detail", "", "For users who choose between speed and accuracy.",
             ""] + out.prose(f"""A tracked frame at level 1 takes
        {out.number(first.get("cost_ratio"), 2)} of the time at level 4. The data are {report['frames']}
        frames of the [clips](clips.md) and the demo clip. Error: mean absolute
        difference to level 4 over controls that both levels support; Navarro et al. (2023) report 0.0123 for level 2
        and 0.0059 for level 3. Time: one core, the fastest of {ROUNDS} rounds; only the ratio carries over to other
        machines. The tracker without weights takes
        {max(r["tracker_bytes"] for r in report["levels"].values()) / 1e6:.2f} MB.""")
    lines += out.table(["level", "error", "ms per frame", "relative time"],
                       [[out.level(name), out.number(r.get("error"), 4), out.number(r["ms"]),
                         out.number(r.get("cost_ratio"), 2)] for name, r in report["levels"].items()])
    return "\n".join(lines + [f"![Curves of {report['clip']}](levels.png)", ""])


def plot(report, folder):
    figure, axes = out.plt.subplots(len(SHOWN), 1, figsize=(9, 6), sharex=True)
    for control, panel in zip(SHOWN, axes):
        for name, values in report["curves"].items():
            panel.plot([np.nan if v is None else v for v in values[control]], label=name, linewidth=1)
        panel.set_ylabel(control)
        panel.set_ylim(-0.02, 1.02)
    axes[0].legend(ncol=4, fontsize=8)
    axes[-1].set_xlabel(f"frame of {report['clip']}")
    out.save(figure, folder / "levels.png")
