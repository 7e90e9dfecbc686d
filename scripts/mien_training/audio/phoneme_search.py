"""Phonemes with an English language model, for evaluation only; the tracker does not use it.

CTC prefix beam search (Hannun et al. 2014, "First-Pass Large Vocabulary Continuous Speech Recognition using
Bi-Directional Recurrent DNNs") with n-grams of phonemes (interpolated as in Witten and Bell 1991) from the transcripts
of the training set.
"""
import functools

import numpy as np

from mien_training.audio import corpus, espeak, phonemes

ORDER = 4
BEAM, LEAST = 64, 1e-4     # prefixes; a phoneme less likely than that is not tried
WEIGHT, BONUS = 0.3, 0.8   # of the n-grams' logarithm; for each phoneme: chosen on validation speech


def sentences():
    """Phonemes of the training readers, from transcripts or recognized."""
    train = {s.name for name in ("librispeech_text", "librispeech") for s in corpus.Group(name).of("train")}
    texts = [text for name, text in (corpus.transcripts() | corpus.heard("librispeech")).items() if name in train]
    return [[p for word in espeak.words_to_phonemes(text) for p in word] for text in texts]


@functools.lru_cache(None)
def likelihoods():
    """log p [phoneme] * ORDER: of the last phoneme given those before it; silence stands for the beginning."""
    shape = (len(phonemes.NAMES),)
    counts = [np.zeros(shape * n) for n in range(1, ORDER + 1)]
    for said in sentences():
        padded = (phonemes.SILENCE,) * (ORDER - 1) + tuple(said)
        for i in range(ORDER, len(padded) + 1):
            for n in range(1, ORDER + 1):
                counts[n - 1][padded[i - n:i]] += 1
    p = np.full(shape, 1 / (len(phonemes.NAMES) - 1))
    for count in counts:
        kinds = np.maximum((count > 0).sum(-1, keepdims=True), 1)
        p = (count + kinds * p) / (count.sum(-1, keepdims=True) + kinds)
    return np.log(p)


def search(log_probabilities, weight=WEIGHT, bonus=BONUS):
    """The likeliest phonemes of [t, phonemes], a log softmax as a tensor."""
    table = weight * likelihoods() + bonus
    start = (phonemes.SILENCE,) * (ORDER - 1)
    # prefix: (p of it and a blank after it, p of it without one, logarithm of what n-grams say)
    beams = {start: (1.0, 0.0, 0.0)}
    score = lambda found: np.log(found[0] + found[1] + 1e-300) + found[2]
    for row in np.exp(np.float64(log_probabilities.numpy())):
        found = {}

        def add(prefix, blank, last, said):
            before = found.get(prefix, (0.0, 0.0))
            found[prefix] = (before[0] + blank, before[1] + last, said)

        tried = [int(p) for p in np.flatnonzero(row > LEAST) if p != phonemes.SILENCE]
        for prefix, (blank, last, said) in beams.items():
            add(prefix, (blank + last) * row[phonemes.SILENCE], last * row[prefix[-1]], said)
            likely = table[prefix[1 - ORDER:]]
            for p in tried:
                begun = blank if prefix[-1] == p else blank + last  # the same phoneme again needs a blank between
                add((*prefix, p), 0.0, begun * row[p], said + likely[p])
        best = sorted(found.items(), key=lambda item: -score(item[1]))[:BEAM]
        scale = sum(best[0][1][:2])
        beams = {prefix: (blank / scale, last / scale, said) for prefix, (blank, last, said) in best}
    return list(max(beams, key=lambda prefix: score(beams[prefix]))[len(start):])
