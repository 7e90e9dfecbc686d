"""Rounded lips by audio and by video: the program's output for held-out clips with either one."""
import tempfile
import wave
from pathlib import Path

import numpy as np

from mien_training.audio import corpus
from mien_training.audio.features import RATE
from mien_training.evaluate import report as out
from mien_training.evaluate.inputs import Missing
from mien_training.paths import data

ROUNDED = ["mouthPucker", "mouthFunnel"]
SETTLING = 5  # frames


def write_wav(path, samples):
    with wave.open(str(path), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(RATE)
        file.writeframes(np.int16(samples).tobytes())


def predictions(program, clip, samples, mode):
    with tempfile.TemporaryDirectory() as folder:
        sound = Path(folder) / "sound.wav"
        write_wav(sound, samples)
        table = program.track(clip, 1, "--audio", sound, mode=mode).table
    return {c: table[c][SETTLING:] for c in ROUNDED}


def held_out():
    """[(video, its sound)]"""
    clips = [(clip, data() / f"av/audio/{clip.stem}.opus") for clip in sorted((data() / "av/video").glob("*.mp4"))]
    return [(clip, sound) for clip, sound in clips if sound.exists() and corpus.split_of("av", clip.stem)[1] == "test"]


def measure(program):
    """Curves and correlations by control: of audio and of video."""
    clips = held_out()
    if not clips:
        raise Missing("no held-out clip with sound is in av/: MIEN_DATA must name the folder of the data packs")
    pairs = [[predictions(program, clip, corpus.decode(sound), mode) for mode in ("audio", "video")]
             for clip, sound in clips]
    report = {"clips": len(pairs)}
    for c in ROUNDED:
        rows = [(a[c][:len(v[c])], v[c][:len(a[c])]) for a, v in pairs]
        rows = [(a[known], v[known]) for a, v in rows for known in [np.isfinite(a) & np.isfinite(v)]]
        sound, picture = (np.concatenate(v) for v in zip(*rows))
        own = [np.corrcoef(a, v)[0, 1] for a, v in rows if a.std() > 1e-4 and v.std() > 1e-4]
        report[c] = {"sound": out.rounded(sound, 3), "picture": out.rounded(picture, 3),
                     "mean of clips": out.rounded(np.mean(own)),
                     "correlation": out.rounded(np.corrcoef(sound, picture)[0, 1])}
    return report


def prose(report):
    found = "; ".join(
        f"{c} {out.number(report[c]['correlation'])} over all frames, {out.number(report[c]['mean of clips'])} as the "
        "mean of "
                      "clips" for c in ROUNDED)
    return out.prose(
        f"""Correlation between the output of `mien track --mode audio` and `--mode video` on {report['clips']} held-out
        clips at level 1: {found}.""")


def plot(report, path):
    figure, panels = out.plt.subplots(1, 2, figsize=(7, 3.4))
    for control, axes in zip(ROUNDED, panels):
        axes.plot(report[control]["picture"], report[control]["sound"], ".", markersize=3, alpha=0.4)
        axes.set(title=control, xlabel="from video", ylabel="from audio", xlim=(0, None), ylim=(0, None))
    figure.tight_layout()
    out.save(figure, path)
