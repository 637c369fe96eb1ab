"""Labels of phonemes, stripped of marks that do not change the mouth's shape.

The C library does exactly the same (lib/names.c): every rule compares sequences of characters, and none needs a Unicode
table.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Dict, Iterable, List, Mapping, Optional, Tuple

from labial.files import limits

#: Combining marks (ties, nasalisation, syllabicity, releases), except the cedilla, which makes another consonant.
_COMBINING = re.compile("[\u0300-\u0326\u0328-\u036f]")
#: Length, half length; aspirated, palatalised, labialised, velarised, pharyngealised, released nasally or laterally.
_MODIFIER = re.compile("[\u02d0\u02d1\u02b0\u02b2\u02b7\u02e0\u02e4\u207f\u02e1]")
#: Marks before a symbol: primary and secondary stress in IPA, X-SAMPA and espeak; a glottal stop, which lips do not
#: show.
_LEADING = "\u02c8\u02cc'\",%?\u0294"
#: Marks after a symbol: X-SAMPA's length, syllabicity, nasalisation and palatalisation, its diacritics (``_h``),
#: Kaldi's places in a word (``_B``), and the signs that espeak's names of variants end in.
_TRAILING = re.compile(r"(?<=[^ ])(?:[:=~;.^\"-]|_[A-Za-z0-9=~^])$")
_STRESS_DIGIT = re.compile(r"(?<=[A-Za-z]{2})[012]$")
#: Diacritics, length and stress as Praat's backslash sequences. ``\h^`` is not one: it is a consonant.
_PRAAT_MARK = re.compile(r"\\[|0OT\-+:~NUDn3cv'`^][v^()]|\\[:.]f|\\'[12]")
_LETTER = re.compile(r"[A-Za-z\u0080-\U0010ffff]")
_BLANKS = " \t\r\n"
#: Bytes of a label without meaning in which a known part is looked for (LABEL_MAX of lib/names.c).
_SEARCHED = 32

#: Sets of labels: one set, or "auto", any of them, ARPABET before the IPA before X-SAMPA.
AUTO = "auto"


@lru_cache(maxsize=8)  # a label without a meaning comes at once again
def without_marks(label: str) -> str:
    """`label` without stress digits (0-2 after two letters or more), stress and length signs, ties and diacritics; ""
    when it consists of marks alone."""
    text = label.strip(_BLANKS)
    if "\\" in text:
        text = _PRAAT_MARK.sub("", text)
    if not text.isascii():
        text = _MODIFIER.sub("", _COMBINING.sub("", text))
    text = text.lstrip(_LEADING)
    while _TRAILING.search(text):
        text = _TRAILING.sub("", text)
    return _STRESS_DIGIT.sub("", text)


def normalise(label: str) -> str:
    """`label` without its marks; unchanged if it consists only of marks."""
    return without_marks(label) or label.strip(_BLANKS)


def find(names: Mapping[str, str], label: str) -> Optional[str]:
    """The meaning of `label` in `names` (label or alias -> phoneme), or None: first without blanks around it, then also
    without its marks. A label longer than `limits.LABEL` bytes has none."""
    return find_first((names,), label)


def find_first(tables: Iterable[Mapping[str, str]], label: str) -> Optional[str]:
    """The same in the first of several tables that knows `label`."""
    label = label.strip(_BLANKS)
    if len(label) > limits.LABEL or len(label.encode("utf-8", "replace")) > limits.LABEL:
        return None
    bare = without_marks(label) or label
    for names in tables:
        known = names.get(label, names.get(bare))
        if known is not None:
            return known
    return None


def longest_of(names: Mapping[str, str]) -> Dict[str, int]:
    """How long the names are that begin with a character, at most: what :func:`nearest` compares."""
    longest: Dict[str, int] = {}
    for name in names:
        longest[name[0]] = max(len(name), longest.get(name[0], 0))
    return longest


def nearest(names: Mapping[str, str], longest: Mapping[str, int], label: str, silence: str, neutral: str) -> str:
    """A phoneme for a label without a meaning: silence for text in brackets, and for labels of nothing but marks,
    digits and punctuation; else the first known part of its first 32 bytes, scanning from the left, and the longest
    there; else `neutral`."""
    label = label.strip(_BLANKS)
    if len(label) > 1 and label[0] + label[-1] in ("<>", "[]", "()", "{}", "++", "**", "##"):
        return silence
    if len(label) > _SEARCHED or not label.isascii():
        label = label[:_SEARCHED].encode("utf-8", "replace")[:_SEARCHED].decode("utf-8", "replace")
    text = without_marks(label)
    if not _LETTER.search(text):
        return silence
    for start, first in enumerate(text):
        for end in range(min(len(text), start + longest.get(first, 0)), start, -1):
            if text[start:end] in names:
                return names[text[start:end]]
    return neutral


def entries(names: Mapping[str, Mapping[str, str]]) -> List[Tuple[str, str, Tuple[str, ...]]]:
    """The names of each set of labels as one table: name, phoneme, and the sets in which that name means it.

    The table leaves out names that mean the same when their marks are dropped. It is sorted by the names' bytes; a name
    of several meanings occurs once for each, in the order of `names`' sets, so that the first one applies if no set is
    named.
    """
    table = []
    for name in sorted({name for known in names.values() for name in known}, key=str.encode):
        meanings = _meanings(names, name)
        plain = _meanings(names, normalise(name)) if normalise(name) != name else {}
        if meanings.items() <= plain.items() and next(iter(meanings.values())) == next(iter(plain.values())):
            continue
        table += [(name, phoneme, tuple(labels for labels, meaning in meanings.items() if meaning == phoneme))
                  for phoneme in dict.fromkeys(meanings.values())]
    return table


def _meanings(names: Mapping[str, Mapping[str, str]], name: str) -> Dict[str, str]:
    return {labels: known[name] for labels, known in names.items() if name in known}
