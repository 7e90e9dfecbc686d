"""The program on portraits in the wild, held out by name: each pasted into a larger plain picture, in which it has to be searched.

A face is found rightly when the mean landmark error is below a share of the pupils' distance. Labels are MediaPipe's, a teacher and not
the truth.
"""
import numpy as np

import faces
import landmark_points as lp
import metrics
import report as out
from evaluate_pictures import show
from setting import Missing

CANVAS = (480, 640)     # height, width
RIGHT = 0.15            # of the pupils' distance
FEWEST = 20             # pictures of a group worth a line
ETHNIC = ("Black", "East Asian", "Indian", "Latino Hispanic", "Middle Eastern", "Southeast Asian", "White")


def pasted(picture, rng):
    """The picture somewhere on a plain canvas, and where its corner (x, y) lies."""
    canvas = np.full((*CANVAS, 3), rng.integers(40, 216, 3), np.uint8)
    x, y = (int(rng.integers(0, room - size + 1)) for room, size in zip(CANVAS[::-1], picture.shape[1::-1]))
    canvas[y:y + picture.shape[0], x:x + picture.shape[1]] = picture
    return canvas, np.array([x, y])


def errors(program, lod, portraits, seed=3):
    """Landmark error of each portrait in its pupils' distances; infinite where there is no face."""
    rng, found = np.random.default_rng(seed), []
    for (picture, _), points in zip(portraits, portraits.points):
        canvas, corner = pasted(picture, rng)
        tracked, truth = show(program, canvas, lod), points + corner
        pupils = np.linalg.norm(truth[lp.POSITION[lp.IRIS[0][0]]] - truth[lp.POSITION[lp.IRIS[1][0]]])
        known = tracked.table["status"][-1] == "tracking"
        found.append(metrics.point_error(tracked.landmarks[-1:], truth[None], pupils)[0] if known else np.inf)
    return np.array(found)


def summary(error):
    right = error < RIGHT
    return {"pictures": len(error), "found": out.rounded(right.mean()), "error": out.rounded(error[right].mean()) if right.any() else None}


def by(error, values, names=None):
    chosen = {name: np.asarray(values) == name for name in (names or sorted(set(values) - {""}))}
    return {name: summary(error[rows]) for name, rows in chosen.items() if rows.sum() >= FEWEST}


def measure(setting):
    portraits = faces.Portraits("test", ("faces_wild",))
    if not len(portraits):
        raise Missing("the portraits in the wild are absent: MIEN_DATA must name the folder of the data packs")
    report = {"levels": {}}
    for name, lod in setting.levels("wild").items():
        error, labels = errors(setting.program, lod, portraits), portraits.labels
        groups = by(error, labels.group, ETHNIC)
        whole = summary(error)
        worst = max((g["error"] for g in groups.values() if g["error"]), default=float("nan"))
        turned = np.where(labels.near_profile(), "turned by more than 38 degrees", "ahead")
        known = summary(error[np.isin(labels.group, ETHNIC)])["error"]
        report["levels"][name] = {**whole, "worst_group_ratio": out.rounded(worst / whole["error"]),
                                  "worst_group_ratio_among_groups": known and out.rounded(worst / known), "by_group": groups,
                                  "by_sex": by(error, labels.sex), "by_age": by(error, labels.age), "by_pose": by(error, turned),
                                  "by_pack": by(error, [str(n).partition("_")[0] for n in labels.name])}
    return report


def markdown(report):
    lines = ["# Portraits in the wild, held out", ""] + out.prose(f"""Each is pasted into a plain picture of {CANVAS[1]} x {CANVAS[0]} pixels and
        searched. Found rightly: mean landmark error below {100 * RIGHT:.0f} % of the pupils' distance; errors are of those.""")
    row = lambda name, s: [name, str(s["pictures"]), f"{100 * s['found']:.1f} %", out.number(s["error"] and 100 * s["error"], 2)]
    for level, r in report["levels"].items():
        rows = [row("all", r)] + [row(name, s) for key in ("by_group", "by_sex", "by_age", "by_pose", "by_pack") for name, s in r[key].items()]
        lines += [f"## {level}", ""] + out.table(["", "pictures", "found rightly", "landmark error, %"], rows)
        lines += out.prose(f"""The worst ethnic group over the mean of all: {out.number(r["worst_group_ratio"], 2)}; over the mean of those
            whose group is known, without the made faces, which are easier: {out.number(r["worst_group_ratio_among_groups"], 2)}.""")
    return "\n".join(lines)
