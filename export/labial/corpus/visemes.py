"""Visemes of speech services, and the phoneme for each.

A service reports fewer visemes than there are phonemes. Each viseme becomes the phoneme that is most frequent in
English speech among those that it covers or, if two are equally frequent, the one that the viseme is named after. Two
visemes in a row that occur together in only one English phoneme become that phoneme; rounded lips are W before a vowel,
else UW. Differences that lips do not show are lost, and so is the difference between neighbouring vowels.
"""

from __future__ import annotations

from typing import Dict, List, Sequence, Tuple

from labial.corpus.phonesets import VOWELS

#: Azure's ids (Microsoft's table of phonemes for en-US).
AZURE: Dict[str, str] = {
    "0": "SIL", "1": "AH", "2": "AA", "3": "AO", "4": "EH", "5": "ER", "6": "IH", "7": "UW", "8": "OW", "9": "AW",
    "10": "OY", "11": "AY", "12": "HH", "13": "R", "14": "L", "15": "S", "16": "SH", "17": "DH", "18": "F", "19": "N",
    "20": "K", "21": "P",
}  # fmt: skip
#: Phonemes that Azure reports in two events.
AZURE_PAIRS: Dict[Tuple[str, str], str] = {("8", "4"): "OW", ("4", "6"): "EY", ("19", "16"): "CH"}

#: Polly's symbols, X-SAMPA by look (Amazon's tables of en-US and en-GB); B, J and x are of its other languages.
POLLY: Dict[str, str] = {
    "sil": "SIL", "p": "P", "t": "N", "S": "SH", "T": "DH", "f": "F", "k": "K", "i": "IH", "r": "R", "s": "S", "l": "L",
    "u": "UW", "@": "AH", "a": "AE", "e": "EY", "E": "EH", "o": "OW", "O": "AO", "B": "B", "J": "Y", "x": "K",
}  # fmt: skip

_ROUNDED = "UW"


def stand_ins(
    names: Sequence[str], table: Dict[str, str], pairs: Dict[Tuple[str, str], str]
) -> List[Tuple[Tuple[int, int], str]]:
    """The phoneme of each viseme or pair of visemes, with the first and the last one that it stands for."""
    found: List[Tuple[Tuple[int, int], str]] = []
    at = 0
    while at < len(names):
        joined = pairs.get((names[at], names[at + 1])) if at + 1 < len(names) else None
        found.append(((at, at), table[names[at]]) if joined is None else ((at, at + 1), joined))
        at = found[-1][0][1] + 1
    vowels = VOWELS.split()
    return [(place, "W" if phoneme == _ROUNDED and following in vowels and following != _ROUNDED else phoneme)
            for (place, phoneme), following in zip(found, [phoneme for _, phoneme in found[1:]] + [""])]
