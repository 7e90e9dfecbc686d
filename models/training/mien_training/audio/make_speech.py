"""Synthetic speech with exact times: $MIEN_CACHE/voice/synthetic.{i16,json} and synthetic.phonemes.json.

usage: python3 -m mien_training.audio.make_speech [--hours 2.5]
Voices are those of eSpeak NG with all variants and random ones in English accents, and of flite and Festival if they
are installed. Held out are variants by a hash of their name and one speaker of flite. english.* is for evaluation only:
the text of the held-out reader, by held-out voices.
"""
import argparse
import re
import shutil
import subprocess
import tempfile
import wave
from pathlib import Path

import numpy as np

from mien_training.audio import corpus, espeak, labels, phonemes, random_voices
from mien_training.audio.features import RATE

ACCENTS = ["en-us", "en-us", "en-us", "gmw/en", "en-gb-x-rp", "en-gb-scotland", "en-gb-x-gbclan", "en-gb-x-gbcwmd",
           "en-029", "en-us-nyc"]
FOREIGN = ["de", "nl", "es", "it", "pt", "sv", "pl", "fr", "id", "sw", "ro", "fi"]
RECORDED_SHARE = {"train": 0.2, "val": 0.1, "test": 0.1}  # share of sentences by voices from recordings
MADE_SHARE = 0.6  # share of eSpeak NG's training sentences with a voice of their own
FLITE_VOICES = {"awb": "train", "rms": "train", "slt": "train", "kal16": "test"}
FESTIVAL_VOICES = {"ked_diphone": "train", "cmu_us_slt_arctic_hts": "train"}
UNLIKE_SPEECH = ("whisper", "robo", "Demonic", "croak")  # variants that hardly resemble voices
VOWELS = "a aI aU eI i: I E V A: O: U u: 3: @ oU OI".split()
CONSONANTS = "p b t d k g f v T D s z S Z h m n N l r j w tS dZ".split()
GRID = [("bin", "lay", "place", "set"), ("blue", "green", "red", "white"), ("at", "by", "in", "with"),
        tuple("abcdefghijklmnopqrstuvxyz"),
        ("zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine"), ("again", "now", "please",
                                                                                           "soon")]
ORDERS = [("make me", "I'd like", "can I get", "please brew", "I want"), ("a", "one", "two", "three"),
          ("small", "medium", "large", "eight ounce", "twelve ounce", "sixteen ounce"), ("single shot", "double shot",
                                                                                         "triple shot"),
          ("coffee", "espresso", "latte", "cappuccino", "mocha", "americano"),
          ("with cream", "with sugar", "with a lot of milk", "with no sugar",
           "with a little bit of cream and brown sugar", "please")]


def variants():
    """{name: split} of espeak-ng's variants."""
    listing = subprocess.run(["espeak-ng", "--voices=variant"], check=True, stdout=subprocess.PIPE, text=True).stdout
    names = sorted({part.strip() for part in re.findall(r"!v/(.+?)(?:\s{2,}|$)", listing, re.M)})
    names = [n for n in names if not any(word.lower() in n.lower() for word in UNLIKE_SPEECH)]
    return {n: "test" if corpus.share(f"variant/{n}") < 0.12 else "val" if corpus.share(f"variant/{n}") < 0.17
            else "train" for n in names}


class Texts:
    """Random sentences: parts of transcripts of the training set, sentences like those of GRID, commands, and invented
    words."""

    def __init__(self, rng, held=False):
        self.rng, self.held = rng, held
        self.read = [t.lower() for name, t in sorted(corpus.transcripts().items())
                     if name.startswith(corpus.TEST_READER + "-") == held]

    def span(self):
        words = self.read[self.rng.integers(len(self.read))].split()
        count = int(self.rng.integers(3, 13))
        at = int(self.rng.integers(max(len(words) - count, 0) + 1))
        return " ".join(words[at:at + count])

    def phrase(self, grammar):
        return " ".join(str(self.rng.choice(part)) for part in grammar)

    def unknown(self):
        """Syllables of random consonants and vowels in espeak-ng's phonemes, which no context predicts."""
        words = []
        for _ in range(self.rng.integers(2, 6)):
            syllables = [str(self.rng.choice(CONSONANTS)) + ("'" if k == 0 else "") + str(self.rng.choice(VOWELS))
                         + (str(self.rng.choice(CONSONANTS)) if self.rng.random() < 0.4 else "")
                         for k in range(self.rng.integers(1, 4))]
            words.append("[[" + "".join(syllables) + "]]")
        return " ".join(words)

    def sample(self, pseudo_words=True):
        kind = self.rng.random()
        if pseudo_words and kind < 0.25 and not self.held:
            return self.unknown()
        return self.span() if self.held or kind < 0.75 else self.phrase(GRID) if kind < 0.88 else self.phrase(ORDERS)


