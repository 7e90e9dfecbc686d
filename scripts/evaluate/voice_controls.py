"""Controls from sound beside the video teacher's, and lips that close where they must."""
import numpy as np

from voice_model import INDEX, SPEECH_CONTROLS
from paths import data
from voice import corpus, labels, phonemes, teacher

COMPARED = ["jawOpen", "mouthClose", "mouthFunnel", "mouthPucker", "mouthRollUpper", "mouthLowerDownLeft"]
LAGS = range(-5, 6)           # video frames
OTHERS = ["grid_bbaf2n", "grid_brbk7n", "grid_lbax4n", "grid_lbbc2a", "grid_id2_swwp2s", "hdtf_WDA_KatieHill", "whitehouse_obama_weekly"]
CLOSED_JAW, CLOSE, NEAR = 0.15, 0.1, 0.04
OPEN_VOWELS = {phonemes.INDEX[p] for p in ("aa", "ae")}


def at_frames(model, sound, seconds):
    """Controls at the times of video frames [frames,18]."""
    times, controls, _ = model(np.concatenate([sound, np.zeros(4000, np.float32)]))
    return np.stack([np.interp(seconds, times, c) for c in controls.T], 1)


def correlation(a, b):
    return float(np.corrcoef(a, b)[0, 1]) if a.std() > 1e-6 and b.std() > 1e-6 else float("nan")


def best_lag(said, truth):
    """Frames by which the answer comes too late, where all clips together correlate best."""
    def at(lag):
        pairs = [(s[max(lag, 0):len(s) + min(lag, 0)], t[max(-lag, 0):len(t) + min(-lag, 0)]) for s, t in zip(said, truth)]
        return correlation(*(np.concatenate(p) for p in zip(*pairs)))
    return max(LAGS, key=at)


def held_clips(model):
    """(answers, teacher's curves) of the speaker's clips that were held out."""
    group, out = corpus.Group("av"), []
    for sound in group.of(model.split):
        curve = teacher.clips().get(sound.name)
        if curve is not None:
            seconds = np.arange(len(curve)) / teacher.FPS
            out.append((at_frames(model, np.float32(group.samples(sound)) / 32768, seconds), curve))
    return out


def other_clips(model):
    """{clip: (answers, teacher's curves)} of other people."""
    out = {}
    for name in OTHERS:
        path = next(p for p in (data() / "clips").glob(f"{name}.*") if p.suffix in (".mp4", ".mpg"))
        t = np.load(data() / f"clips/{name}.mediapipe.npz", allow_pickle=True)
        curve = teacher.speech_controls(t["blendshapes"], t["blendshape_names"])
        out[name] = at_frames(model, np.float32(corpus.decode(path)) / 32768, t["t_ms"] / 1000), curve
    return out


def agreement(pairs):
    """Per control: correlation over all frames, the mean of the clips' own, and the lag."""
    said, truth = zip(*pairs)
    report = {}
    for c in COMPARED:
        i = INDEX[c]
        own = [correlation(s[:, i], t[:, i]) for s, t in pairs]
        report[c] = {"all frames": correlation(np.concatenate(said)[:, i], np.concatenate(truth)[:, i]),
                     "mean of clips": float(np.nanmean(own)), "lag": best_lag([s[:, i] for s in said], [t[:, i] for t in truth])}
    return report


def lips(model, most=None):
    """Shares of p, b, m at whose middle, give or take 40 ms, lips are closed; and of open vowels with an open jaw."""
    group, spoken = corpus.Group("synthetic"), labels.read("synthetic")
    closed, opened = [], []
    for sound in group.of(model.split)[:most]:
        times, controls, _ = model(np.concatenate([np.float32(group.samples(sound)) / 32768, np.zeros(4000, np.float32)]))
        said = spoken[sound.name]
        for label, a, b in zip(said.labels, said.starts, [*said.starts[1:], said.end]):
            near = np.abs(times - (a + b) / 2) <= NEAR
            jaw, close = controls[near, INDEX["jawOpen"]], controls[near, INDEX["mouthClose"]]
            if label in phonemes.BILABIALS:
                closed.append(bool(((jaw < CLOSED_JAW) | (close > CLOSE)).any()))
            elif label in OPEN_VOWELS:
                opened.append(bool(jaw.max() > CLOSED_JAW))
    return {"closed for p b m": float(np.mean(closed)), "count": len(closed), "open for aa ae": float(np.mean(opened))}


def spread(model):
    """Mean and standard deviation of every control over held-out synthetic speech."""
    group = corpus.Group("synthetic")
    rows = np.concatenate([model(np.float32(group.samples(s)) / 32768)[1] for s in group.of(model.split)[:60]])
    return {c: [float(rows[:, i].mean()), float(rows[:, i].std())] for c, i in zip(SPEECH_CONTROLS, range(len(SPEECH_CONTROLS)))}
