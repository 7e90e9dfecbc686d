"""The program on single held-out images: portraits, rendered people, and places without a face.

An image becomes a still video, long enough for smoothing and temporal decoders to settle. Labels of portraits are
MediaPipe's, a reference and not the truth; those of rendered people are exact.
"""
from dataclasses import dataclass, field

import numpy as np
from PIL import Image

from mien_training.data import faces
from mien_training.data import landmark_points as lp
from mien_training.data.expressions import CONTROLS
from mien_training.data.proposal_data import iou
from mien_training.evaluate import curves, metrics, probe_images, skin_tone, teacher
from mien_training.evaluate import report as out
from mien_training.evaluate.inputs import Missing
from mien_training.evaluate.program import y4m
from mien_training.paths import data
from mien_training.renderer.assets import names

FRAMES = 12     # an image is shown for
PLACES = 400
YAWS = (0, 15, 30, 45, 90)
LABELS = "averaged over six views and weighted by their agreement"
TONE_YAW = 30   # degrees up to which faces count for skin tone: the pose must not speak for the skin


@dataclass
class Answers:
    """One row per image: whether the right face is detected on the first frame, and the results of the last frame."""
    found: list = field(default_factory=list)
    error: list = field(default_factory=list)      # of landmarks, in outer eye corner distances
    controls: list = field(default_factory=list)
    rotation: list = field(default_factory=list)

    def add(self, tracked, box, points):
        table = tracked.table
        boxes = np.stack([table["x"] + table["w"] / 2, table["y"] + table["h"] / 2, table["w"]], 1)
        right = [s == "tracking" and iou(b[None], box)[0] > 0.4 for s, b in zip(table["status"], boxes)]
        a, b = lp.OUTER_EYE_CORNERS
        eyes = np.linalg.norm(points[a] - points[b])
        self.found.append(right[0])
        self.error.append(metrics.point_error(tracked.landmarks[-1:], points[None], eyes)[0] if right[-1] else np.nan)
        self.controls.append([table[c][-1] if right[-1] else np.nan for c in CONTROLS])
        self.rotation.append(curves.rotations(table)[-1] if right[-1] else np.full((3, 3), np.nan))


def show(program, picture, lod, frames=FRAMES):
    return program.track(y4m(picture[None], [0] * frames), lod)


def track_all(program, levels, pictures):
    """{level: Answers} and the skin tones, of (image, box, landmarks) triples."""
    answers, tones = {name: Answers() for name in levels}, []
    for picture, box, points in pictures:
        tones.append(skin_tone.angle(skin_tone.cheeks(picture, points)))
        for name, lod in levels.items():
            answers[name].add(show(program, picture, lod), box, points)
    return answers, np.array(tones)


class Portraits:
    """The test portraits with the teacher's controls and pose."""

    def __init__(self):
        self.set = faces.Portraits("test", ("faces",))
        if not len(self.set):
            raise Missing("the portraits are absent: MIEN_DATA must name the folder of the data packs")
        self.controls = self.set.labels.controls.astype(np.float64)
        self.weight = self.set.labels.control_trust.astype(np.float64)
        self.rotation = self.set.labels.rotation.astype(np.float64)
        self.controls[:, CONTROLS.index("tongueOut")] = np.nan  # the teacher does not know of it
        self.yaw = np.degrees(np.arctan2(self.rotation[:, 0, 2], self.rotation[:, 2, 2]))

    def __iter__(self):
        for (picture, box), points in zip(self.set, self.set.points):
            yield picture, box, points


def rendered():
    """(images as of track_all, labels)."""
    images, labels = probe_images.people()
    return zip(images, labels["crop"][:, :3], labels["landmarks"].astype(np.float64)), labels


def by_group(error, groups):
    """{group: images, mean error, missed faces}, in the order of `groups`."""
    table = {}
    for name, chosen in groups.items():
        known = error[chosen][np.isfinite(error[chosen])]
        if chosen.any():
            table[name] = {"pictures": int(chosen.sum()), "lost": int(chosen.sum() - len(known)),
                           "error": out.rounded(known.mean()) if len(known) else None}
    return table


