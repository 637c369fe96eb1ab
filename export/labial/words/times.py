"""The reference of ``lib/words_time.c``: what share of a word's time each of its phonemes gets.

A phoneme weighs its mean duration, times the factor of every condition that holds for it. The durations were fitted to
the labels of three voices of flite, the factors to those of conditions that lengthen or shorten sounds in English.
Weights are whole numbers: 64 for a millisecond, and factors in 1/256, rounded down after each.
"""

from __future__ import annotations

from typing import List, Sequence

from labial.words.dictionary import PHONEMES

VOWEL, VOICELESS = 1, 2
_VOWELS = frozenset("AA AE AH AO AW AY EH ER EY IH IY OW OY UH UW".split())
_VOICELESS = frozenset("CH F HH K P S SH T TH".split())

_MEANS = """SIL 100 AA 96 AE 99 AH 45 AO 84 AW 137 AY 139 B 60 CH 118 D 47 DH 39 EH 86 ER 95 EY 128 F 96 G 68 HH 55
    IH 53 IY 99 JH 103 K 78 L 78 M 63 N 60 NG 74 OW 117 OY 148 P 95 R 59 S 109 SH 113 T 68 TH 97 UH 55 UW 81 V 51 W 61
    Y 82 Z 86 ZH 106""".split()
_MEAN = dict(zip(_MEANS[::2], map(int, _MEANS[1::2])))

#: (40,) mean duration of each phoneme, milliseconds, and its class: `VOWEL`, `VOICELESS` or 0.
MILLISECONDS = tuple(_MEAN[name] + 5 for name in PHONEMES)
CLASSES = tuple(VOWEL if name in _VOWELS else VOICELESS if name in _VOICELESS else 0 for name in PHONEMES)

#: Factors of a vowel, per cent: of a word of one syllable, of three or more, in the last and in the first syllable,
#: before a voiceless consonant, before a vowel, at the word's end, in the last syllable before a pause.
VOWEL_FACTORS = {"one": 108, "many": 94, "last": 103, "first": 108, "voiceless": 106, "vowel": 109, "final": 102,
                 "pause": 133}
#: Factors of a consonant: the word's first, its last, after a consonant, before one, behind the last vowel before a
#: pause, between vowels.
CONSONANT_FACTORS = {"first": 117, "last": 102, "after": 88, "before": 95, "pause": 138, "between": 109}


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
    total, here, result = sum(weights_), 0, []
    for weight in weights_:
        here += weight
        result.append((here * milliseconds + total // 2) // total)
    return result
