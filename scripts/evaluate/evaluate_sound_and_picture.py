"""What the program answers to sound, to a picture and to both of the same face: rounded lips of held-out clips, and the demo clip."""
import report as out
import voice_mix
import voice_rounding


def measure(setting):
    return {"rounding": voice_rounding.measure(setting.program), "mix": voice_mix.measure(setting)}


def markdown(report):
    lines = ["# Sound and picture", "", "## Rounded lips by sound and by picture", ""] + voice_rounding.prose(report["rounding"])
    lines += ["![by sound and by picture](sound_and_picture.png)", "", "## Sound and picture together", ""]
    lines += out.prose("""The demo clip, whose true controls are known; its voice is a variant of eSpeak NG that was held out.""")
    return "\n".join(lines + voice_mix.markdown(report["mix"]))


def plot(report, folder):
    voice_rounding.plot(report["rounding"], folder / "sound_and_picture.png")
