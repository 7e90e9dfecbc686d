"""Phonemes that a network of phase 1 recognizes, and its error rate."""
import numpy as np
import torch

from mien_training.audio import corpus, espeak, labels, phonemes
from mien_training.audio.audio_net import Encoder, PhonemeHeads
from mien_training.audio.features import features


def load(path):
    state = torch.load(path, map_location="cpu")
    network, heads = Encoder(), PhonemeHeads()
    network.load_state_dict(state["encoder"])
    heads.load_state_dict(state["heads"])
    return network.eval(), heads.eval()


BLANK_BIAS = 1.0  # CTC prefers blanks: chosen on validation speech between 0 and 3


def greedy(log_probabilities):
    """Best path of CTC (Graves et al. 2006): the likeliest of every step, without repeats and blanks."""
    scores = log_probabilities.clone()
    scores[:, phonemes.SILENCE] -= BLANK_BIAS
    return phonemes.without_repeats(scores.argmax(-1).tolist())


def distance(a, b):
    """Levenshtein distance."""
    row = np.arange(len(b) + 1)
    b, index = np.asarray(b), np.arange(len(b) + 1)
    for i, x in enumerate(a):
        changed = np.minimum(row[1:] + 1, row[:-1] + (b != x))
        # Insertions: a running minimum.
        row = np.minimum.accumulate(np.concatenate([[i + 1], changed]) - index) + index
    return int(row[-1])


def truth(group, split):
    """(sound, phonemes) of recordings with known phonemes."""
    if group.name == "librispeech_text":
        text = corpus.transcripts()
        return [(s, [p for word in espeak.words_to_phonemes(text[s.name]) for p in word]) for s in group.of(split)
                if s.name in text]
    spoken = labels.read(group.name)
    return [(s, spoken[s.name].sequence()) for s in group.of(split)]


@torch.no_grad()
def error_rate(network, heads, name, split, most):
    """Insertions, deletions and substitutions over phonemes of the truth, of the first `most` recordings."""
    group = corpus.Group(name)
    wrong = total = 0
    for sound, said in truth(group, split)[:most]:
        samples = np.concatenate([np.float32(group.samples(sound)) / 32768, np.zeros(3200, np.float32)])
        heard = greedy(heads(network(torch.from_numpy(features(samples))[None])[0])[0][0])
        wrong += distance(heard, said)
        total += len(said)
    return wrong / max(total, 1)
