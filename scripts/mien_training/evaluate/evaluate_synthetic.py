"""The networks in PyTorch and the program on rendered test sequences, whose truth is exact.

For the program each sequence becomes a video, with its window pasted into a camera image.
"""
import cv2
import numpy as np
import torch

from mien_training.data import head_pose
from mien_training.data import sequences as seq
from mien_training.data.expressions import CONTROLS
from mien_training.evaluate import curves, features
from mien_training.evaluate import report as out
from mien_training.evaluate.inputs import NETWORKS, Missing
from mien_training.evaluate.program import y4m
from mien_training.networks.architectures import ControlsDecoder, PoseDecoder
from mien_training.phase2 import train_decoders as phase2

LONG_LOOPS = 11  # a stream this many sequences long shows whether the state drifts


def load_decoders(path):
    """{name: decoder} of a checkpoint of train_decoders.py or warm_start.py, and the supported controls. HiFiNet has no
    pose, checkpoints from a model file have no decoder without time."""
    checkpoint = torch.load(path, map_location="cpu")
    kinds = {"controls": ControlsDecoder, "frame": phase2.FrameDecoder, "pose": PoseDecoder}
    decoders = {name: kind() for name, kind in kinds.items() if f"{name}_decoder" in checkpoint}
    for name, decoder in decoders.items():
        decoder.load_state_dict(checkpoint[f"{name}_decoder"])
        decoder.eval()
    return decoders, checkpoint["supported"].numpy() > 0.5