def say_espeak(rng, texts, variant):
    foreign = rng.random() < 0.12 and not texts.held
    voice = str(rng.choice(FOREIGN if foreign else ACCENTS)) + "+" + variant
    return espeak.speak(voice, texts.sample(not foreign), int(rng.integers(110, 260)), int(rng.integers(15, 90)),
                        int(rng.integers(20, 90)), int(rng.choice([0, 0, 0, 2, 6])))


def say_flite(rng, texts, voice):
    """The same with flite, whose segments have end times."""
    text = re.sub(r"[^a-z' ]", "", texts.sample(False).lower())
    with tempfile.TemporaryDirectory() as out:
        command = ["flite", "-voice", voice, "-psdur", "-t", text, "--setf",
                   f"duration_stretch={rng.uniform(0.7, 1.35):.2f}", "-o", f"{out}/a.wav"]
        said = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
        with wave.open(f"{out}/a.wav") as file:
            sound = np.frombuffer(file.readframes(file.getnframes()), np.int16)
    parts = [part.rsplit(":", 1) for part in said.split() if ":" in part]
    ends = [float(end) for _, end in parts]
    return sound, [phonemes.of_flite(name) for name, _ in parts], [0.0, *ends[:-1]]


def say_festival(rng, texts, voice):
    """The same with Festival, whose segments have end times."""
    text = re.sub(r"[^a-z' ]", "", texts.sample(False).lower())
    with tempfile.TemporaryDirectory() as out:
        script = f"""(voice_{voice}) (Parameter.set 'Duration_Stretch {rng.uniform(0.75, 1.35):.2f})
                     (set! said (utt.synth (Utterance Text "{text}")))
                     (utt.save.wave said "{out}/a.wav" 'riff) (utt.save.segs said "{out}/a.lab")"""
        subprocess.run(["festival", "--pipe"], input=script.encode(), check=True, stdout=subprocess.DEVNULL)
        sound = corpus.decode(f"{out}/a.wav")
        lines = [line.split() for line in Path(f"{out}/a.lab").read_text().splitlines()]
    segments = [(float(end), name) for end, _, name in (line for line in lines if len(line) == 3)]
    return sound, [phonemes.of_flite(name) for _, name in segments], [0.0, *(end for end, _ in segments[:-1])]


def recorded_voices(split):
    """(function, voice) of the installed voices."""
    programs = (("flite", say_flite, FLITE_VOICES), ("festival", say_festival, FESTIVAL_VOICES))
    return [(say, voice) for program, say, voices in programs if shutil.which(program) for voice, s in voices.items()
            if s == split]


def speeches(wanted, seed, held=False):
    """Yields (name, speaker, split, samples, labels, starts) up to `wanted` seconds of every split."""
    rng = np.random.default_rng(seed)
    texts, voices = Texts(rng, held), variants()
    for split, seconds in wanted.items():
        formant = sorted(v for v, s in voices.items() if s == split)
        recorded = recorded_voices(split)
        done = k = 0
        while done < seconds:
            if recorded and rng.random() < RECORDED_SHARE[split]:
                say, voice = recorded[rng.integers(len(recorded))]
                sound, ids, starts = say(rng, texts, voice)
            else:
                made = split == "train" and rng.random() < MADE_SHARE
                voice = random_voices.draw(rng) if made else formant[k % len(formant)]
                sound, ids, starts = say_espeak(rng, texts, voice)
            k += 1
            if len(sound) < RATE // 2 or len(ids) < 3:
                continue
            done += len(sound) / RATE
            yield f"{split}{k:05d}", voice, split, sound, ids, starts


def store(group, made):
    spoken = {}

    def stored():
        for name, voice, split, sound, ids, starts in made:
            spoken[name] = labels.Spoken(ids, starts, len(sound) / RATE)
            yield name, voice, split, sound

    corpus.write(group, stored())
    labels.write(group, spoken)
    sounds = corpus.Group(group)
    for split in ("train", "val", "test"):
        seconds, voices = sum(s.length for s in sounds.of(split)) / RATE, {s.speaker for s in sounds.of(split)}
        print(group, split, f"{seconds:.0f} s,", len(voices), "voices")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--hours", type=float, default=2.5, help="of training speech")
    args = parser.parse_args()
    store("synthetic", speeches({"train": args.hours * 3600, "val": 360, "test": 720}, 1))
    store("english", speeches({"val": 200, "test": 720}, 2, held=True))


if __name__ == "__main__":
    main()
