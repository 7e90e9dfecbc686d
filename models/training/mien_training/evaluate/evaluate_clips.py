"""The program on clips of real people compared with MediaPipe Face Landmarker, frame by frame.

Controls are compared within a clip (the mean of each clip is removed), because levels differ between people.
"""
import numpy as np

from mien_training.data.expressions import CONTROLS
from mien_training.evaluate import curves, metrics, teacher, videos
from mien_training.evaluate import report as out

STILL_STEP, STILL_FRAMES = 0.003, 6


def nearest(t_ms, wanted):
    """Index into t_ms of the time nearest to each wanted one."""
    return np.abs(np.asarray(t_ms)[None] - np.asarray(wanted)[:, None]).argmin(1)


def compare(tracked, labels, size_wh):
    """Numbers of one clip; (ours, theirs) controls on common frames, each without its mean; (ours, theirs) of still
    stretches."""
    table = tracked.table
    rows = nearest(table["t_ms"], labels.t_ms)
    points, eyes, pupils = labels.points(size_wh)
    face = table["status"][rows] == "tracking"
    both = face & labels.found
    result = {"frames": len(rows), "face_share": float(face[labels.found].mean())}
    if not both.any():
        return result, None, []
    error = metrics.point_error(tracked.landmarks[rows][both], points[both], 1)
    turn = teacher.pose_difference(curves.rotations(table)[rows][both], labels.rotation[both])
    result.update(landmark_error_outer_eyes=float((error / eyes[both]).mean()),
                  landmark_error_pupils=float((error / pupils[both]).mean()), pose_difference_deg=float(turn.mean()))
    ours, theirs = np.stack([table[c] for c in CONTROLS], 1)[rows], labels.controls
    still = [(ours[s], theirs[s]) for s in metrics.still_stretches(points, eyes, STILL_STEP, STILL_FRAMES)
             if both[s].all()]
    result["still_frames"] = sum(len(o) for o, _ in still)
    centred = lambda values: values[both] - values[both].mean(0)
    return result, (centred(ours), centred(theirs)), still


def still_jitter(pieces, rows):
    """Jitter of ours and of MediaPipe's on still stretches, over the controls that MediaPipe moves and we drive."""
    chosen = [CONTROLS.index(c) for c, r in rows.items()
              if r["spread"] >= teacher.MOVES and r["correlation"] is not None]
    joined = [np.concatenate([p[k][:, chosen] for p in pieces]) for k in (0, 1)]
    ends = np.cumsum([len(p[0]) for p in pieces])
    stretches = [slice(e - len(p[0]), e) for e, p in zip(ends, pieces)]
    return [metrics.jitter_of_stretches(values, stretches) for values in joined]


def overall(results):
    """Means over all frames of all clips."""
    total = {key: sum(r.get(key, 0) for r in results.values()) for key in ("frames", "still_frames")}
    for key in ("face_share", "landmark_error_outer_eyes", "landmark_error_pupils", "pose_difference_deg"):
        pairs = [(r[key], r["frames"]) for r in results.values() if key in r]
        total[key] = float(np.average([v for v, _ in pairs], weights=[n for _, n in pairs]))
    return total


def measure_level(program, lod):
    results, pairs, still = {}, [], []
    for clip in videos.clips():
        labels = curves.Teacher(videos.labels_of(clip), CONTROLS)
        results[clip.stem], pair, pieces = compare(program.track(clip, lod), labels, videos.size(clip))
        pairs += [pair] if pair else []
        still += pieces
    ours, theirs = (np.concatenate(p) for p in zip(*pairs))
    controls = teacher.compare_controls(ours, theirs)
    jitter, teacher_jitter = still_jitter(still, controls)
    return {"clips": results,
            "all": {**overall(results), "still_jitter": jitter, "teacher_still_jitter": teacher_jitter},
            "controls": controls}


def measure(setting):
    videos.clips()
    return {name: measure_level(setting.program, lod) for name, lod in setting.levels("clips").items()}


def markdown(report):
    jitter = lambda r: (f"{1e4 * r['all']['still_jitter']:.1f}e-4 (MediaPipe: "
                        f"{1e4 * r['all']['teacher_still_jitter']:.1f}e-4)")
    total = lambda r: (f"{100 * r['all']['landmark_error_pupils']:.1f} % of the distance between the pupils, "
                       f"{r['all']['pose_difference_deg']:.1f} degrees")
    first = next(iter(report.values()))
    lines = ["# Clips of real people", "",
             "For users who compare mien with MediaPipe Face Landmarker, and for trainers.", ""] + out.prose(f"""Mean
        difference from MediaPipe in landmarks and head pose: {out.by_level(report, total)}. The data are
        {len(first['clips'])} clips with {first['all']['frames']} frames, which were not used for training. MediaPipe is
        a reference, not the truth. Pose is the mean angle after removal of the best constant rotation. Jitter while
        MediaPipe's landmarks rest: {out.by_level(report, jitter)}.""")
    return "\n".join(lines)
