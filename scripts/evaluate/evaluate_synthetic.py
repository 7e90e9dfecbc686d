#!/usr/bin/env python3
"""Scores on synthetic test sequences, whose truth is exact: the networks in PyTorch, or the program `mien`.

With --features (made by sequences.py --plain) the decoders of a checkpoint are scored, with --spoiled (made without --plain)
what a poor camera costs; with --mien every sequence is written as a Y4M video, its window pasted into a camera image, and the
program's curves are scored instead.
"""
import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import cv2
import numpy as np
import torch

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "train"))
import curves as tables  # noqa: E402
import metrics  # noqa: E402
import sequences as seq  # noqa: E402
import train_decoders as phase2  # noqa: E402
from expressions import CONTROLS  # noqa: E402
from networks import ControlsDecoder, PoseDecoder  # noqa: E402
from paths import ROOT  # noqa: E402

FPS = 30
LONG_LOOPS = 20  # a stream this many sequences long shows whether the state drifts


def load_decoders(path):
    checkpoint = torch.load(path)
    decoders = {"controls": ControlsDecoder(), "pose": PoseDecoder(), "frame": phase2.FrameDecoder()}
    for name, decoder in decoders.items():
        key = {"controls": "controls_decoder", "pose": "pose_decoder", "frame": "frame_decoder"}[name]
        decoder.load_state_dict(checkpoint[key])
        decoder.eval()
    return decoders, checkpoint["supported"].numpy() > 0.5


