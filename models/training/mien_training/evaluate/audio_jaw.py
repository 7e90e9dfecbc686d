"""jawOpen of people never seen in training: at lag 0, at the best lag, and for the audio of other clips."""
import numpy as np

from mien_training.audio import corpus, jaw_data, teacher
from mien_training.audio.audio_net import JAW
from mien_training.evaluate import audio_controls
from mien_training.evaluate import report as out

LAGS = range(-8, 9)   # video frames; positive where the audio is late
DRAWS = 200           # of mismatched audio, for each clip
MISMATCHED = ("chance", "chance, 95th percentile")


def shifted(predicted, truth, lag):
    """Correlation with `predicted` moved back by `lag` frames."""
    late, early = max(lag, 0), max(-lag, 0)
    return audio_controls.correlation(predicted[late:len(predicted) - early], truth[early:len(truth) - late])


def best(predicted, truth):
    """(correlation, lag) at the lag where the curves agree best."""
    return max((shifted(predicted, truth, lag), lag) for lag in LAGS)


def mismatched(rng, others, count):
    """Outputs for the audio of other clips in random order, `count` frames."""
    parts = [others[k] for k in rng.permutation(len(others))]
    return np.concatenate(parts)[:count]


def beside_chance(predicted, truth, others, seed=1):
    """Figures of one clip; `others`: outputs for the audio of other clips."""
    rng = np.random.default_rng(seed)
    chance = np.array([best(mismatched(rng, others, len(truth)), truth)[0] for _ in range(DRAWS)])
    value, lag = best(predicted, truth)
    figures = dict(zip(MISMATCHED, (float(chance.mean()), float(np.percentile(chance, 95)))))
    return figures | {"lag 0": shifted(predicted, truth, 0), "best": value, "lag": lag,
                      "chance above": float((chance >= value).mean())}


def speaker_clips(model, speaker):
    """(output, teacher's jaw) of each clip of a speaker of av/people."""
    group = corpus.Group("people")
    for sound in group.sounds:
        curve = teacher.clips("people").get(sound.name)
        if sound.speaker == speaker and curve is not None:
            samples, seconds = np.float32(group.samples(sound)) / 32768, np.arange(len(curve)) / teacher.FPS
            yield audio_controls.at_frames(model, samples, seconds)[:, JAW], curve[:, JAW]


def mean_of(correlations):
    return {"clips": len(correlations), "mean of clips": float(np.mean(correlations))}


def measure(model):
    pairs = {name: (p[:, JAW], truth[:, JAW]) for name, (p, truth) in audio_controls.other_clips(model).items()}
    speakers = {who: list(speaker_clips(model, who)) for who in jaw_data.TEST_SPEAKERS}
    pool = [predicted for rows in speakers.values() for predicted, _ in rows]
    clips = {}
    for name, (predicted, truth) in pairs.items():
        others = [pair[0] for other, pair in pairs.items() if other != name]
        clips[name] = beside_chance(predicted, truth, pool + others)
    means = {who: mean_of([shifted(*row, 0) for row in rows]) for who, rows in speakers.items()}
    grid = [row["lag 0"] for name, row in clips.items() if name.startswith("grid_")]
    return {"speakers": means | {"GRID clips of the evaluation": mean_of(grid)}, "clips": clips}


def markdown(report):
    speakers = ", ".join(f"{who} {row['mean of clips']:.2f} ({row['clips']} clips)"
                         for who, row in report["speakers"].items())
    rows = report["clips"].values()
    beyond = sum(row["best"] > row[MISMATCHED[1]] for row in rows)
    return ["## jawOpen of people never seen in training", "",
            *out.prose(f"""Mean correlation of clips: {speakers}. The audio of web videos is late; at the best lag of up
                to {max(LAGS)} frames, {beyond} of {len(rows)} clips exceed the 95th percentile of {DRAWS} outputs for
                the audio of other clips.""")]
