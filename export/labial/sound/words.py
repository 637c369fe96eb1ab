"""Words of a text, and pronunciations for those that the dictionary lacks."""

from __future__ import annotations

import re
import unicodedata
from typing import Callable, Dict, List, Optional, Tuple

from labial.corpus.phonesets import VOWELS
from labial.errors import LabialError

#: Characters of a word; all others are punctuation.
_WORD = re.compile(r"[^\W_]+(?:['\u2019][^\W_]+)*['\u2019]?")
_LETTERS = re.compile(r"[a-z']+")
#: Letters of other alphabets' Latin, as English spells them.
_PLAIN = str.maketrans({"\u2019": "'", "æ": "ae", "œ": "oe", "ø": "o", "ß": "ss", "ð": "th", "þ": "th", "ł": "l"})

#: Letter to sound: for each beginning of the rest of a word, longest first, what it sounds like. In capitals: phonemes.
_RULES: Dict[str, str] = {
    "tion": "SH AH N", "sion": "ZH AH N", "ssion": "SH AH N", "cious": "SH AH S", "tious": "SH AH S", "ture": "CH ER",
    "ough": "AO", "augh": "AO", "eigh": "EY", "igh": "AY", "tch": "CH", "dge": "JH", "sch": "S K", "que": "K",
    "ch": "CH", "sh": "SH", "th": "TH", "ph": "F", "wh": "W", "gh": "G", "ck": "K", "ng": "NG", "qu": "K W", "kn": "N",
    "wr": "R", "ps": "P S", "rh": "R", "mb": "M B",
    "ai": "EY", "ay": "EY", "au": "AO", "aw": "AO", "ea": "IY", "ee": "IY", "ei": "EY", "ey": "IY", "eu": "Y UW",
    "ew": "Y UW", "ie": "IY", "oa": "OW", "oi": "OY", "oy": "OY", "oo": "UW", "ou": "AW", "ow": "OW", "ue": "UW",
    "ui": "UW", "ar": "AA R", "er": "ER", "ir": "ER", "or": "AO R", "ur": "ER", "yr": "IH R",
    "a": "AE", "b": "B", "c": "K", "ce": "S EH", "ci": "S IH", "cy": "S IY", "d": "D", "e": "EH", "f": "F", "g": "G",
    "ge": "JH EH", "gi": "JH IH", "gy": "JH IY", "h": "HH", "i": "IH", "j": "JH", "k": "K", "l": "L", "m": "M",
    "n": "N", "o": "AA", "p": "P", "q": "K", "r": "R", "s": "S", "t": "T", "u": "AH", "v": "V", "w": "W", "x": "K S",
    "y": "Y", "z": "Z", "'": "",
}  # fmt: skip
#: The same at the end of a word.
_ENDINGS: Dict[str, str] = {
    "e": "", "es": "Z", "ed": "D", "y": "IY", "a": "AH", "o": "OW", "i": "IY", "u": "UW", "s": "Z", "mb": "M",
    "le": "AH L", "re": "ER", "ge": "JH", "ce": "S", "se": "Z", "ies": "IY Z", "ss": "S", "'s": "Z",
}  # fmt: skip
#: A vowel, one consonant and an e at the end: the vowel is that of its letter's name.
_LONG = {"a": "EY", "e": "IY", "i": "AY", "o": "OW", "u": "UW", "y": "AY"}

#: The end of a phrase, and its most words.
_MARK = re.compile(r"[.,;:!?\n]")
_LONGEST = 5

Lookup = Callable[[str], Optional[str]]


def phrases_of(text: str) -> List[List[str]]:
    """The words of a text in small letters, as the dictionary writes them, in phrases: what stands between punctuation
    marks or in a line, in even parts where it has more than `_LONGEST` words.

    Raises LabialError for what cannot be read aloud by rule, figures and other alphabets, and names it.
    """
    phrases: List[List[str]] = []
    strange: List[str] = []
    last = 0
    for match in _WORD.finditer(text):
        word = _without_accents(match.group().lower().translate(_PLAIN))
        if not _LETTERS.fullmatch(word):
            strange.append(word)
        elif not phrases or _MARK.search(text, last, match.start()):
            phrases.append([word])
        else:
            phrases[-1].append(word)
        last = match.end()
    if strange:
        some = ", ".join(repr(word) for word in dict.fromkeys(strange[:8]))
        raise LabialError(f"the text must be English words, figures written out as they are spoken; not {some}")
    return [phrase[len(phrase) * part // parts : len(phrase) * (part + 1) // parts]
            for phrase in phrases for parts in [-(-len(phrase) // _LONGEST)] for part in range(parts)]


def pronunciations(words: List[str], lookup: Lookup) -> Tuple[Dict[str, str], List[str]]:
    """Phonemes, separated by blanks, of the words that `lookup` does not know, and those of these words that are spelt
    out by rule; the others are compounds of known words."""
    found: Dict[str, str] = {}
    guessed: List[str] = []
    for word in dict.fromkeys(words):
        if lookup(word) is None:
            found[word] = _compound(word, lookup) or ""
            if not found[word]:
                found[word] = spelt(word)
                guessed.append(word)
    return found, guessed


def spelt(word: str) -> str:
    """A pronunciation of `word` by English spelling; accurate enough for lips."""
    vowels = VOWELS.split()
    phonemes: List[str] = []
    at = 0
    while at < len(word):
        rest = word[at:]
        if len(rest) in (3, 4) and rest[0] in _LONG and rest[1] not in "aeiouywxr" and rest[2:] in ("e", "es"):
            sound, taken = _LONG[rest[0]], 1
        elif rest in _ENDINGS and any(phoneme in vowels for phoneme in phonemes):
            sound, taken = _ENDINGS[rest], len(rest)
        else:
            taken = next(n for n in range(min(5, len(rest)), 0, -1) if rest[:n] in _RULES)
            sound = _RULES[rest[:taken]]
            if taken > 1 and rest[0] in "cg" and rest[1] in "eiy":
                sound, taken = sound.split()[0], 1  # a soft c or g; the vowel counts again
            elif taken == 1 and rest[1:2] == rest[0] and rest[0] not in "aeiou":
                taken = 2
            elif rest[0] == "y" and phonemes and taken == 1:
                sound = "IH"
        phonemes += sound.split()
        at += taken
    return " ".join(phonemes) or "AH"


def _compound(word: str, lookup: Lookup) -> Optional[str]:
    """A compound of known words: one with an s after it, or two of at least three letters; the longest first part
    wins."""
    if word.endswith(("'s", "s'")) or (word.endswith("s") and len(word) > 3):
        stem = lookup(word[:-1].rstrip("'"))
        if stem:
            last = stem.split()[-1]
            hissing = last in ("S", "Z", "SH", "ZH", "CH", "JH")
            return f"{stem} {'AH Z' if hissing else 'S' if last in ('P', 'T', 'K', 'F', 'TH') else 'Z'}"
    for split in range(len(word) - 3, 2, -1):
        first, second = lookup(word[:split]), lookup(word[split:])
        if first and second:
            return f"{first} {second}"
    return None


def _without_accents(word: str) -> str:
    return "".join(c for c in unicodedata.normalize("NFKD", word) if not unicodedata.combining(c))
