"""AudioNet on what was held out: phonemes, voice activity, noise, controls beside the video teacher's, lips."""
import report as out
import voice_activity
import voice_controls
import voice_phonemes
import voice_plots
from voice_model import Model

RATE, FRAMES, HOURS = "% of phonemes", "% of frames", 3600


def measure(setting):
    model = Model(*setting.checkpoint("audionet"))
    report = figures(model)
    report["sentence"] = voice_plots.sentence(model)
    return report


def figures(model):
    """Of the split of `model`; what needs no program."""
    return {"encoder_hours": model.heard / HOURS, "phonemes": voice_phonemes.measure(model), "activity": voice_activity.by_ratio(model),
            "noise": voice_activity.on_noise(model), "controls": voice_controls.measure(model)}


def markdown(report):
    lines = ["# Voice", ""] + out.prose(f"""AudioNet as models/audionet.mien has it, on people, voices and noises that it never learned
        from; its encoder has heard {report['encoder_hours']:.0f} hours of sound, the same recordings many times.""")
    lines += tables(report)
    lines += ["## A sentence", "",
              "One of the held-out clips; grey is the video teacher's jaw.", "", "![curves of a sentence](voice_sentence.png)", "",
              "![its mouth](voice_head.jpg)", ""]
    lines += out.prose("""[A face that sound alone moves](voice_head.mp4), and its mouth above, made by `scripts/evaluate/talking_head.py`:
        "To note what became of me, I had two important things before me", by a held-out reader (LibriSpeech 26-495-0047, CC BY 4.0).""")
    return "\n".join(lines)


def tables(report):
    return [*phonemes(report["phonemes"]), *activity(report["activity"]), *noise(report["noise"]), *controls(report["controls"])]


def phonemes(rates):
    rows = [[name, out.number(100 * rate, 1)] for name, rate in rates.items()]
    return ["## Phoneme error rate", "", *out.prose("""The likeliest phoneme of every step; searched: the likeliest sequence, given what four phonemes in a
                row are usual in what the training readers read (phoneme_search.py), which the tracker has no use for."""),
            *out.table(["held out", "%"], rows)]


def activity(ratios):
    rows = [[str(r), *(out.number(100 * row[k], 1) for k in ("accuracy", "found", "false")), out.number(row["area"])]
            for r, row in ratios.items()]
    return ["## Voice activity, held-out speakers in held-out noises", "",
            *out.table(["dB", "frames right %", "speech found %", "rest taken for speech %", "area under ROC"], rows),
            "![ROC](voice_roc.png)", ""]


def noise(shares):
    return ["## Noise alone", "",
            *out.table(["noise", "mouth at rest, % of the time"], [[k, out.number(100 * v, 1)] for k, v in shares.items()])]


def controls(report):
    rows = [[who, c, out.number(v["all frames"]), out.number(v["mean of clips"]), str(v["lag"])]
            for who in ("held-out clips", "other people") for c, v in report[who].items()]
    clips = [[name, out.number(v["said"]), str(v["lag"]), out.number(v["right phonemes"])] for name, v in report["clips"].items()]
    lips = [[k, out.number(100 * v, 1)] for k, v in report["lips"].items() if k != "count"]
    return (["## Controls beside the video teacher's", "", *out.table(["who", "control", "correlation", "mean of clips", "lag, frames"], rows)]
            + out.prose("""jawOpen of other people, clip by clip; beside it what the visemes of visemes.py reach from the right phonemes, where
                the text is known. More than that is not in the phonemes: these people open their jaws in their own ways.""")
            + out.table(["clip", "from sound", "lag", "from the right phonemes"], clips) + out.table(["lips", "%"], lips)
            + out.prose("""How far the mouth goes where it should, 95th percentile: the jaw on open vowels, pucker on uw and w, funnel on
                these, ow, oy and ao.""")
            + out.table(["control", "95th percentile"], [[c, out.number(v)] for c, v in report["strength"].items()]))


def plot(report, folder):
    voice_plots.roc(report["activity"], folder / "voice_roc.png")
    voice_plots.curves(report["sentence"], folder / "voice_sentence.png")
