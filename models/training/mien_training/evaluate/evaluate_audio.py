"""AudioNet on held-out data: voice activity, noise, controls compared with the video teacher's, lips."""
from mien_training.evaluate import audio_activity, audio_controls, audio_jaw, audio_plots
from mien_training.evaluate import report as out
from mien_training.evaluate.audio_model import StoredModel
from mien_training.evaluate.inputs import Missing
from mien_training.networks import weight_reader


def measure(setting):
    path = setting.program.models / "audionet.mien"
    if not path.exists():
        raise Missing(f"AudioNet is not trained yet: {path.name} is absent")
    model = StoredModel(path)
    return {"encoder_hours": int(weight_reader.metadata(path)["encoder_seconds"]) / 3600,
            "activity": audio_activity.by_ratio(model), "noise": audio_activity.on_noise(model),
            "controls": audio_controls.measure(model), "jaw": audio_jaw.measure(model),
            "sentence": audio_plots.sentence(model)}


def markdown(report):
    jaw, others = (report["controls"][who]["jawOpen"] for who in ("held-out clips", "other people"))
    at_20 = next(row for ratio, row in report["activity"].items() if str(ratio) == "20")
    lines = ["# Audio", "", "For users who animate a mouth from audio.", ""] + out.prose(f"""Voice activity is right on
        {100 * at_20['accuracy']:.0f} % of frames at a signal-to-noise ratio of 20 dB. jawOpen correlates with MediaPipe
        by {jaw['all frames']:.2f} on held-out clips of the speaker of its training, but by
        {others['mean of clips']:.2f} on other people. The data are speakers, voices and noises that training
        has not used; the encoder was trained on {report['encoder_hours']:.0f} hours of audio, with repetitions.""")
    lines += [*activity(report["activity"]), *noise(report["noise"]), *controls(report["controls"])]
    lines += audio_jaw.markdown(report["jaw"])
    return "\n".join([*lines, "![A sentence of a held-out clip; MediaPipe's jaw is grey](audio_sentence.png)", ""])


def activity(ratios):
    rows = [[str(r), *(out.number(100 * row[k], 1) for k in ("accuracy", "found", "false"))]
            for r, row in ratios.items()]
    return ["## Voice activity", "",
            *out.table(["dB", "frames right, %", "speech found, %", "silence taken for speech, %"], rows),
            "![ROC](audio_roc.png)", ""]


def noise(shares):
    worst, name = min((v, k) for k, v in shares.items() if k not in ("all", "clips that rest 95 % of the time"))
    return out.prose(f"""On noise alone the mouth rests {100 * shares['all']:.1f} % of the time, in the worst noise
        ({name}) {100 * worst:.1f} %.""")


def controls(report):
    columns = ("held-out clips", "other people")
    rows = [[c, *(out.number(report[who][c]["mean of clips"], 2) for who in columns)] for c in report["held-out clips"]]
    lips = ", ".join(f"{k} {out.number(100 * v, 1)} %" for k, v in report["lips"].items() if k != "count")
    return ["## Controls", "", "Mean correlation with MediaPipe over clips.", "",
            *out.table(["control", *columns], rows), *out.prose(f"Lips of synthetic voices: {lips}.")]


def plot(report, folder):
    audio_plots.roc(report["activity"], folder / "audio_roc.png")
    audio_plots.curves(report["sentence"], folder / "audio_sentence.png")
