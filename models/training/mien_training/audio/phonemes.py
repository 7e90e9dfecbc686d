"""The phonemes (ARPAbet's 39 and silence), and their equivalents in IPA and in flite."""
import functools
import re

SILENCE = 0  # for CTC the same number is the blank
NAMES = ["sil", "aa", "ae", "ah", "ao", "aw", "ay", "b", "ch", "d", "dh", "eh", "er", "ey", "f", "g", "hh", "ih", "iy",
         "jh", "k",
         "l", "m", "n", "ng", "ow", "oy", "p", "r", "s", "sh", "t", "th", "uh", "uw", "v", "w", "y", "z", "zh"]
INDEX = {name: i for i, name in enumerate(NAMES)}
BILABIALS = {INDEX[p] for p in ("p", "b", "m")}

# Vowels of other languages become the English ones of nearest lip shape, consonants those of the nearest place.
IPA = {
    "aɪ": "ay", "aʊ": "aw", "ɔɪ": "oy", "eɪ": "ey", "oʊ": "ow", "əʊ": "ow", "ɔʏ": "oy", "tʃ": "ch", "dʒ": "jh",
    "tɕ": "ch",
    "dʑ": "jh", "pf": "p f", "ts": "t s", "dz": "d z", "əl": "ah l", "n̩": "ah n", "l̩": "ah l", "m̩": "ah m",
    "r̩": "er",
    "i": "iy", "ɪ": "ih", "ᵻ": "ih", "ɨ": "ih", "y": "uw", "ʏ": "uh", "e": "eh", "ɛ": "eh", "ø": "er", "œ": "er",
    "æ": "ae", "a": "ae",
    "ɶ": "ae", "ɑ": "aa", "ɒ": "aa", "ɔ": "ao", "o": "ao", "ʊ": "uh", "u": "uw", "ʉ": "uw", "ɯ": "uh", "ʌ": "ah",
    "ɐ": "ah", "ə": "ah",
    "ɘ": "ah", "ɵ": "uh", "ɚ": "er", "ɜ": "er", "ɝ": "er", "ɤ": "ah", "aː": "aa", "oː": "ao", "eː": "ey",
    "p": "p", "b": "b", "t": "t", "d": "d", "ʈ": "t", "ɖ": "d", "k": "k", "ɡ": "g", "g": "g", "c": "k", "ɟ": "g",
    "q": "k",
    "ɾ": "d", "m": "m", "ɱ": "m", "n": "n", "ɲ": "n y", "ŋ": "ng", "ɳ": "n", "f": "f", "v": "v", "ɸ": "f", "β": "v",
    "ʋ": "v", "θ": "th",
    "ð": "dh", "s": "s", "z": "z", "ʃ": "sh", "ʒ": "zh", "ʂ": "sh", "ʐ": "zh", "ɕ": "sh", "ʑ": "zh", "ç": "hh",
    "x": "hh", "χ": "hh",
    "ɣ": "g", "h": "hh", "ɦ": "hh", "ɬ": "l", "l": "l", "ɫ": "l", "ʎ": "l y", "ɭ": "l", "ɹ": "r", "r": "r", "ʁ": "r",
    "ʀ": "r", "ɽ": "r", "ɻ": "r", "j": "y", "ɥ": "w", "w": "w", "ʍ": "w", "ʔ": "",
}
IPA_PART = re.compile("|".join(sorted(IPA, key=len, reverse=True)))
FLITE = {"ax": "ah", "axr": "er", "pau": "sil", "h#": "sil", "brth": "sil", "ssil": "sil", "el": "l", "em": "m",
         "en": "n", "dx": "d", "nx": "n", "ix": "ih", "ux": "uw", "hv": "hh"}


@functools.lru_cache(None)
def of_ipa(text):
    """Phonemes of an IPA string, as numbers, without marks (length, stress, (en))."""
    text = re.sub(r"\(.*?\)", "", text)
    return tuple(INDEX[name] for part in IPA_PART.findall(text) for name in IPA[part].split())


def of_flite(phone):
    return INDEX[FLITE.get(phone, phone)]


def without_repeats(labels):
    """The phonemes of a framewise output, without silence and repetitions."""
    return [b for a, b in zip([SILENCE, *labels], labels) if b != a and b != SILENCE]