def drift(decoder, data, supported):
    """FACS error on the first sequence and on the second half of long streams of many faces."""
    every = phase2.with_stride(data, 1)
    rows = torch.arange(LONG_LOOPS * (len(every["stride"]) // LONG_LOOPS)).view(-1, LONG_LOOPS)
    with torch.no_grad():
        long = phase2.output_controls(decoder(phase2.stream(every["features"], rows))[0])
    error = (long - phase2.stream(every["controls"], rows)).abs()[..., torch.from_numpy(supported)]
    error = error.unflatten(1, (LONG_LOOPS, -1)).mean((0, 2, 3))
    return {"first": error[0].item(), "last_half": error[LONG_LOOPS // 2:].mean().item()}


def with_means(scores, supported):
    """Scores with the mean correlation over the supported controls, and the lowest of them."""
    values = [scores["correlation"][c] for c in supported]
    return {**scores, "correlation_mean": float(np.nanmean(values)), "correlation_lowest": float(np.nanmin(values))}


def score_networks(setting, network):
    """The shipped networks on the test sequences, as rendered and through a poor camera."""
    decoders, chosen = load_decoders(setting.checkpoint(network)[1])
    supported = [c for c, s in zip(CONTROLS, chosen) if s]
    data = features.of(setting, network, plain=True)
    report, _ = phase2.evaluate(decoders, data, chosen)
    spoiled, _ = phase2.evaluate(decoders, features.of(setting, network, plain=False), chosen)
    columns = {"every frame": report["every frame"]["controls"],
               "alternate frames": report["alternate frames"]["controls"],
               "poor camera": spoiled["every frame"]["controls"]}
    if "frame" in decoders:
        columns["without time"] = report["every frame"]["frame"]
    return {"supported": supported, "columns": {k: with_means(v, supported) for k, v in columns.items()},
            "pose": {mode: scores["pose"] for mode, scores in report.items() if "pose" in scores},
            "landmark_error": data["landmark_error"].mean().item(), "drift": drift(decoders["controls"], data, chosen)}


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
    sequences = seq.Sequences.load(features.shards(network))
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
    scores = phase2.control_scores(np.nan_to_num(answers[whole]), truth, chosen)
    scores = with_means(scores, [c for c, s in zip(CONTROLS, chosen) if s])
    pose = np.stack(poses)[whole].reshape(-1, 2)
    pose = {"rotation_deg": pose[:, 0].mean(), "rotation_p95_deg": np.quantile(pose[:, 0], 0.95),
            "place_share": pose[:, 1].mean()}
    scores["pose"] = {name: float(value) for name, value in pose.items()}
    return {**scores, "sequences": len(answers), "followed_whole": len(whole), "face_share": float(faces.mean())}


def measure_level(setting, name, lod):
    report, network = {"network": NETWORKS[name]}, NETWORKS[name]
    try:
        report["networks"] = score_networks(setting, network)
    except Missing as missing:
        setting.skip(f"synthetic, the networks of {name} in PyTorch", missing)
    report["program"] = score_program(setting.program, lod, network)
    return report


def measure(setting):
    torch.set_num_threads(1)
    report = {}
    for name, lod in setting.levels("synthetic").items():
        try:
            report[name] = measure_level(setting, name, lod)
        except Missing as missing:
            setting.skip(f"synthetic, {name}", missing)
    if not report:
        raise Missing("no synthetic test sequences at all")
    return report


ROWS = (("error, supported controls", "facs_error_supported", 1), ("error of the best constant",
                                                                   "constant_median_supported", 1),
        ("mean correlation, supported controls", "correlation_mean", 1), ("lowest correlation", "correlation_lowest",
                                                                          1),
        ("asymmetry on symmetric expressions", "asymmetry", 1), ("jitter x 1e-4, supported controls",
                                                                 "jitter_supported", 1e4),
        ("jitter x 1e-4 of the truth", "truth_jitter", 1e4))


def columns_of(r):
    """{title: scores} of one level."""
    shown = {k: v for k, v in r.get("networks", {"columns": {}})["columns"].items()
             if k in ("every frame", "poor camera")}
    return {"program": r["program"], **{f"networks, {k}": v for k, v in shown.items()}}


def markdown(report):
    programs = {name: r["program"] for name, r in report.items()}
    lines = ["# Accuracy on rendered people", "",
             "For users who judge accuracy against exact labels, and for trainers.", ""] + out.prose(f"""The
        mean correlation of supported controls with the truth is
        {out.by_level(programs, lambda p: f"{p['correlation_mean']:.2f}")}. The head pose, with a known field of view,
        is off by {out.by_level(programs, lambda p: f"{p['pose']['rotation_deg']:.1f} degrees")} on average. The data
        are rendered sequences of faces, places and performances that training has not seen.""")
    lines += out.prose(
        """*Program* is `mien track` with smoothing and the encoders of its level; only sequences tracked from the first
        to the last frame count. *Networks* run in PyTorch with the encoder on every frame; *poor camera* adds the
        degradations of training: blur, low resolution, noise, JPEG, tint, unusual light (`augment.py`). Error is the
        mean absolute difference. Jitter is the sum of absolute differences whose sign changes, per frame.""")
    for name, r in report.items():
        columns, program = columns_of(r), r["program"]
        lines += [f"## {out.level(name).capitalize()}: {r['network']}", ""] + out.prose(f"""The program tracked
            {100 * program['face_share']:.1f} % of the frames, and {program['followed_whole']} of {program['sequences']}
            sequences completely.""")
        cells = lambda key, scale: [out.number(scale * c[key], 4 if scale == 1 else 1) for c in columns.values()]
        lines += out.table(["", *columns], [[title, *cells(key, scale)] for title, key, scale in ROWS])
        lines += network_lines(r["networks"]) if "networks" in r else []
    return "\n".join(lines + ["[Accuracy by control](controls.md)", ""])


def network_lines(r):
    text = f"""The landmark error is {100 * r['landmark_error']:.2f} % of the distance between the outer eye corners.
        The error of controls is {r['drift']['first']:.4f} on the first sequence of a long stream and
        {r['drift']['last_half']:.4f} on its second half."""
    if r["pose"]:
        text += " The decoder's head pose is off by " + " and by ".join(
            f"{out.number(p['rotation_deg'], 2)} degrees and "
            f"{100 * p['distance_share']:.1f} % of the distance with the encoder on {mode}"
            for mode, p in r["pose"].items()) + "."
    return out.prose(text)
