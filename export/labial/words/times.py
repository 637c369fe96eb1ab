"""The reference of ``lib/words_time.c``: what share of a word's time each of its phonemes gets.

A phoneme weighs its mean duration, times the factor of every condition that holds for it. Both were fitted to the
speech of 180 people and of three voices of flite (docs/words.md).
Weights are whole numbers: 64 for a millisecond, and factors in 1/256, rounded down after each.
"""

from __future__ import annotations

from itertools import accumulate
from typing import List, Sequence

from labial.corpus.phonesets import VOWELS
from labial.words.dictionary import PHONEMES

VOWEL, VOICELESS = 1, 2
_VOWELS = frozenset(VOWELS.split())
_VOICELESS = frozenset("CH F HH K P S SH T TH".split())

_MEANS = """SIL 100 AA 101 AE 113 AH 45 AO 97 AW 144 AY 141 B 55 CH 125 D 48 DH 46 EH 77 ER 91 EY 126 F 93 G 70 HH 57
    IH 53 IY 94 JH 92 K 82 L 81 M 67 N 60 NG 82 OW 120 OY 152 P 86 R 67 S 102 SH 122 T 63 TH 89 UH 58 UW 81 V 52 W 73
    Y 78 Z 95 ZH 121""".split()
_MEAN = dict(zip(_MEANS[::2], map(int, _MEANS[1::2])))
#: (40,) mean duration of each phoneme, milliseconds, and its class: `VOWEL`, `VOICELESS` or 0.
MILLISECONDS = tuple(_MEAN[name] + 5 for name in PHONEMES)
CLASSES = tuple(VOWEL if name in _VOWELS else VOICELESS if name in _VOICELESS else 0 for name in PHONEMES)
#: Factors of a vowel, per cent: of a word of one syllable, of three or more, in the last and in the first syllable,
#: before a voiceless consonant, before a vowel, at the word's end, in the last syllable before a pause.
VOWEL_FACTORS = {"one": 105, "many": 106, "last": 101, "first": 101, "voiceless": 101, "vowel": 117, "final": 101,
                 "pause": 162}
#: Factors of a consonant: the word's first, its last, after a consonant, before one, behind the last vowel before a
#: pause, between vowels.
CONSONANT_FACTORS = {"first": 118, "last": 104, "after": 85, "before": 98, "pause": 160, "between": 115}


def weights(word: Sequence[int], pause: bool) -> List[int]:
    """The weights of a spoken word's phonemes; `pause` says that a pause follows it."""
    vowels = [i for i, phoneme in enumerate(word) if CLASSES[phoneme] == VOWEL]
    result = []
    for i, phoneme in enumerate(word):
        before = CLASSES[word[i - 1]] if i > 0 else None
        after = CLASSES[word[i + 1]] if i + 1 < len(word) else None
        if CLASSES[phoneme] == VOWEL:
            holds = {"one": len(vowels) == 1, "many": len(vowels) >= 3, "last": i == vowels[-1],
                     "first": i == vowels[0], "voiceless": after == VOICELESS, "vowel": after == VOWEL,
                     "final": after is None, "pause": pause and i == vowels[-1]}
            factors = VOWEL_FACTORS
        else:
            holds = {"first": i == 0, "last": after is None, "after": before is not None and before != VOWEL,
                     "before": after is not None and after != VOWEL,
                     "pause": pause and (not vowels or i > vowels[-1]), "between": before == after == VOWEL}
            factors = CONSONANT_FACTORS
        weight = 64 * MILLISECONDS[phoneme]
        for name, factor in factors.items():
            if holds[name]:
                weight = weight * ((factor * 256 + 50) // 100) >> 8
        result.append(weight)
    return result


def ends(weights_: Sequence[int], milliseconds: int) -> List[int]:
    """When each phoneme ends, milliseconds from the word's beginning: the last one at its end."""
    total = sum(weights_)
    return [(here * milliseconds + total // 2) // total for here in accumulate(weights_)]
