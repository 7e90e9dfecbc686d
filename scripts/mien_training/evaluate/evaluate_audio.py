"""AudioNet on held-out data: phonemes, voice activity, noise, controls compared with the video teacher's, lips."""
import hashlib
import json

from mien_training.evaluate import audio_activity, audio_controls, audio_jaw, audio_phonemes, audio_plots
from mien_training.evaluate import report as out
from mien_training.evaluate.audio_model import StoredModel
from mien_training.evaluate.inputs import Missing
from mien_training.networks import weight_reader

RATE, FRAMES, HOURS = "% of phonemes", "% of frames", 3600
KEPT = ("encoder_hours", "phonemes", "activity")  # depend on the networks of digest() only


def measure(setting):
    """Without the checkpoints, earlier figures are kept if they are those of the same networks."""
    path = setting.program.models / "audionet.mien"
    if not path.exists():
        raise Missing(f"AudioNet is not trained yet: {path.name} is absent")
    networks = digest(path)
    timed = None
    try:
        model = StoredModel(path, setting.checkpoint("audionet"))
        report = figures(model)
    except Missing as missing:
        earlier, model = earlier_results(setting.out, networks, missing), StoredModel(path)
        report, timed = {name: earlier[name] for name in KEPT} | of_controls(model), earlier["sentence"]["phonemes"]
        for name, row in report["controls"]["clips"].items():
            row["right phonemes"] = earlier["controls"]["clips"][name]["right phonemes"]
    return report | {"networks": networks, "jaw": audio_jaw.measure(model),
                     "sentence": audio_plots.sentence(model, timed)}


def digest(path):
    """SHA-256 of the weights of the encoder and of the decoder of voice activity."""
    networks = weight_reader.networks(path)
    layers = [layer for name in ("encoder", "activity_decoder") for layer in networks[name] if layer.weight is not None]
    values = b"".join(v.numpy().tobytes() for layer in layers for v in (layer.weight, layer.bias))
    return hashlib.sha256(values).hexdigest()


def earlier_results(folder, networks, missing):
    path = folder / "audio.json"
    results = json.loads(path.read_text())["results"] if path.exists() else {}
    if results.get("networks") != networks:
        raise missing
    return results


def of_controls(model):
    return {"noise": audio_activity.on_noise(model), "controls": audio_controls.measure(model)}


def figures(model):
    """Figures on the split of `model` that do not need the program."""
    return {"encoder_hours": model.heard / HOURS, "phonemes": audio_phonemes.measure(model),
            "activity": audio_activity.by_ratio(model)} | of_controls(model)


def markdown(report):
    rates, jaw = report["phonemes"], report["controls"]["held-out clips"]["jawOpen"]
    lines = ["# Audio", "", "For users who animate a mouth from audio, and for trainers.",
             ""] + out.prose(f"""AudioNet recognizes
        {100 - 100 * rates['real speech']:.0f} % of the phonemes of real speech. Voice activity is right on
        {100 * report['activity'].get('20',
        report['activity'].get(20))['accuracy']:.0f} % of frames at 20 dB. On noise alone the mouth rests {100 *
        report['noise']['all']:.0f} % of the time. jawOpen correlates
        with MediaPipe by {jaw['all frames']:.2f} on held-out clips of the speaker of its training, but by
        {report['controls']['other people']['jawOpen']['mean of clips']:.2f} on other people. The data are speakers,
        voices and noises that training has not used; the encoder was trained on {report['encoder_hours']:.0f} hours of
        audio, with repetitions.""")
    lines += tables(report) + audio_jaw.markdown(report["jaw"])
    lines += ["## A sentence", "", "A held-out clip; MediaPipe's jaw is grey.", "",
                               "![Curves of a sentence](audio_sentence.png)", "", "![Its mouth](speech_head.jpg)", ""]
    lines += out.prose(
        """[A face animated from audio](speech_head.mp4), and its mouth above, made by
        `mien_training.evaluate.render_speech`: "To note what became of me, I had two important things before me", by a
        held-out reader (LibriSpeech 26-495-0047, CC BY 4.0).""")
    return "\n".join(lines)


def tables(report):
    return [*phonemes(report["phonemes"]), *activity(report["activity"]), *noise(report["noise"]),
            *controls(report["controls"])]


def phonemes(rates):
    rows = [[name, out.number(100 * rate, 1)] for name, rate in rates.items()]
    return ["## Phoneme error rate", "",
            *out.prose("""The most likely phoneme of each step. With n-grams: the most likely sequence, given frequent
                sequences of four phonemes in the training texts (`phoneme_search.py`), which the tracker does not
                use."""),
            *out.table(["held out", "%"], rows)]


def activity(ratios):
    rows = [[str(r), *(out.number(100 * row[k], 1) for k in ("accuracy", "found", "false")), out.number(row["area"])]
            for r, row in ratios.items()]
    return ["## Voice activity", "",
            *out.table(["signal-to-noise ratio, dB", "frames right, %", "speech found, %",
                        "silence taken for speech, %", "area under ROC"], rows),
            "![ROC](audio_roc.png)", ""]


def noise(shares):
    worst = sorted((v, k) for k, v in shares.items() if k not in ("all", "clips that rest 95 % of the time") and v < 1)
    return ["## Noise alone", "", *out.prose("Share of the time with the mouth at rest: " + ", ".join(
        f"{k} {out.number(100 * v, 1)} %" for k, v in [("all", shares["all"]), *((name, v) for v, name in worst)])
                                             + "; other noises 100 %.")]


def controls(report):
    rows = [[c, *(cell for who in ("held-out clips", "other people") for v in [report[who][c]] for cell in (
        out.number(v["all frames"], 2), out.number(v["mean of clips"], 2), str(v["lag"])))]
            for c in report["held-out clips"]]
    clips = [[name, out.number(v["said"], 2), str(v["lag"]), out.number(v["right phonemes"], 2)]
             for name, v in report["clips"].items()]
    lips = ", ".join(f"{k} {out.number(100 * v, 1)} %" for k, v in report["lips"].items() if k != "count")
    strength = ", ".join(f"{c} {out.number(v, 2)}" for c, v in report["strength"].items())
    columns = [f"{title}, {who}" for who in ("held-out clips", "other people")
               for title in ("correlation", "mean of clips", "lag, frames")]
    return (["## Controls compared with MediaPipe", "", *out.table(["control", *columns], rows)]
            + out.prose(
                """jawOpen of other people by clip, beside the curve from the correct phonemes where the text is known.
                Phonemes do not contain more than that: people open their jaws differently.""")
            + out.table(["clip", "from audio", "lag, frames", "from correct phonemes"], clips)
            + out.prose(
                f"""Lips: {lips}. 95th percentile where the control is expected, the jaw on open vowels, pucker on uw
                and w, funnel on these and on ow, oy and ao: {strength}."""))


def plot(report, folder):
    audio_plots.roc(report["activity"], folder / "audio_roc.png")
    audio_plots.curves(report["sentence"], folder / "audio_sentence.png")
