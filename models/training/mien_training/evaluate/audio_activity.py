"""Voice activity on held-out speakers in held-out noises by signal-to-noise ratio, and on noise alone."""
import numpy as np

from mien_training.audio import activity, corpus, effects
from mien_training.audio.features import RATE
from mien_training.evaluate import metrics

RATIOS = [None, 20, 10, 5, 0, -5]
PAUSE = 1.0          # seconds of silence around every utterance
REST = 0.1           # a mouth at rest has no control above it
SCENES = 80


def utterances():
    """Held-out speech, each with silence around it, and when it is speech."""
    for name in ("librispeech", "commands"):
        group = corpus.Group(name)
        for sound in group.of("test")[:SCENES // 2]:
            speech = effects.at_level(np.float32(group.samples(sound)[:8 * RATE]) / 32768, -23)
            silence = np.zeros(int(PAUSE * RATE), np.float32)
            yield np.concatenate([silence, speech, silence])


def roc(scores, truth, points=60):
    """Shares of the rest taken for speech and of speech found, at thresholds from 1 to 0."""
    thresholds = np.quantile(scores, np.linspace(1, 0, points))
    share = lambda rows: [round(float((rows >= t).mean()), 4) for t in thresholds]
    return {"false": share(scores[~truth]), "found": share(scores[truth])}


def heard(ratio, seed=1):
    """Held-out speech in held-out noise at `ratio` dB, None for clean; and of each window whether it is speech."""
    rng = np.random.default_rng(seed)
    for sound in utterances():
        mixed = sound if ratio is None else effects.mixed(sound, effects.recorded_noise(rng, "test", len(sound)), ratio)
        yield np.clip(mixed, -1, 1), activity.of_windows(sound)


def by_ratio(model):
    """{ratio: accuracy, area under ROC, share of speech found, share of the rest taken for speech}"""
    report = {}
    for ratio in RATIOS:
        scores, truth = [], []
        for sound, active in heard(ratio):
            times, _, alpha = model(sound)
            scores.append(alpha)
            truth.append(activity.at(active, times))
        scores, truth = np.concatenate(scores), np.concatenate(truth)
        active = scores > 0.5
        report["clean" if ratio is None else ratio] = {
            "accuracy": float((active == truth).mean()), "area": float(metrics.area_under_roc(scores, truth)),
            "found": float(active[truth].mean()), "false": float(active[~truth].mean()), "roc": roc(scores, truth)}
    return report


def kind(name):
    return name.split("_", 1)[1].rsplit("_", 1)[0] if name.startswith("esc10") else name


def on_noise(model):
    """Share of the time in which the mouth rests, over all noise that was held out and by its kind."""
    group, rows = corpus.Group("noise"), {}
    for sound in group.of("test"):
        _, controls, alpha = model(np.float32(group.samples(sound)) / 32768)
        rows.setdefault(kind(sound.name), []).append((controls * alpha[:, None]).max(1) < REST)
    report = {k: float(np.concatenate(v).mean()) for k, v in rows.items()}
    clips = [r.mean() for v in rows.values() for r in v]
    return {"all": float(np.concatenate([r for v in rows.values() for r in v]).mean()),
            "clips that rest 95 % of the time": float(np.mean(np.array(clips) >= 0.95)), **report}
