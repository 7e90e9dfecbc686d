"""Amplitude of each control compared with the truth and the teacher: blinks, faces at rest, mirrored images.

Correlation does not measure these. Renders are streamed test people, portraits are the test portraits; both use the
decoders of the model files in PyTorch (stream_features.py, portrait_stream.py). Clips and probes use the program.
"""
import json
from pathlib import Path

import numpy as np
import torch

from mien_training.data.expressions import CONTROLS, INDEX, MIRROR
from mien_training.data.eyelids import closures
from mien_training.evaluate import curves, metrics, videos
from mien_training.evaluate import report as out
from mien_training.evaluate.evaluate_clips import nearest
from mien_training.evaluate.inputs import NETWORKS, Missing
from mien_training.evaluate.program import y4m
from mien_training.networks.architectures import ControlsDecoder
from mien_training.networks.warm_start import decoders_of
from mien_training.paths import cache
from mien_training.phase2 import stream_features
from mien_training.phase2.decoder_output import output_controls
from mien_training.phase2.decoder_scores import decode, with_stride

BLINKS = json.loads((Path(__file__).parent / "blinks.json").read_text())
EYES = [INDEX["eyeBlinkLeft"], INDEX["eyeBlinkRight"]]
# threshold of a detected blink; frames before and after a manually counted blink that belong to it
PASSED, FRAMES_AROUND = 0.5, 2
AT_REST, CLOSED, SMILING = 0.05, 0.9, 0.6
FEWEST = 96  # test sequences that say something about rare controls


def slopes(predicted, truth):
    """Slope of the regression of the prediction on the truth [52]; NaN where the truth is constant."""
    p, t = (a.reshape(-1, a.shape[-1]) - a.reshape(-1, a.shape[-1]).mean(0) for a in (predicted, truth))
    spread = (t * t).sum(0)
    return np.where(spread > 1e-6, (p * t).sum(0) / np.maximum(spread, 1e-6), np.nan)


def ratios(predicted, truth):
    """Standard deviation over the true one [52]."""
    p, t = (a.reshape(-1, a.shape[-1]).std(0) for a in (predicted, truth))
    return np.where(t > 1e-3, p / np.maximum(t, 1e-3), np.nan)


def by_control(**columns):
    return {c: {k: out.rounded(v[i]) for k, v in columns.items()} for i, c in enumerate(CONTROLS)}


def decoder_of(models, network):
    known, decoder = decoders_of(models / f"{network}.mien"), ControlsDecoder()
    decoder.load_state_dict(known["controls_decoder"])
    return decoder.eval(), known["supported"].numpy() > 0.5


def streamed(kind, network):
    folder = cache() / "stream" / kind
    if not list(folder.glob("*.pt")):
        raise Missing(f"no streamed {kind}: stream_features.py and portrait_stream.py make them (docs/training.md)")
    return stream_features.load(folder, network)


def on_renders(decoder, network):
    data = with_stride(streamed("test", network), 1)
    if len(data["features"]) < FEWEST:
        raise Missing(
            f"only {len(data['features'])} streamed test sequences of {FEWEST}: stream_features.py --split test "
            f"--count {FEWEST}")
    told, truth = output_controls(decode(decoder, data["features"])).numpy(), data["controls"].float().numpy()
    rest = told[truth.max(-1) < AT_REST]
    return {"sequences": len(told), "controls": by_control(slope=slopes(told, truth), ratio=ratios(told, truth)),
            "at_rest": by_control(mean=rest.mean(0) if len(rest) else np.full(len(CONTROLS), np.nan)),
            "frames_at_rest": len(rest)}


def on_portraits(decoder, network):
    data = streamed("portraits_test", network)
    told = output_controls(decode(decoder, data["features"])[:, -1]).numpy()
    theirs, closed = data["controls"][:, -1].float().numpy(), closures(data["points"][:, -1].float()).numpy()
    watched = theirs[:, [INDEX[n] for n in ("jawOpen", "mouthSmileLeft", "mouthSmileRight", "mouthPucker")]]
    neutral = (watched.max(1) < 0.1) & (closed.max(1) < 0.1)
    smiles = told[:, INDEX["mouthSmileLeft"]][theirs[:, INDEX["mouthSmileLeft"]] >= SMILING]
    return {"portraits": len(told), "closed": float(told[:, EYES][closed > CLOSED].mean()),
            "eyes": int((closed > CLOSED).sum()),
            "smile": float(np.median(smiles)), "smiles": len(smiles), "neutral": int(neutral.sum()),
            "neutral_largest": float(told[neutral].mean(0).max()), "neutral_mean": float(told[neutral].mean())}


def tracked(program, clip, lod, labels):
    """Controls [frames,52] on the teacher's frames."""
    table = program.track(clip, lod).table
    return np.stack([table[c] for c in CONTROLS], 1)[nearest(table["t_ms"], labels.t_ms)]


