"""Phoneme error rate on held-out readers, clips and synthetic voices."""
import re

import numpy as np
import torch

from mien_training.audio import corpus, espeak, make_speech, phoneme_search, recognition
from mien_training.audio.features import features
from mien_training.paths import data

GRID_WORDS = [dict(b="bin", l="lay", p="place", s="set"), dict(b="blue", g="green", r="red", w="white"),
              dict(a="at", b="by", i="in", w="with"), None,
              dict(zip("z123456789", "zero one two three four five six seven eight nine".split())),
              dict(a="again", n="now", p="please", s="soon")]
LETTERS = {"a": "ay", "z": "zed"}
TRAINING_CLIP = "grid_bbaf2n"  # phase 2 trains on its speaker


def grid_sentence(code):
    """The sentence of a clip of GRID, which its name encodes."""
    return [LETTERS.get(c, c) if words is None else words[c] for c, words in zip(code, GRID_WORDS)]


@torch.no_grad()
def grid_error_rate(model):
    """Error rate on the GRID clips whose speakers are not in the training data."""
    wrong = total = 0
    for path in sorted((data() / "clips").glob("grid_*.mpg")):
        if path.stem == TRAINING_CLIP:
            continue
        code = re.search(r"([a-z]{4}[z0-9][a-z])$", path.stem)[1]
        truth = [p for word in grid_sentence(code) for p in sum(espeak.words_to_phonemes(word), ())]
        sound = np.concatenate([np.float32(corpus.decode(path)) / 32768, np.zeros(3200, np.float32)])
        predicted = recognition.greedy(model.heads(model.encoder(torch.from_numpy(features(sound))[None])[0])[0][0])
        wrong, total = wrong + recognition.distance(predicted, truth), total + len(truth)
    return wrong / max(total, 1)


def measure(model):
    rate = lambda group, **options: recognition.error_rate(model.encoder, model.heads, group, model.split, **options)
    recorded = lambda sound: sound.speaker in make_speech.FLITE_VOICES
    rates = {"real speech": rate("librispeech_text"), "synthetic voices": rate("english"),
             "synthetic voices: espeak-ng variants": rate("english", choose=lambda s: not recorded(s)),
             "unknown words, sentences and other languages' voices": rate("synthetic")}
    for who, group in (("real speech", "librispeech_text"), ("synthetic voices", "english")):
        rates[f"{who}, searched with n-grams of phonemes"] = rate(group, answer=phoneme_search.search)
    if model.split == "test":
        rates |= {"synthetic voices: flite kal16": rate("english", choose=recorded),
                  "clips of other speakers of GRID": grid_error_rate(model)}
    return rates
