"""The program on rendered test sequences, whose truth is exact.

Each sequence becomes a video, with its window pasted into a camera image.
"""
import cv2
import numpy as np
import torch

from mien_training.data import head_pose
from mien_training.data import sequences as seq
from mien_training.data.expressions import CONTROLS
from mien_training.data.framing import FRAMINGS
from mien_training.evaluate import curves
from mien_training.evaluate import report as out
from mien_training.evaluate.inputs import NETWORKS, Missing
from mien_training.evaluate.program import y4m
from mien_training.paths import cache
from mien_training.phase2.decoder_scores import control_scores


def shards(network):
    """Folders of the test sequences in a network's framing."""
    found = sorted((cache() / "synthetic" / FRAMINGS[network].folder("test_sequences")).glob("shard_*"))
    if not found:
        option = "" if network == "basenet" else f" --framing {network}"
        raise Missing(
            f"no synthetic test sequences: make_synthetic.py --split test --kind sequences --count 66{option}")
    return found


def with_means(scores, supported):
    """Scores with the mean correlation over the supported controls, and the lowest of them."""
    values = [scores["correlation"][c] for c in supported]
    return {**scores, "correlation_mean": float(np.nanmean(values)), "correlation_lowest": float(np.nanmin(values))}


def camera_pictures(images, window, camera_wh):
    """Camera images RGB [n,h,w,3] of one sequence: the window where it was, around it a blur of itself."""
    width, height = (int(v) for v in camera_wh)
    pictures = np.empty((len(images), height, width, 3), np.uint8)
    for canvas, image, (cx, cy, side) in zip(pictures, images, window):
        canvas[:] = cv2.resize(cv2.blur(image, (61, 61)), (width, height))
        scale = side / len(image)
        place = np.float32([[scale, 0, cx - side / 2 + (scale - 1) / 2], [0, scale, cy - side / 2 + (scale - 1) / 2]])
        cv2.warpAffine(image, place, (width, height), canvas, cv2.INTER_LINEAR, cv2.BORDER_TRANSPARENT)
    return pictures


def field_of_view(sequences, index):
    """Horizontal, degrees, of the camera of a sequence."""
    width, f_px = sequences.label("camera_wh")[index, 0, 0], sequences.label("f_px")[index, 0]
    return float(torch.rad2deg(2 * torch.atan(width / 2 / f_px)))


def pose_errors(table, sequences, index):
    """[frames,2]: angle to the true rotation, degrees; distance from the true place, in shares of how far away that
    is."""
    truth = sequences.label("rotation")[index], sequences.label("translation")[index].numpy()
    turn = head_pose.angle_between(torch.from_numpy(curves.rotations(table)).float(), truth[0]).rad2deg().numpy()
    place = np.stack([table[f"t{axis}_m"] for axis in "xyz"], 1)
    return np.stack([turn, np.linalg.norm(place - truth[1], axis=1) / np.linalg.norm(truth[1], axis=1)], 1)


def score_program(program, lod, network):
    """The program on the test sequences; scored are those it follows from the first frame to the last."""
    sequences = seq.Sequences.load(shards(network))
    answers, faces, poses = [], [], []
    for index in range(len(sequences)):
        size = sequences.label("camera_wh")[index, 0].numpy()
        pictures = camera_pictures(sequences.images[index], sequences.label("window")[index].numpy(), size)
        table = program.track(y4m(pictures), lod, "--fov", field_of_view(sequences, index)).table
        poses.append(pose_errors(table, sequences, index))
        answers.append(np.stack([table[c] for c in CONTROLS], 1))
        faces.append(table["status"] == "tracking")
    answers, faces = np.stack(answers), np.stack(faces)
    whole = np.flatnonzero(faces.all(1))
    chosen = np.isfinite(answers[whole]).all((0, 1))
    truth = {"controls": sequences.label("controls", whole), "visible": seq.visible(sequences, whole)}
    scores = control_scores(np.nan_to_num(answers[whole]), truth, chosen)
    scores = with_means(scores, [c for c, s in zip(CONTROLS, chosen) if s])
    pose = np.stack(poses)[whole].reshape(-1, 2)
    pose = {"rotation_deg": pose[:, 0].mean(), "rotation_p95_deg": np.quantile(pose[:, 0], 0.95),
            "place_share": pose[:, 1].mean()}
    scores["pose"] = {name: float(value) for name, value in pose.items()}
    return {**scores, "sequences": len(answers), "followed_whole": len(whole), "face_share": float(faces.mean())}


def measure(setting):
    report = {}
    for name, lod in setting.levels("synthetic").items():
        try:
            report[name] = {"network": NETWORKS[name], "program": score_program(setting.program, lod, NETWORKS[name])}
        except Missing as missing:
            setting.skip(f"synthetic, {name}", missing)
    if not report:
        raise Missing("no synthetic test sequences at all")
    return report


def markdown(report):
    programs = {name: r["program"] for name, r in report.items()}
    tracked = lambda p: f"{p['followed_whole']} of {p['sequences']} sequences"
    lines = ["# Accuracy on rendered people", "", "For users who judge accuracy against exact labels.",
             ""] + out.prose(f"""The mean correlation of supported controls with the truth is
        {out.by_level(programs, lambda p: f"{p['correlation_mean']:.2f}")}. The head pose, with a known field of view,
        is off by {out.by_level(programs, lambda p: f"{p['pose']['rotation_deg']:.1f} degrees")} on average. The data
        are rendered sequences of faces, places and performances that training has not used; only those count that
        `mien track` follows from the first frame to the last, {out.by_level(programs, tracked)}. The
        [overview](README.md) has the other figures: error is the mean absolute difference, jitter the sum of absolute
        differences whose sign changes, per frame, and asymmetry is measured on symmetric expressions.""")
    return "\n".join(lines)