def grouped(answers, yaw, tones, trust):
    """Detection, landmark error, and both by yaw and by skin tone; trust [n] in the labels weighs the mean error."""
    error = np.array(answers.error)
    known = np.isfinite(error)
    yaws = {f"{a}-{b}": (np.abs(yaw) >= a) & (np.abs(yaw) < b) for a, b in zip(YAWS, YAWS[1:])}
    tone = np.array([skin_tone.group(t) for t in tones])
    ahead = np.abs(yaw) < TONE_YAW
    return {"pictures": len(error), "found": float(np.mean(answers.found)),
            "landmark_error_outer_eyes": float(np.average(error[known], weights=trust[known])),
            "landmark_error_p95": float(np.nanpercentile(error, 95)), "by_yaw": by_group(error, yaws),
            "by_tone": by_group(error, {g: ahead & (tone == g) for g in (*skin_tone.GROUPS, skin_tone.NO_TONE)})}


def against_teacher(answers, portraits):
    """Controls and head pose compared with the teacher's, on detected portraits."""
    known = np.isfinite(answers.error)
    ours = np.array(answers.controls)[known]
    turn = teacher.pose_difference(np.array(answers.rotation)[known], portraits.rotation[known])
    return {"pose_difference_deg": float(turn.mean()),
            "controls": teacher.compare_controls(ours, portraits.controls[known], portraits.weight[known])}


def empty_places(count, seed):
    """Pieces of held-out environments, of many sizes."""
    rng = np.random.default_rng(seed)
    pictures = [np.asarray(Image.open(data() / f"environments/{name}.jpg").convert("RGB"))
                for name in names("environments", "test")]
    for _ in range(count):
        picture = pictures[rng.integers(len(pictures))]
        side = int(np.exp(rng.uniform(np.log(120), np.log(min(picture.shape[:2])))))
        x, y = rng.integers(0, picture.shape[1] - side + 1), rng.integers(0, picture.shape[0] - side + 1)
        yield np.ascontiguousarray(picture[y:y + side, x:x + side])


def measure(setting):
    levels, portraits = setting.levels("pictures"), Portraits()
    found, tones = track_all(setting.program, levels, portraits)
    people, labels = rendered()
    drawn, drawn_tones = track_all(setting.program, levels, people)
    claimed = [(show(setting.program, p, 1, 1).table["status"] == "tracking").any() for p in empty_places(PLACES, 5)]
    report = {"places": PLACES, "false_faces": int(sum(claimed)), "levels": {}}
    for name in levels:
        report["levels"][name] = {
            "portraits": {**grouped(found[name], portraits.yaw, tones, portraits.set.labels.trust),
                          **against_teacher(found[name], portraits)},
            "rendered": grouped(drawn[name], labels["angles"][:, 0], drawn_tones, np.ones(len(drawn_tones)))}
    return report


def group_lines(levels):
    """Table by yaw: number, error at each level and faces not detected, of portraits and of rendered people."""
    percent = lambda group: out.number(group and group["error"] and 100 * group["error"], 2)
    first, rows = next(iter(levels.values())), []
    for name in {**first["portraits"]["by_yaw"], **first["rendered"]["by_yaw"]}:
        row = [name]
        for kind in ("portraits", "rendered"):
            found = [r[kind]["by_yaw"].get(name) for r in levels.values()]
            row += [str(found[0]["pictures"]) if found[0] else "-", " / ".join(map(percent, found)),
                    " / ".join(str(group["lost"]) if group else "-" for group in found)]
        rows.append(row)
    return out.table(["yaw, degrees", "portraits", "error, %", "lost", "rendered people", "error, %", "lost"], rows)


def markdown(report):
    levels = report["levels"]
    share = lambda kind: out.by_level(levels, lambda r: f"{100 * r[kind]['found']:.1f} %")
    error = lambda kind: out.by_level(levels, lambda r: f"{100 * r[kind]['landmark_error_outer_eyes']:.2f} %")
    lines = ["# Single images", "",
             "For users who track photographs, and for everyone who asks how pose and skin tone matter.",
             ""] + out.prose(f"""Detected on
        the first frame: {share("portraits")} of portraits, {share("rendered")} of rendered people. Landmark error
        relative to the distance between the outer eye corners: {error("portraits")}, on rendered people
        {error("rendered")}. mien reports a face in {report['false_faces']} of {report['places']} images without one.
        The data are held-out portraits with labels of MediaPipe, {LABELS}, and rendered test people.
        [By skin tone](../../models/README.md#by-group-of-people).""")
    lines += out.prose(f"Cells with two figures are for {' and '.join(map(out.level, levels))}; *lost*: not detected.")
    return "\n".join(lines + group_lines(levels))
