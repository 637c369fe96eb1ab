"""Labels of phonemes, stripped of what does not change the mouth's shape.

The C library does the same to the letter (lib/names.c): every rule here is one of characters in a row, none asks a
Unicode table.
"""

from __future__ import annotations

import re
from typing import Dict, Mapping, Optional

#: Combining marks (ties, nasalisation, syllabicity, releases), but for the cedilla, which makes another consonant.
_COMBINING = re.compile("[\u0300-\u0326\u0328-\u036f]")
#: Length, half length; aspirated, palatalised, labialised, velarised, pharyngealised, released nasally or laterally.
_MODIFIER = re.compile("[\u02d0\u02d1\u02b0\u02b2\u02b7\u02e0\u02e4\u207f\u02e1]")
#: Marks before a symbol: primary and secondary stress in IPA, X-SAMPA and espeak.
_LEADING = "\u02c8\u02cc'\",%"
#: Marks after a symbol: X-SAMPA's length, syllabicity, nasalisation and palatalisation, its diacritics (``_h``) and
#: Kaldi's places in a word (``_B``).
_TRAILING = re.compile(r"(?<=[^ ])(?:[:=~;]|_[A-Za-z0-9=~^])$")
_STRESS_DIGIT = re.compile(r"(?<=[A-Za-z]{2})[012]$")
#: Diacritics, length and stress as Praat's backslash sequences. ``\h^`` is not one: it is a consonant.
_PRAAT_MARK = re.compile(r"\\[|0OT\-+:~NUDn3cv'`^][v^()]|\\[:.]f|\\'[12]")
_BLANKS = " \t\r\n"

#: What X-SAMPA, MBROLA, MARY and espeak mean by labels that ARPABET uses for other sounds, as IPA.
SAMPA = {"N": "ŋ", "S": "ʃ", "T": "θ", "D": "ð", "Z": "ʒ", "V": "ʌ", "H": "ɥ", "Y": "ʏ", "y": "ʉ"}

#: The vowel that stands for a label of which nothing is known.
_NEUTRAL = "ə"


def normalise(label: str) -> str:
    """`label` without stress digits (0-2 after two letters or more), stress and length signs, ties and diacritics.

    A label that consists of marks alone is returned as it is.
    """
    text = _PRAAT_MARK.sub("", label.strip(_BLANKS))
    text = _MODIFIER.sub("", _COMBINING.sub("", text)).lstrip(_LEADING)
    while _TRAILING.search(text):
        text = _TRAILING.sub("", text)
    return _STRESS_DIGIT.sub("", text) or label.strip(_BLANKS)


def find(names: Mapping[str, str], label: str, sampa: bool = False) -> Optional[str]:
    """What `label` means among `names` (label or alias -> phoneme), or None.

    The label as it stands comes first, then without its marks. With `sampa`, the labels of `SAMPA` have its meaning.
    """
    text = normalise(label)
    if sampa and text in SAMPA:
        return names.get(SAMPA[text])
    return names.get(label, names.get(text))


def nearest(names: Mapping[str, str], label: str, silence: str) -> str:
    """A phoneme for any label: what it means; silence for what is in brackets; else the first part of it that is known,
    as long as possible; else the neutral vowel; else silence."""
    known = find(names, label)
    if known is not None:
        return known
    if len(label) > 1 and label[0] + label[-1] in ("<>", "[]", "()", "{}", "++", "**", "##"):
        return silence
    text = normalise(label)
    for start in range(len(text)):
        for end in range(len(text), start, -1):
            if text[start:end] in names:
                return names[text[start:end]]
    return names.get(_NEUTRAL, silence)


def without_redundant(names: Dict[str, str]) -> Dict[str, str]:
    """`names` without those that mean the same when their marks are dropped."""
    return {name: phoneme for name, phoneme in names.items()
            if normalise(name) == name or names.get(normalise(name)) != phoneme}
