"""The program on held-out portraits in the wild, each pasted into a larger plain image.

A face is correctly detected if the mean landmark error is below a share of the distance between the pupils. Labels are
MediaPipe's, a reference and not the truth. For correctly detected people it also measures the correlation of controls
with the teacher's from person to person, by group.
"""
import numpy as np

from mien_training.data import faces
from mien_training.data import landmark_points as lp
from mien_training.data.expressions import CONTROLS
from mien_training.evaluate import metrics, teacher
from mien_training.evaluate import report as out
from mien_training.evaluate.evaluate_images import LABELS, show
from mien_training.evaluate.inputs import Missing

CANVAS = (480, 640)     # height, width
RIGHT = 0.15            # of the pupils' distance
TURNED = 50             # degrees of yaw from which goals are lower
POSES = f"yaw up to {TURNED} degrees", f"yaw beyond {TURNED} degrees"
FEWEST = 20             # images of a group worth a line
ETHNIC = ("Black", "East Asian", "Indian", "Latino Hispanic", "Middle Eastern", "Southeast Asian", "White")


def pasted(picture, rng):
    """The image somewhere on a plain canvas, and where its corner (x, y) lies."""
    canvas = np.full((*CANVAS, 3), rng.integers(40, 216, 3), np.uint8)
    x, y = (int(rng.integers(0, room - size + 1)) for room, size in zip(CANVAS[::-1], picture.shape[1::-1]))
    canvas[y:y + picture.shape[0], x:x + picture.shape[1]] = picture
    return canvas, np.array([x, y])


class Answers:
    """Results of a level of detail on the portraits."""

    def __init__(self, program, lod, portraits, seed=3):
        rng, errors, controls = np.random.default_rng(seed), [], []
        for (picture, _), points in zip(portraits, portraits.points):
            canvas, corner = pasted(picture, rng)
            tracked, truth = show(program, canvas, lod), points + corner
            pupils = np.linalg.norm(truth[lp.POSITION[lp.IRIS[0][0]]] - truth[lp.POSITION[lp.IRIS[1][0]]])
            known = tracked.table["status"][-1] == "tracking"
            errors.append(metrics.point_error(tracked.landmarks[-1:], truth[None], pupils)[0] if known else np.inf)
            controls.append([tracked.table[c][-1] for c in CONTROLS])
        # of landmarks, in pupils' distances; infinite where there is no face
        self.error = np.array(errors)
        self.controls = np.array(controls, np.float64)          # [n,52]; NaN where none is driven
        self.theirs = portraits.labels.controls.astype(np.float64)
        self.trust = portraits.labels.trust                     # [n], weights of errors
        self.control_trust = portraits.labels.control_trust     # [n,52], of correlations
        driven = np.isfinite(self.controls[np.isfinite(self.error)]).all(0)
        self.followed = np.flatnonzero(driven & (self.theirs.std(0) >= teacher.MOVES))

    def summary(self, chosen):
        """Figures of the portraits `chosen` [n]; all but the first two count correct detections only."""
        right = chosen & (self.error < RIGHT)
        figures = {"pictures": int(chosen.sum()), "found": out.rounded(right[chosen].mean())}
        if not right.any():
            return {**figures, "error": None, "correlation": None}
        error = np.average(self.error[right], weights=self.trust[right])
        correlation = metrics.correlations(*(values[right][:, self.followed] for values in
                                             (self.controls, self.theirs, self.control_trust)))
        return {**figures, "error": out.rounded(error), "correlation": out.rounded(metrics.known_mean(correlation))}

    def by(self, values, names=None, fewest=FEWEST):
        chosen = {name: np.asarray(values) == name for name in (names or sorted(set(values) - {""}))}
        return {name: self.summary(rows) for name, rows in chosen.items() if rows.sum() >= fewest}


def measure(setting):
    portraits = faces.Portraits("test", ("faces_wild",))
    if not len(portraits):
        raise Missing("the portraits in the wild are absent: MIEN_DATA must name the folder of the data packs")
    report = {"levels": {}}
    labels = portraits.labels
    turned = np.array(POSES)[(labels.yaw() > np.radians(TURNED)).astype(int)]
    for name, lod in setting.levels("wild").items():
        answers = Answers(setting.program, lod, portraits)
        groups, whole = answers.by(labels.group, ETHNIC), answers.summary(np.ones(len(portraits), bool))
        worst = max((g["error"] for g in groups.values() if g["error"]), default=float("nan"))
        known = answers.summary(np.isin(labels.group, ETHNIC))["error"]
        report["levels"][name] = {**whole, "worst_group_ratio": out.rounded(worst / whole["error"]),
                                  "worst_group_ratio_among_groups": known and out.rounded(worst / known),
                                  "by_group": groups,
                                  "by_sex": answers.by(labels.sex), "by_age": answers.by(labels.age),
                                  "by_pose": answers.by(turned, POSES, 1),
                                  "by_pack": answers.by([str(n).partition("_")[0] for n in labels.name])}
    return report


def markdown(report):
    levels = report["levels"]
    first = next(iter(levels.values()))
    lines = ["# Portraits in the wild", "", "For everyone who asks how well mien works for different people.",
             ""] + out.prose(f"""Faces correctly
        detected: {out.by_level(levels, lambda r: f"{100 * r['found']:.1f} %")}. Landmark error of the worst ethnic
        group relative to all: {out.by_level(levels, lambda r: out.number(r["worst_group_ratio"], 2))}. The
        [model card](../../models/README.md#by-group-of-people) has the figures by ethnic group, sex and age.""")
    lines += out.prose(
        f"""The data are held-out portraits, photographs and generated faces, each pasted into a plain
        image of {CANVAS[1]} x {CANVAS[0]} pixels. A correct detection has a mean landmark error below
        {100 * RIGHT:.0f} % of the distance between the pupils; the other figures cover those. Controls: mean
        correlation with MediaPipe. Labels are {LABELS}.""")
    cells = lambda s: [f"{100 * s['found']:.1f} %", out.number(s["error"] and 100 * s["error"], 2),
                       out.number(s["correlation"], 2)]
    groups = [("all", first["pictures"], list(levels.values()))]
    groups += [(name, s["pictures"], [r["by_pose"][name] for r in levels.values()])
               for name, s in first["by_pose"].items()]
    header = ["", "images", *(f"{title}, {out.level(name)}" for name in levels
                              for title in ("detected", "landmark error, %", "controls"))]
    return "\n".join(lines + out.table(
        header, [[name, str(n), *(cell for s in found for cell in cells(s))] for name, n, found in groups]))
