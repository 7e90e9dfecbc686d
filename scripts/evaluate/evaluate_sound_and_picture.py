"""What the program answers to sound, to a picture and to both of the same face: rounded lips of held-out clips, and the demo clip."""
import report as out
import voice_mix
import voice_rounding


def measure(setting):
    return {"rounding": voice_rounding.measure(setting.program), "mix": voice_mix.measure(setting)}


def markdown(report):
    lines = ["# Audio and video", "", "For users who combine camera and microphone.", ""] + voice_mix.summary(report["mix"])
    lines += voice_mix.markdown(report["mix"]) + ["## Rounded lips from audio and from video", "", *voice_rounding.prose(report["rounding"])]
    return "\n".join(lines + ["![Rounded lips from video and from audio](sound_and_picture.png)", ""])


def plot(report, folder):
    voice_rounding.plot(report["rounding"], folder / "sound_and_picture.png")
