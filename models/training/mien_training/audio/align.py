"""Phonemes with times for recorded speech: forced alignment of transcripts with a network of phase 1.

usage: python3 -m mien_training.audio.align CHECKPOINT
       [--groups librispeech_text av people animated librispeech commands]
Recordings that cannot be aligned are left out. The animated voice has no transcript; its labels are the phonemes that
the network recognizes.
"""
import argparse
from pathlib import Path

import numpy as np
import torch

from mien_training.audio import corpus, espeak, labels, phonemes
from mien_training.audio.features import RATE, STEP, features
from mien_training.audio.recognition import load

LETTERS = {"a": "ay", "z": "zed"}  # GRID's speakers are British and pronounce A as a letter


def words_of(group, name, text):
    """Phonemes of each spoken word; None if the words are unknown."""
    if group in corpus.SENTENCES:
        return [sum(espeak.words_to_phonemes(LETTERS.get(word, word)), ())
                for word, _, _ in corpus.words_of_clip(group, name)]
    return espeak.words_to_phonemes(text[name]) if text.get(name) else []


def states_of(words):
    """One state per phoneme, silences between words that may be skipped: (phonemes, may be skipped)."""
    states = [phonemes.SILENCE]
    for word in words:
        states += [*word, phonemes.SILENCE]
    states = np.array(states)
    return states, states == phonemes.SILENCE


def viterbi(scores, states, optional):
    """State of every frame, the best path of scores [t, phonemes] (Viterbi 1967) through all states in their order."""
    count, emitted = len(states), scores[:, states]
    moves = np.zeros((len(scores), count), np.int8)
    # Two impossible states before the first one, so that every state has two predecessors.
    best = np.full(count + 2, -np.inf)
    best[2:4] = emitted[0, :2]
    skippable = np.full(count, -np.inf)
    skippable[2:] = np.where(optional[1:-1], 0, -np.inf)
    for t in range(1, len(scores)):
        chosen, one, two = best[2:].copy(), best[1:-1], best[:-2] + skippable
        for move, other in ((1, one), (2, two)):
            better = other > chosen
            moves[t, better] = move
            chosen = np.where(better, other, chosen)
        best[2:] = chosen + emitted[t]
    best = best[2:]
    at = count - 1 if best[-1] >= best[-2] else count - 2
    path = [at]
    for t in range(len(scores) - 1, 0, -1):
        at -= int(moves[t, at])
        path.append(at)
    return np.array(path[::-1])


def timed(scores, words, seconds):
    """Spoken, or None if there are more phonemes than steps."""
    states, optional = states_of(words)
    if len(states) > len(scores):
        return None
    path = viterbi(scores, states, optional)
    return spoken_of(path, states[path], seconds)


def spoken_of(path, said, seconds):
    """Spoken from the phoneme of each step; a new one begins where the path advances."""
    changes = np.flatnonzero(np.diff(path, prepend=-1))
    starts = np.maximum((changes - 2) * STEP, 0)  # a step describes the middle of its windows
    return labels.Spoken([int(said[c]) for c in changes], [float(t) for t in starts], seconds)


@torch.no_grad()
def align(group_name, network, heads):
    group, out = corpus.Group(group_name), {}
    text = corpus.transcripts() if group_name == "librispeech_text" else corpus.heard(group_name)
    for sound in group.sounds:
        samples = np.float32(group.samples(sound)) / 32768
        # the network recognizes the last phoneme later
        samples = np.concatenate([samples, np.zeros(RATE // 10, np.float32)])
        embedding = network(torch.from_numpy(features(samples))[None])[0]
        frame = heads(embedding)[1]
        words = words_of(group_name, sound.name, text)
        spoken = timed(torch.log_softmax(frame[0], -1).numpy(), words, sound.length / RATE) if words else None
        if group_name == "animated":
            heard = frame[0].argmax(-1).numpy()
            spoken = spoken_of(heard, heard, sound.length / RATE)
        if spoken:
            out[sound.name] = spoken
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("checkpoint", type=Path)
    parser.add_argument("--groups", nargs="+",
                        default=["librispeech_text", "av", "people", "animated", "librispeech", "commands"])
    args = parser.parse_args()
    torch.set_num_threads(1)
    network, heads = load(args.checkpoint)
    for group in args.groups:
        spoken = align(group, network, heads)
        labels.write(group, spoken)
        print(group, len(spoken), "of", len(corpus.Group(group).sounds), flush=True)


if __name__ == "__main__":
    main()