def drift(decoder, data, supported):
    """FACS error on the first and on the last sequence of one long stream of many faces."""
    every = phase2.of_stride(data, 1)
    rows = torch.arange(LONG_LOOPS * (len(every["stride"]) // LONG_LOOPS)).view(-1, LONG_LOOPS)
    with torch.no_grad():
        long = decoder(phase2.stream(every["features"], rows))[0].clamp(0, 1)
    error = (long - phase2.stream(every["controls"], rows)).abs()[..., torch.from_numpy(supported)]
    error = error.unflatten(1, (LONG_LOOPS, -1)).mean((0, 2, 3))
    return {"first": error[0].item(), "last_half": error[LONG_LOOPS // 2:].mean().item()}


def lod_error(decoders, data, supported):
    """Mean absolute difference of the controls between the encoder on alternate and on every frame."""
    out = [phase2.answers(decoders["controls"], phase2.of_stride(data, s)["features"]).clamp(0, 1) for s in (1, 2)]
    return (out[0] - out[1]).abs()[..., torch.from_numpy(supported)].mean().item()


def score_networks(features, spoiled, checkpoint):
    """The report of a decoder checkpoint on one split, as rendered and, with `spoiled`, through a poor camera."""
    data = torch.load(features)
    decoders, supported = load_decoders(checkpoint)
    report, _ = phase2.evaluate(decoders, data, supported)
    report["alternate frames"]["difference_to_every_frame"] = lod_error(decoders, data, supported)
    report["every frame"]["landmark_error"] = data["landmark_error"].mean().item()
    report["drift"] = drift(decoders["controls"], data, supported)
    if spoiled:
        report["poor camera"], _ = phase2.evaluate(decoders, torch.load(spoiled), supported)
    report["supported"] = [c for c, s in zip(CONTROLS, supported) if s]
    return report


def camera_frames(images, window, camera_wh):
    """Camera pictures BGR of one sequence: the window where it was, around it a blur of itself."""
    width, height = (int(v) for v in camera_wh)
    for image, (cx, cy, side) in zip(images, window):
        picture = cv2.cvtColor(image, cv2.COLOR_RGB2BGR)
        canvas = cv2.resize(cv2.blur(picture, (61, 61)), (width, height))
        scale = side / seq.WINDOW
        place = np.float32([[scale, 0, cx - side / 2 + (scale - 1) / 2], [0, scale, cy - side / 2 + (scale - 1) / 2]])
        cv2.warpAffine(picture, place, (width, height), canvas, cv2.INTER_LINEAR, cv2.BORDER_TRANSPARENT)
        yield canvas


def write_y4m(path, frames, camera_wh):
    """A 4:2:0 full-range video of even size."""
    width, height = (int(v) // 2 * 2 for v in camera_wh)
    with open(path, "wb") as file:
        file.write(f"YUV4MPEG2 W{width} H{height} F{FPS}:1 Ip A1:1 C420jpeg XCOLORRANGE=FULL\n".encode())
        for frame in frames:
            # OpenCV's conversion is limited range: stretch luma and chroma to the full one.
            planes = cv2.cvtColor(frame[:height, :width], cv2.COLOR_BGR2YUV_I420).astype(np.float32)
            luma = (planes[:height] - 16) * (255 / 219)
            chroma = (planes[height:] - 128) * (255 / 224) + 128
            file.write(b"FRAME\n" + np.clip(np.concatenate([luma, chroma]) + 0.5, 0, 255).astype(np.uint8).tobytes())


def run_program(program, sequences, index, folder):
    """Curves table of the program on one sequence."""
    size = sequences.label("camera_wh")[index, 0].numpy()
    video, table = folder / f"{index}.y4m", folder / f"{index}.csv"
    frames = camera_frames(sequences.images[index], sequences.label("window")[index].numpy(), size)
    write_y4m(video, frames, size)
    subprocess.run([str(program), "track", str(video), "-o", str(table), "--quiet"], check=True)
    video.unlink()
    return tables.read_table(table)


def score_program(program, shards, count):
    """Scores of the program's curves; frames without a face count as found or not, and are left out otherwise."""
    sequences = seq.Sequences.load(shards)
    folder = Path(tempfile.mkdtemp())
    answers, faces = [], []
    for index in range(min(count, len(sequences))):
        table = run_program(program, sequences, index, folder)
        answers.append(np.stack([table[c] for c in CONTROLS], 1))
        faces.append(table["status"] == "tracking")
    answers, faces = np.stack(answers), np.stack(faces)
    supported = np.isfinite(answers[faces]).all(0)
    whole = faces.all(1)  # jitter needs uninterrupted streams
    truth = sequences.label("controls")[:len(answers)].numpy()
    correlation = metrics.correlations(answers[faces][:, supported], truth[faces][:, supported])
    return {"sequences": len(answers), "face_share": float(faces.mean()), "supported": int(supported.sum()),
            "facs_error_supported": metrics.facs_error(answers[faces][:, supported], truth[faces][:, supported]),
            "constant_mean_supported": metrics.constant_errors(truth[faces][:, supported])["mean"],
            "jitter_supported": metrics.jitter(answers[whole][..., supported]) if whole.any() else None,
            "correlation": dict(zip(np.array(CONTROLS)[supported].tolist(), np.round(correlation, 3).tolist()))}


def summary(scores, supported):
    """Scores of one decoder with the correlations that matter most."""
    values = scores["correlation"]
    return {**scores, "correlation_supported": np.mean([values[c] for c in supported]), "jawOpen": values["jawOpen"],
            "eyeBlinkLeft": values["eyeBlinkLeft"], "eyeBlinkRight": values["eyeBlinkRight"]}


def markdown(report):
    """The PyTorch report as tables."""
    rows = [("FACS error, supported controls", "facs_error_supported", 1), ("the same, constant answer (mean)",
            "constant_mean_supported", 1), ("FACS error, all 52", "facs_error", 1), ("the same, constant answer (mean)",
            "constant_mean", 1), ("the same, best constant (median)", "constant_median", 1),
            ("mean correlation, supported controls", "correlation_supported", 1), ("correlation of jawOpen", "jawOpen", 1),
            ("of eyeBlinkLeft", "eyeBlinkLeft", 1), ("of eyeBlinkRight", "eyeBlinkRight", 1),
            ("asymmetry on symmetric expressions", "asymmetry", 1),
            ("jitter x 1e-4, supported controls", "jitter_supported", 1e4), ("jitter x 1e-4, all 52", "jitter", 1e4),
            ("jitter x 1e-4 of the truth", "truth_jitter", 1e4)]
    columns = {"every frame": report["every frame"]["controls"], "alternate frames": report["alternate frames"]["controls"],
               "without time, every frame": report["every frame"]["frame"]}
    if "poor camera" in report:
        columns["every frame, poor camera"] = report["poor camera"]["every frame"]["controls"]
    lines = ["# Synthetic test sequences", "", "Made by `scripts/evaluate/evaluate_synthetic.py`; faces, places and"
             " performances that training never saw.", ""]
    if "poor camera" in report:
        lines += ["As rendered, and the same pictures spoiled at the size of the crop as in training: blur, motion, lower resolution,"
                  " noise of up to 6 % in every frame, coarse JPEG, tint and contrast.", ""]
    lines += ["| | " + " | ".join(columns) + " |", "|---" * (len(columns) + 1) + "|"]
    cells = [summary(c, report["supported"]) for c in columns.values()]
    lines += [f"| {title} | " + " | ".join(f"{k * c[key]:.4g}" for c in cells) + " |" for title, key, k in rows]
    pose = [report[m]["pose"] for m in ("every frame", "alternate frames")]
    lines += ["", "| head pose | every frame | alternate frames |", "|---|---|---|"]
    lines += [f"| {key} | {pose[0][key]:.4g} | {pose[1][key]:.4g} |" for key in pose[0]]
    lines += ["", f"Landmark error {100 * report['every frame']['landmark_error']:.2f} % of the outer eye corner distance. "
              f"FACS error on the first sequence of a long stream {report['drift']['first']:.4f}, on its second half "
              f"{report['drift']['last_half']:.4f}.", "", "| control | correlation | supported |", "|---|---|---|"]
    correlation = report["every frame"]["controls"]["correlation"]
    lines += [f"| {c} | {correlation[c]:.2f} | {'yes' if c in report['supported'] else ''} |"
              for c in sorted(CONTROLS, key=lambda c: -np.nan_to_num(correlation[c], nan=-1))]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--features", type=Path, help="features of the test split")
    parser.add_argument("--spoiled", type=Path, help="features of the same through a poor camera")
    parser.add_argument("--decoders", type=Path, help="checkpoint of train_decoders.py")
    parser.add_argument("--mien", type=Path, help="the built program, scored on --shards")
    parser.add_argument("--shards", type=Path, nargs="*", default=[])
    parser.add_argument("--count", type=int, default=16, help="sequences for the program")
    parser.add_argument("--out", type=Path, default=ROOT / "docs/results")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    if args.features:
        report = score_networks(args.features, args.spoiled, args.decoders)
        (args.out / "synthetic.md").write_text(markdown(report))
        (args.out / "synthetic.json").write_text(json.dumps(report, indent=1) + "\n")
    if args.mien:
        report = score_program(args.mien, args.shards, args.count)
        (args.out / "synthetic_program.json").write_text(json.dumps(report, indent=1) + "\n")
    print(json.dumps(report, indent=1))


if __name__ == "__main__":
    main()
