"""How far one can get at all: the controls decoder, given true landmarks and head pose instead of a picture, trained as ours is.

A control that this answers and ours does not is lost by the encoder; one that neither answers is not in where points are.
"""
import json

import numpy as np
import torch

import features
import metrics
import report as out
import train_decoders as phase2
from expressions import CONTROLS
from face_data import to_crop
from framing import HIFINET
from networks import LANDMARKS, POSE, ControlsDecoder
from paths import cache
from sequences import Sequences, landmark_error, targets, template
from setting import Missing

KNOWN = 2 * LANDMARKS + POSE
STILLS = 10  # shards
ARGUMENTS = phase2.arguments(steps=900, velocity=0.35, acceleration=0.1, noise=0.02)


def shards(kind):
    found = sorted((cache() / "synthetic" / HIFINET.folder(kind)).glob("shard_*"))
    if not found:
        raise Missing(f"no {HIFINET.folder(kind)}: render them with make_synthetic.py --framing hifinet (docs/training.md)")
    return found


def true_points(sequences):
    """What sequences.extract makes of pictures, with the truth in place of features: f16 [s,frames,KNOWN]."""
    rows = torch.arange(len(sequences))
    crops, points = sequences.label("crop", rows), sequences.label("landmarks", rows)
    inside = to_crop(crops.flatten(0, 1), points.flatten(0, 1)).view_as(points)
    found = targets(sequences, rows, crops, mirror=False)
    known = torch.cat([(inside - template()).flatten(2), found["pose"]], -1)
    return {"features": known.half(), "stride": torch.ones(len(rows)), "landmark_error": landmark_error(points, points), **found}


def trained():
    moving = phase2.Moving(true_points(Sequences.load(shards("train_sequences"))), ARGUMENTS)
    held = phase2.Held(true_points(Sequences.load(shards("train_stills")[:STILLS]).held(2)), ARGUMENTS)
    task = phase2.ControlsTask(moving.data, ARGUMENTS)
    return phase2.train(ControlsDecoder(KNOWN), [(moving, task), (held, task)], ARGUMENTS, "controls")


def ours(setting):
    """{level: {control: correlation}} of the part `synthetic`, where it was measured."""
    path = setting.out / "synthetic.json"
    results = json.loads(path.read_text())["results"] if path.exists() else {}
    return {level: r["program"]["correlation"] for level, r in results.items()}


def measure(setting):
    data = true_points(Sequences.load(features.shards(HIFINET.name)))
    curves = phase2.shown(phase2.answers(trained(), data["features"])).numpy()
    truth, seen = data["controls"].float().numpy(), data["visible"].float().numpy()
    values = metrics.correlations(curves, truth, seen)
    return {"sequences": len(curves), "facs_error": metrics.facs_error(curves, truth),
            "constant_median": metrics.constant_errors(truth)["median"],
            "correlation": dict(zip(CONTROLS, out.rounded(values))), "ours": ours(setting)}


def markdown(report):
    levels, known = report["ours"], report["correlation"]
    number = lambda value: out.number(np.nan if value is None else value)
    rows = [[c, number(known[c]), *(number(of.get(c)) for of in levels.values())] for c in sorted(known, key=known.get, reverse=True)]
    enough = sum(v >= 0.5 for v in known.values())
    return "\n".join(["# How far one can get", ""] + out.prose(f"""A controls decoder that is given the true 175 landmarks and the true head
        pose of {report["sequences"]} rendered test sequences, instead of a picture, and was trained as ours is, on the same people;
        beside it what the program answers to pictures of them ([synthetic](synthetic.md)). A dash: not supported. From true
        landmarks the mean correlation of all 52 is {np.mean(list(known.values())):.2f}, and {enough} of them reach 0.5; the error is
        {report["facs_error"] / report["constant_median"]:.2f} times the best constant's. Where even this fails, points do not tell:
        lips that press, corners that dimple, a jaw that comes forward look like another face at rest.""")
        + out.table(["control", "from true landmarks", *(f"{level}, from pictures" for level in levels)], rows))
