"""Plots of the controls of the mouth from audio."""
import numpy as np

from mien_training.audio import corpus, labels, phonemes, teacher
from mien_training.evaluate import report as out
from mien_training.evaluate.audio_model import INDEX

SHOWN = ["jawOpen", "mouthClose", "mouthPucker", "mouthFunnel", "mouthStretchLeft"]


def sentence(model):
    """The first held-out clip: curves, the teacher's jaw, and the aligned phonemes with times."""
    group, curves = corpus.Group("av"), teacher.clips()
    sound = next(s for s in group.of("test") if s.name in curves)
    times, controls, alpha = model(np.float32(group.samples(sound)) / 32768)
    jaw = curves[sound.name][:, INDEX["jawOpen"]]
    return {"clip": sound.name, "times": out.rounded(times, 3), "alpha": out.rounded(alpha, 3),
            "teacher": out.rounded(jaw, 3), "controls": {c: out.rounded(controls[:, INDEX[c]], 3) for c in SHOWN},
            "phonemes": timed_phonemes(labels.read("av").get(sound.name, labels.Spoken([], [], 0)))}


def timed_phonemes(spoken):
    return [[phonemes.NAMES[p], round(float(t), 3)] for p, t in zip(spoken.labels, spoken.starts)]


def curves(said, path):
    figure, axes = out.plt.subplots(figsize=(11, 3.6))
    axes.fill_between(np.arange(len(said["teacher"])) / teacher.FPS, said["teacher"], color="0.85",
                      label="jawOpen, video teacher")
    for control, values in said["controls"].items():
        axes.plot(said["times"], values, label=control, linewidth=1.3)
    axes.plot(said["times"], said["alpha"], ":", color="black", linewidth=1, label="voice activity")
    for name, start in said["phonemes"]:
        axes.axvline(start, color="0.9", linewidth=0.5)
        axes.text(start, 1.03, name if name != "sil" else "", fontsize=7)
    axes.set(xlabel="seconds", ylim=(0, 1.1), xlim=(0, said["times"][-1]))
    axes.legend(fontsize=7, ncol=3, loc="upper left", bbox_to_anchor=(0, -0.14))
    out.save(figure, path)


def roc(ratios, path):
    figure, axes = out.plt.subplots(figsize=(4.2, 4))
    for ratio, row in ratios.items():
        axes.plot(row["roc"]["false"], row["roc"]["found"], label="clean" if ratio == "clean" else f"{ratio} dB",
                  linewidth=1.2)
    axes.set(xlabel="rest taken for speech", ylabel="speech found", xlim=(0, 0.5), ylim=(0.5, 1))
    axes.legend(fontsize=8)
    out.save(figure, path)