def mirrored(program, clip, lod):
    """Controls [frames,52] of a clip, and of the mirrored clip mirrored back, each without its mean; on frames where
    both have a face."""
    frames = videos.frames(clip)
    tables = [program.track(y4m(np.ascontiguousarray(shown_as)), lod).table
              for shown_as in (frames, frames[:, :, ::-1])]
    straight, flipped = (np.stack([table[c] for c in CONTROLS], 1) for table in tables)
    flipped = flipped[:, MIRROR]
    both = np.isfinite(straight[:, INDEX["jawOpen"]]) & np.isfinite(flipped[:, INDEX["jawOpen"]])
    return straight[both] - straight[both].mean(0), flipped[both] - flipped[both].mean(0)


def blinks_of(curve, counted):
    """Peaks of the blinks counted by eye, and how many rise above PASSED elsewhere; curve [frames] is the mean of both
    eyes."""
    near = np.zeros(len(curve), bool)
    peaks = []
    for first, last in counted:
        span = slice(max(first - FRAMES_AROUND, 0), last + FRAMES_AROUND + 1)
        near[span] = True
        peaks.append(float(np.nanmax(curve[span])))
    above = (np.nan_to_num(curve) > PASSED) & ~near
    return peaks, int((np.diff(above.astype(int), prepend=0) == 1).sum())


def on_clips(program, lod):
    ours, theirs, again, peaks, false, teacher_peaks = [], [], [], [], 0, []
    for clip in videos.clips():
        labels = curves.Teacher(videos.labels_of(clip), CONTROLS)
        told = tracked(program, clip, lod, labels)
        seen = labels.found & np.isfinite(told[:, INDEX["jawOpen"]])
        ours.append(told[seen] - told[seen].mean(0))
        theirs.append(labels.controls[seen] - labels.controls[seen].mean(0))
        again.append(mirrored(program, clip, lod))
        if clip.stem in BLINKS:
            found, wrong = blinks_of(told[:, EYES].mean(1), BLINKS[clip.stem])
            peaks, false = peaks + found, false + wrong
            teacher_peaks += blinks_of(labels.controls[:, EYES].mean(1), BLINKS[clip.stem])[0]
    ours, theirs = np.concatenate(ours), np.concatenate(theirs)
    straight, flipped = (np.concatenate(x) for x in zip(*again))
    return {"controls": by_control(slope=slopes(ours, theirs), ratio=ratios(ours, theirs), moves=theirs.std(0)),
            "mirrored": by_control(correlation=metrics.correlations(flipped, straight)),
            "blinks": {"peaks": out.rounded(peaks, 3), "false": false, "teacher": out.rounded(teacher_peaks, 3)}}


def measure(setting):
    torch.set_num_threads(1)
    videos.clips()
    results = {}
    for name, lod in setting.levels("amplitude").items():
        decoder, supported = decoder_of(setting.program.models, NETWORKS[name])
        results[name] = {"supported": [c for c, s in zip(CONTROLS, supported) if s],
                         "clips": on_clips(setting.program, lod)}
        for part, look in (("renders", on_renders), ("portraits", on_portraits)):
            try:
                results[name][part] = look(decoder, NETWORKS[name])
            except Missing as missing:
                setting.skip(f"amplitude, {part}, {name}", missing)
    return results


def summary(r):
    """Rows of (what, figure)."""
    peaks = np.array(r["clips"]["blinks"]["peaks"])
    rows = [["blinks whose eyeBlink exceeds 0.5", f"{(peaks > PASSED).sum()} of {len(peaks)}"]]
    if "portraits" in r:
        p = r["portraits"]
        rows += [[f"median mouthSmile of {p['smiles']} broad smiles on portraits", out.number(p["smile"], 2)]]
    if "renders" in r:
        values = [v["ratio"] for c, v in r["renders"]["controls"].items() if c in r["supported"]]
        rows += [["rendered people: median deviation of supported controls", out.number(np.median(values), 2)],
                 ["supported controls within 0.8 to 1.25",
                  f"{sum(0.8 <= v <= 1.25 for v in values)} of {len(values)}"]]
    gaze = [r["clips"]["mirrored"][c]["correlation"] for c in CONTROLS if c.startswith(("eyeLookIn", "eyeLookOut"))]
    return rows + [["mirrored clips: correlation of sideways gaze with itself",
                    out.number(metrics.known_mean(gaze), 2)]]


def markdown(report):
    peak = lambda r: f"{np.mean(r['clips']['blinks']['peaks']):.2f}"
    lines = ["# Amplitude", "", "For users who find that faces move too little, and for trainers.",
             ""] + out.prose(f"""The mean peak of eyeBlink in
        {len(next(iter(report.values()))['clips']['blinks']['peaks'])} blinks is {out.by_level(report, peak)}; MediaPipe
        reaches {np.mean(next(iter(report.values()))['clips']['blinks']['teacher']):.2f}. The data are the
        [clips](clips.md), held-out portraits, and rendered test people with known controls. The
        [overview](README.md) has the other figures.""")
    lines += out.prose(
        f"""Blinks were counted by eye (`models/training/mien_training/evaluate/blinks.json`); a peak is the highest
        mean of both eyes within {FRAMES_AROUND} frames of a blink. Closed eyes have an aperture below 0.09 of their
        width. Deviation: standard deviation relative to the truth's.""")
    rows = [[rows[0][0], *(row[1] for row in rows)] for rows in zip(*(summary(r) for r in report.values()))]
    lines += out.table(["figure", *map(out.level, report)], rows)
    return "\n".join(lines)
