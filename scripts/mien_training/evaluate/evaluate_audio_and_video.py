"""The program with audio, video and both of the same face: rounded lips of held-out clips, and the demo clip."""
from mien_training.evaluate import audio_mixing, lip_rounding


def measure(setting):
    return {"rounding": lip_rounding.measure(setting.program), "mix": audio_mixing.measure(setting)}


def markdown(report):
    lines = ["# Audio and video", "", "For users who combine camera and microphone.",
             ""] + audio_mixing.summary(report["mix"])
    lines += audio_mixing.markdown(report["mix"]) + ["## Rounded lips from audio and from video", "",
                                                     *lip_rounding.prose(report["rounding"])]
    return "\n".join(lines + ["![Rounded lips from video and from audio](audio_and_video.png)", ""])


def plot(report, folder):
    lip_rounding.plot(report["rounding"], folder / "audio_and_video.png")
