"""Transcripts of speech without text, by PocketSphinx: $MIEN_CACHE/voice/GROUP.words.json.

usage: python3 -m mien_training.audio.transcribe [--groups librispeech commands]
Read speech uses its dictation model, with a word error rate of about 28 % on 100 sentences with a known transcript,
most of them by a phoneme or two. Spoken commands use any sequence of the words that occur in them.
"""
import argparse
import json
import tempfile
from pathlib import Path

from pocketsphinx.pocketsphinx import Decoder

from mien_training.audio import corpus

MODEL = Path("/usr/share/pocketsphinx/model/en-us")
ORDERS = ["can|may|could i have|get", "i|i'd|i'll|want|like|have|take|please", "get|make|brew|give|bring me",
          "let|me|have|to|my|for|just|order",
          "a|an|one|two|the|single|double|triple|shot|shots",
          "small|medium|large|regular|eight|twelve|sixteen|ounce|ounces|size|sized",
          "light|dark|medium|roast|iced|hot|decaf", "coffee|espresso|latte|cappuccino|mocha|americano|cup|drink",
          "with|and|without|some|lots|no|of|a|lot|bit|little|extra|any",
          "cream|sugar|brown|white|milk|whole|skim|soy|almond|oat|sweetener|honey|half|two percent"]


def grammar():
    words = sorted({word for line in ORDERS for word in line.replace("|", " ").split()})
    return "#JSGF V1.0;\ngrammar orders;\npublic <order> = ( " + " | ".join(words) + " )+;\n"


def decoder(group):
    config = Decoder.default_config()
    config.set_string("-hmm", str(MODEL / "en-us"))
    config.set_string("-dict", str(MODEL / "cmudict-en-us.dict"))
    config.set_string("-logfn", "/dev/null")
    if group != "commands":
        config.set_string("-lm", str(MODEL / "en-us.lm.bin"))
        return Decoder(config)
    with tempfile.NamedTemporaryFile("w", suffix=".gram") as file:
        file.write(grammar())
        file.flush()
        config.set_string("-jsgf", file.name)
        return Decoder(config)


def words(recogniser, samples):
    """int16 samples at 16 kHz -> words in lower case; pauses and noises are left out."""
    recogniser.start_utt()
    recogniser.process_raw(samples.tobytes(), False, True)
    recogniser.end_utt()
    said = [segment.word.split("(")[0] for segment in recogniser.seg() or ()]
    return [word for word in said if word[:1].isalpha()]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--groups", nargs="+", default=["librispeech", "commands"])
    args = parser.parse_args()
    for name in args.groups:
        group, recogniser = corpus.Group(name), decoder(name)
        heard = {s.name: " ".join(words(recogniser, group.samples(s))) for s in group.sounds}
        corpus.heard_path(name).write_text(json.dumps(heard, indent=0))
        print(name, len([t for t in heard.values() if t]), "of", len(heard), flush=True)


if __name__ == "__main__":
    main()
