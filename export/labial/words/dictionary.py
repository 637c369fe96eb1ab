"""Reads the CMU Pronouncing Dictionary, and has its notice.

A line is ``word PHONE PHONE ...``, with stress digits behind vowels; further pronunciations of a word are ``word(2)``
and so on; ``#`` and ``;;;`` begin comments. Words with characters other than letters and the apostrophe, and words of
more than `LONGEST` letters, are left out: the trees have no letters for them.
"""

from __future__ import annotations

import re
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List, Sequence, Tuple

from labial.corpus.phonesets import ARPABET
from labial.errors import DataError, PathLike
from labial.files.grammar import lines_of, read_text

#: A letter's number is its place here; 0 stands for "outside the word".
LETTERS = "\0abcdefghijklmnopqrstuvwxyz'"
#: Most letters of a word: the length of the decoder's memory (LABIAL_WORDS_LETTERS of labial/words.h).
LONGEST = 32
#: Phonemes by number: silence, then the 39 of ARPABET in the order of the alphabet, as in the bundled model.
PHONEMES: Tuple[str, ...] = ("SIL", *ARPABET)
#: The list of common words that comes with this package.
COMMON = Path(__file__).with_name("common.txt")
#: Most phonemes of a word: two for each letter.
_PHONEMES_MOST = 2 * LONGEST
_WORD = re.compile(r"[a-z']+")
_VARIANT = re.compile(r"\(\d+\)$")
#: What the licences of the dictionary and of the recordings want in what is made from them.
NOTICE = """How long phonemes last was measured in speech of LibriSpeech (c) 2014 Vassil Panayotov and others and
LibriTTS (c) 2019 Heiga Zen and others, CC BY 4.0, https://www.openslr.org; the CSTR VCTK Corpus 0.92 (c) 2019 Junichi
Yamagishi and others, CC BY 4.0, https://datashare.ed.ac.uk/handle/10283/3443; CMU ARCTIC (c) 2003 Carnegie Mellon
University, John Kominek and Alan W Black, http://festvox.org/cmu_arctic.

Trained on the CMU Pronouncing Dictionary, which comes with this notice:

Copyright (C) 1993-2015 Carnegie Mellon University. All rights reserved.

Redistribution and use in source and binary forms, with or without modification, are permitted provided that the
following conditions are met:

1. Redistributions of source code must retain the above copyright notice, this list of conditions and the following
   disclaimer. The contents of this file are deemed to be source code.

2. Redistributions in binary form must reproduce the above copyright notice, this list of conditions and the following
   disclaimer in the documentation and/or other materials provided with the distribution.

This work was supported in part by funding from the Defense Advanced Research Projects Agency, the Office of Naval
Research and the National Science Foundation of the United States of America, and by member companies of the Carnegie
Mellon Sphinx Speech Consortium. We acknowledge the contributions of many volunteers to the expansion and improvement of
this dictionary.

THIS SOFTWARE IS PROVIDED BY CARNEGIE MELLON UNIVERSITY ``AS IS'' AND ANY EXPRESSED OR IMPLIED WARRANTIES, INCLUDING,
BUT NOT LIMITED TO, THE IMPLIED WARRANTIES OF MERCHANTABILITY AND FITNESS FOR A PARTICULAR PURPOSE ARE DISCLAIMED. IN NO
EVENT SHALL CARNEGIE MELLON UNIVERSITY NOR ITS EMPLOYEES BE LIABLE FOR ANY DIRECT, INDIRECT, INCIDENTAL, SPECIAL,
EXEMPLARY, OR CONSEQUENTIAL DAMAGES (INCLUDING, BUT NOT LIMITED TO, PROCUREMENT OF SUBSTITUTE GOODS OR SERVICES; LOSS OF
USE, DATA, OR PROFITS; OR BUSINESS INTERRUPTION) HOWEVER CAUSED AND ON ANY THEORY OF LIABILITY, WHETHER IN CONTRACT,
STRICT LIABILITY, OR TORT (INCLUDING NEGLIGENCE OR OTHERWISE) ARISING IN ANY WAY OUT OF THE USE OF THIS SOFTWARE, EVEN
IF ADVISED OF THE POSSIBILITY OF SUCH DAMAGE.
"""


@dataclass(frozen=True)
class Entry:
    """One pronunciation of a word."""

    word: str
    letters: Tuple[int, ...]  #: places in `LETTERS`
    phonemes: Tuple[int, ...]  #: places in `PHONEMES`
    variant: int  #: 0 for the word's first pronunciation

    @property
    def held_out(self) -> bool:
        """Whether the word belongs to the 15 % that measure how well unknown words are read."""
        return zlib.crc32(self.word.encode("ascii")) % 20 < 3


def read_dictionary(path: PathLike) -> List[Entry]:
    """The entries of a dictionary file, in its order; repeated pronunciations of a word are dropped.

    Raises DataError, with the line, for a phoneme that ARPABET lacks, a word without phonemes or with more than two
    for each of `LONGEST` letters, and a file without words.
    """
    numbers = {name: number for number, name in enumerate(PHONEMES)}
    found: Dict[str, List[Tuple[int, ...]]] = {}
    entries: List[Entry] = []
    for line, text in enumerate(lines_of(read_text(path)), 1):
        fields = text.split("#")[0].split()
        if not fields or text.startswith(";;;"):
            continue
        word = _VARIANT.sub("", fields[0]).lower()
        try:
            phonemes = tuple(numbers[name.rstrip("012")] for name in fields[1:])
        except KeyError as error:
            raise DataError(path, line, f"{error.args[0]!r} is not a phoneme of ARPABET") from None
        if not 0 < len(phonemes) <= _PHONEMES_MOST:
            raise DataError(path, line, f"{word!r:.40} has {len(phonemes)} phonemes, not 1 to {_PHONEMES_MOST}")
        if not _WORD.fullmatch(word) or len(word) > LONGEST:
            continue
        known = found.setdefault(word, [])
        if phonemes not in known:
            entries.append(Entry(word, letters_of(word), phonemes, len(known)))
            known.append(phonemes)
    if not entries:
        raise DataError(path, None, "no word of the letters a to z")
    return entries


def letters_of(word: str) -> Tuple[int, ...]:
    """The numbers of a word's letters, a to z and the apostrophe."""
    return tuple(map(LETTERS.index, word))


def read_common(path: PathLike) -> List[str]:
    """The words of a list, one per line, the most frequent first; lines that begin with # are comments."""
    return [line.strip() for line in lines_of(read_text(path)) if line.strip() and not line.startswith("#")]


def pronunciations(entries: Sequence[Entry]) -> Dict[str, List[Tuple[int, ...]]]:
    """All pronunciations of each word."""
    found: Dict[str, List[Tuple[int, ...]]] = {}
    for entry in entries:
        found.setdefault(entry.word, []).append(entry.phonemes)
    return found
