"""Audio of the data packs, decoded once: $MIEN_CACHE/voice/GROUP.i16 (16 kHz mono) and GROUP.json.

usage: python3 -m mien_training.audio.corpus
Hashes of names select held-out data: speakers if they are known, otherwise files; for noises also whole classes.
"""
import functools
import hashlib
import json
import subprocess
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass

import numpy as np

from mien_training.audio.features import RATE
from mien_training.paths import cache, data

TEST_READER = "26"  # of librispeech_text's three; one man and one woman remain to learn from
TEST_NOISES = ("Helicopter", "Rooster", "dude_miaowing")  # one class of humming, two with voices
VAL_SPEAKER = "s5"  # of GRID; a clip of the evaluation shows the same person
TEST_TAKE, VAL_TAKE = "1114_3_16", "1114_3_15"  # of the animated voice; the shortest
FOLDERS = {"librispeech": "speech/librispeech", "librispeech_text": "speech/librispeech_text",
           "commands": "speech/commands",
           "av": "av/audio", "people": "av/people/audio", "animated": "av/animated/audio", "noise": "noise",
           "rooms": "impulse_responses"}
SENTENCES = {"av": "av/align", "people": "av/people/align"}  # GRID's words with their times


@dataclass
class Sound:
    name: str
    speaker: str
    split: str
    start: int   # in samples of the group's file
    length: int


def folder():
    path = cache() / "voice"
    path.mkdir(parents=True, exist_ok=True)
    return path


def share(name):
    """0..1, from a hash of the name."""
    return int(hashlib.sha256(name.encode()).hexdigest()[:8], 16) / 2 ** 32


def split_of(group, name):
    """(speaker, split): about 10 % test, 5 % val."""
    speaker = {"librispeech": name.split("-")[0], "librispeech_text": name.split("-")[0], "av": "s1",
               "animated": "animated", "people": people().get(name)}.get(group, name)
    if group == "people":
        return speaker, "val" if speaker == VAL_SPEAKER else "train"
    if group == "animated":
        return speaker, {TEST_TAKE: "test", VAL_TAKE: "val"}.get(name, "train")
    if group == "noise":  # ESC-10 names recordings CLASS_FOLD-RECORDING-TAKE: takes of one recording stay together
        speaker = name.rsplit("-", 1)[0]
        if any(kind in name for kind in TEST_NOISES):
            return speaker, "test"
    if group == "librispeech_text" and speaker == TEST_READER:
        return speaker, "test"
    by_speaker = group in ("librispeech", "noise")
    part = share(f"{group}/{speaker if by_speaker else name}")
    if group == "librispeech_text":
        return speaker, "val" if part < 0.08 else "train"
    return speaker, "test" if part < 0.1 else "val" if part < 0.15 else "train"


@functools.lru_cache(None)
def people():
    """{clip of av/people: speaker}"""
    d = np.load(data() / "av/people/curves.npz", allow_pickle=True)
    return dict(zip(map(str, d["clip"]), map(str, d["speaker"])))


def decode(path, *options):
    """int16 samples"""
    command = ["ffmpeg", "-nostdin", "-v", "error", "-i", str(path), *options, "-f", "s16le", "-ac", "1", "-ar",
               str(RATE), "-"]
    return np.frombuffer(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout, np.int16)


def write(group, sounds, **extra):
    """`sounds`: (name, speaker, split, samples) one after the other. `extra` goes to the JSON."""
    rows, start = [], 0
    partial = folder() / f"{group}.partial"
    with open(partial, "wb") as out:
        for name, speaker, split, samples in sounds:
            rows.append(asdict(Sound(name, speaker, split, start, len(samples))))
            start += len(samples)
            out.write(np.int16(samples).tobytes())
    partial.replace(folder() / f"{group}.i16")
    (folder() / f"{group}.json").write_text(json.dumps({"sounds": rows, **extra}))


class Group:
    """Sounds of one group; int16 samples by `samples(sound)`."""

    def __init__(self, name):
        self.name = name
        self.info = json.loads((folder() / f"{name}.json").read_text())
        self.sounds = [Sound(**row) for row in self.info["sounds"]]
        self.by_name = {s.name: s for s in self.sounds}
        self._all = np.memmap(folder() / f"{name}.i16", np.int16, "r")

    def of(self, split):
        return [s for s in self.sounds if s.split == split]

    def samples(self, sound):
        return self._all[sound.start:sound.start + sound.length]


def transcripts():
    """{utterance: words} of librispeech_text."""
    lines = (data() / "speech/librispeech_text/transcripts.txt").read_text().splitlines()
    return dict(line.split(" ", 1) for line in lines if " " in line)


def heard_path(group):
    return folder() / f"{group}.words.json"


def heard(group):
    """{name: words}, of speech that has no transcript, by transcribe.py."""
    return json.loads(heard_path(group).read_text()) if heard_path(group).exists() else {}


def words_of_clip(group, clip):
    """(word, from, to) in seconds, of an align file of GRID."""
    rows = [line.split() for line in (data() / SENTENCES[group] / f"{clip}.align").read_text().splitlines()]
    return [(word, int(a) / 25000, int(b) / 25000) for a, b, word in rows if word not in ("sil", "sp")]


def decode_group(group):
    paths = sorted(p for p in (data() / FOLDERS[group]).iterdir() if p.suffix in (".opus", ".flac", ".wav"))
    with ThreadPoolExecutor(2) as pool:
        write(group, ((p.stem, *split_of(group, p.stem), s) for p, s in zip(paths, pool.map(decode, paths))))


def main():
    for group in FOLDERS:
        if not (folder() / f"{group}.json").exists():
            decode_group(group)
        g = Group(group)
        seconds = {split: round(sum(s.length for s in g.of(split)) / RATE) for split in ("train", "val", "test")}
        print(group, len(g.sounds), "sounds,", len({s.speaker for s in g.sounds}), "speakers, seconds:", seconds)


if __name__ == "__main__":
    main()
