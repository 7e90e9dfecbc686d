"""Controls from audio compared with the video teacher's, and lips that must close and round."""
import numpy as np

from mien_training.audio import corpus, labels, phonemes, teacher
from mien_training.evaluate.audio_model import INDEX
from mien_training.paths import data

COMPARED = ["jawOpen", "mouthClose", "mouthFunnel", "mouthPucker", "mouthRollUpper", "mouthLowerDownLeft"]
LAGS = range(-5, 6)           # video frames
OTHERS = ["grid_brbk7n", "grid_lbax4n", "grid_lbbc2a", "grid_id2_swwp2s", "hdtf_WDA_KatieHill",
          "whitehouse_obama_weekly"]
CLOSED_JAW, CLOSE, NEAR = 0.15, 0.1, 0.04
OPEN_VOWELS = {phonemes.INDEX[p] for p in ("aa", "ae")}
ROUND, ROUNDED = 0.15, {phonemes.INDEX[p] for p in ("uw", "w")}
FUNNELLED = ROUNDED | {phonemes.INDEX[p] for p in ("ow", "oy", "ao")}


def at_frames(model, sound, seconds):
    """Controls at the times of video frames [frames,18]."""
    times, controls, _ = model(np.concatenate([sound, np.zeros(4000, np.float32)]))
    return np.stack([np.interp(seconds, times, c) for c in controls.T], 1)


def correlation(a, b):
    return float(np.corrcoef(a, b)[0, 1]) if a.std() > 1e-6 and b.std() > 1e-6 else float("nan")


def best_lag(predicted, truth):
    """Delay of the output in frames at the best correlation over all clips."""
    def at(lag):
        pairs = [(s[max(lag, 0):len(s) + min(lag, 0)], t[max(-lag, 0):len(t) + min(-lag, 0)])
                 for s, t in zip(predicted, truth)]
        return correlation(*(np.concatenate(p) for p in zip(*pairs)))
    return max(LAGS, key=at)


def held_clips(model):
    """(answers, teacher's curves) of the held-out clips."""
    group, out = corpus.Group("av"), []
    for sound in group.of("test"):
        curve = teacher.clips("av").get(sound.name)
        if curve is not None:
            seconds = np.arange(len(curve)) / teacher.FPS
            out.append((at_frames(model, np.float32(group.samples(sound)) / 32768, seconds), curve))
    return out


def other_clips(model):
    """{clip: (answers, teacher's curves)} of other people."""
    out = {}
    for name in OTHERS:
        t = np.load(data() / f"clips/{name}.mediapipe.npz", allow_pickle=True)
        curve = teacher.speech_controls(t["blendshapes"], t["blendshape_names"])
        out[name] = at_frames(model, np.float32(corpus.decode(clip_path(name))) / 32768, t["t_ms"] / 1000), curve
    return out


def clip_path(name):
    return next(p for p in (data() / "clips").glob(f"{name}.*") if p.suffix in (".mp4", ".mpg"))


def measure(model):
    predicted = list(spoken_phonemes(model))
    return {"held-out clips": agreement(held_clips(model)),
            "other people": agreement(list(other_clips(model).values())), "lips": lips(predicted),
            "strength": strength(predicted)}


def agreement(pairs):
    """Per control: correlation over all frames, the mean of the clips' own, and the lag."""
    predicted, truth = zip(*pairs)
    report = {}
    for c in COMPARED:
        i = INDEX[c]
        own = [correlation(s[:, i], t[:, i]) for s, t in pairs]
        report[c] = {"all frames": correlation(np.concatenate(predicted)[:, i], np.concatenate(truth)[:, i]),
                     "mean of clips": float(np.nanmean(own)),
                     "lag": best_lag([s[:, i] for s in predicted], [t[:, i] for t in truth])}
    return report


def spoken_phonemes(model):
    """(phoneme, controls [t,18] within 40 ms of its middle) of held-out synthetic voices."""
    group, spoken = corpus.Group("synthetic"), labels.read("synthetic")
    for sound in group.of("test"):
        times, controls, _ = model(
            np.concatenate([np.float32(group.samples(sound)) / 32768, np.zeros(4000, np.float32)]))
        speech = spoken[sound.name]
        for label, a, b in zip(speech.labels, speech.starts, [*speech.starts[1:], speech.end]):
            yield label, controls[np.abs(times - (a + b) / 2) <= NEAR]


def lips(predicted):
    """Shares of p, b and m with closed lips at their centre, of open vowels with an open jaw, and of rounded lips.
    `predicted`: a list of results of spoken_phonemes."""
    most = lambda name, chosen: [controls[:, INDEX[name]].max() for label, controls in predicted if label in chosen]
    closed = [bool(((c[:, INDEX["jawOpen"]] < CLOSED_JAW) | (c[:, INDEX["mouthClose"]] > CLOSE)).any())
              for label, c in predicted if label in phonemes.BILABIALS]
    return {"closed for p b m": float(np.mean(closed)), "count": len(closed),
            "open for aa ae": float(np.mean(np.array(most("jawOpen", OPEN_VOWELS)) > CLOSED_JAW)),
            "rounded for uw w": float(np.mean(np.array(most("mouthPucker", ROUNDED)) > ROUND))}


def strength(predicted):
    """95th percentiles of the controls of the mouth where they are expected."""
    where = {"jawOpen": OPEN_VOWELS, "mouthPucker": ROUNDED, "mouthFunnel": FUNNELLED}
    of = lambda name: np.concatenate([c[:, INDEX[name]] for label, c in predicted if label in where[name]])
    return {name: float(np.percentile(of(name), 95)) for name in where}
