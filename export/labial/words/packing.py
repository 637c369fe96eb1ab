"""Packs tables of words into the bytes that ``include/labial/words.h`` describes and ``lib/words.c`` reads, and writes
them as C.

A letter's labels are in its own list, the most frequent first. A word's hash is FNV-1a over the numbers of its letters,
times `multiplier`, modulo 2^32; its first byte is the bucket, and a bucket's entries are ordered by the next two. The
spelling is not stored: the multiplier is chosen so that no other word of the dictionary has the first 24 bits of an
exception's hash.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from itertools import accumulate
from pathlib import Path
from typing import Iterable, List, Sequence, Tuple

import numpy as np

from labial.errors import ModelError, PathLike
from labial.files.c import array, check_name, exported_header, written_by
from labial.files.outputs import write_files
from labial.words.alignment import phonemes_of
from labial.words.dictionary import LETTERS, LONGEST, NOTICE, PHONEMES, letters_of
from labial.words.tables import WordTables
from labial.words.times import CLASSES, MILLISECONDS
from labial.words.trees import LABELS_MOST, ends_in_vowel

#: Most labels of a letter; most bytes of a part for yes, of all trees and of all exceptions.
LETTER_LABELS, _PART, _BYTES = 32, (1 << 13) - 1, 65535
#: Marks beside a label's phonemes: it ends in a vowel.
VOWEL = 0x80
#: Of FNV-1a; the first multiplier that is tried, and how many are.
_BASIS, _PRIME = 2166136261, 16777619
_FIRST = 2654435769
_TRIES = 200_000


@dataclass(frozen=True)
class PackedWords:
    """The tables as C has them; every number is a byte unless stated otherwise."""

    trees: bytes
    roots: Tuple[int, ...]  #: 27 places in `trees`, 16 bits
    bases: Tuple[int, ...]  #: 27 places in `leaves`: where a letter's labels begin, 16 bits
    leaves: Tuple[int, ...]  #: the labels of each letter
    labels: Tuple[Tuple[int, int], ...]  #: first and second phoneme of each label, 0 for none; `VOWEL` in the second
    multiplier: int  #: 32 bits
    buckets: Tuple[int, ...]  #: 257 places in `patches`, 16 bits
    patches: bytes  #: entries of all buckets

    @property
    def size(self) -> int:
        """Bytes in flash."""
        words = (self.roots, self.bases, self.labels, self.buckets)
        return sum(map(len, (self.trees, self.leaves, self.patches))) + 2 * sum(map(len, words))


def pack(tables: WordTables) -> PackedWords:
    """Packs tables. Raises ModelError where a number exceeds the format's limits."""
    trees = bytearray()
    roots: List[int] = []
    bases: List[int] = []
    leaves: List[int] = []
    for letter in range(1, len(LETTERS)):
        question, _, _, label = tables.nodes_of(letter)
        counts = Counter(value for node, value in enumerate(label) if question[node] < 0)
        own = sorted(counts, key=lambda value: (-counts[value], value))
        if len(own) > LETTER_LABELS:
            raise ModelError(f"the letter {LETTERS[letter]} has {len(own)} labels, and there is room for 32")
        roots.append(len(trees))
        bases.append(len(leaves))
        trees += _tree(tables, letter, own)
        leaves += own
    pairs = [(*phonemes_of(sound), 0, 0)[:2] for sound in tables.sounds]
    vowels = (VOWEL * ends_in_vowel(sound) for sound in tables.sounds)
    labels = tuple((first, second | vowel) for (first, second), vowel in zip(pairs, vowels))
    buckets, patches = _exceptions(tables)
    for what, size in (("the trees have", len(trees)), ("the exceptions have", len(patches))):
        if size > _BYTES:
            raise ModelError(f"{what} {size} bytes, and there is room for {_BYTES}")
    return PackedWords(bytes(trees), tuple(roots), tuple(bases), tuple(leaves), labels, tables.multiplier,
                       buckets, patches)


def _tree(tables: WordTables, letter: int, own: Sequence[int]) -> bytes:
    question, yes, no, label = tables.nodes_of(letter)

    def leaf(node: int) -> int:
        return own.index(label[node])

    def part(node: int) -> bytes:
        ask, if_yes, if_no = question[node], yes[node], no[node]
        if question[if_yes] < 0 and question[if_no] < 0:
            return _node(ask, 0, leaf(if_yes)) + bytes([leaf(if_no)])
        if question[if_yes] < 0:
            return _node(ask, 1, leaf(if_yes)) + part(if_no)
        if question[if_no] < 0:
            return _node(ask, 2, leaf(if_no)) + part(if_yes)
        first = part(if_yes)
        if len(first) > _PART:
            raise ModelError(f"a part of the tree of {LETTERS[letter]} has {len(first)} bytes, not up to {_PART}")
        return _node(ask, 3, len(first) >> 8) + bytes([len(first) & 255]) + first + part(if_no)

    if question[0] < 0:  # a letter that always sounds the same: any question will do
        return _node(0, 0, leaf(0)) + bytes([leaf(0)])
    return part(0)


def _node(question: int, kind: int, five: int) -> bytes:
    return (question << 7 | kind << 5 | five).to_bytes(2, "big")


def _exceptions(tables: WordTables) -> Tuple[Tuple[int, ...], bytes]:
    """The places of the 256 buckets and their end, and the bytes of all entries."""
    buckets: List[List[bytes]] = [[] for _ in range(256)]
    for word, patches in tables.exceptions.items():
        key = (hash_of(word) * tables.multiplier & 0xFFFFFFFF) >> 8
        entry = [key & 0xFFFF, *(label << 5 | place for place, label in patches)]
        entry[-1] |= 1 << 15
        buckets[key >> 16].append(b"".join(item.to_bytes(2, "big") for item in entry))
    data = [b"".join(sorted(bucket)) for bucket in buckets]
    return tuple(accumulate(map(len, data), initial=0)), b"".join(data)


assert LONGEST <= 32 and LABELS_MOST <= 64


def hash_of(word: str) -> int:
    """FNV-1a of a word's letters, without the multiplier."""
    value = _BASIS
    for letter in letters_of(word):
        value = ((value ^ letter) * _PRIME) & 0xFFFFFFFF
    return value


def multiplier_for(exceptions: Sequence[str], words: Iterable[str]) -> int:
    """The first odd number by which no two exceptions, and no exception and another of `words`, share 24 bits."""
    others = np.array([hash_of(word) for word in sorted(set(words) - set(exceptions))], dtype=np.uint32)
    own = np.array([hash_of(word) for word in exceptions], dtype=np.uint32)
    taken = np.zeros(1 << 24, dtype=bool)
    for step in range(_TRIES):
        multiplier = (_FIRST + 2 * step) & 0xFFFFFFFF
        places = (own * np.uint32(multiplier)) >> np.uint32(8)
        if len(np.unique(places)) < len(places):
            continue
        taken[places] = True
        if not taken[(others * np.uint32(multiplier)) >> np.uint32(8)].any():
            return multiplier
        taken[places] = False
    raise ModelError("every hash takes some word of the dictionary for an exception: choose fewer exceptions")


#: What alternates in words that cannot be read: it moves the lips and closes nothing.
FILLER = ("AH", "L")
#: LABIAL_WORDS_FORMAT of include/labial/words.h.
FORMAT = 2


def _head(name: str, what: str) -> str:
    notice = "".join(f" * {line}".rstrip() + "\n" for line in NOTICE.splitlines())
    return written_by("export", what).replace(" */\n", f" *\n{notice} */\n")


def header(packed: PackedWords, name: str) -> str:
    """NAME.h: the tables' symbol."""
    size = packed.size + len(MILLISECONDS) + len(CLASSES)
    body = (f"/* The tables, {size} bytes and the structure that points to them. */\n"
            f"extern const labial_words_model_t {name};\n")
    return exported_header(_head(name, f"{name}.h - how words sound, for labial/words.h."), name, "LABIAL_WORDS",
                           "labial/words.h", ("LABIAL_WORDS_FORMAT", FORMAT), body)


def source(packed: PackedWords, name: str) -> str:
    """NAME.c: the tables."""
    labels = "".join(f'    "{label}\\0"\n' for label in PHONEMES)
    parts = [_head(name, f"{name}.c - how words sound, for labial/words.h."), f'#include "{name}.h"\n\n',
             "/* Phonemes: labels, milliseconds, and whether each is a vowel (1) or voiceless (2). */\n",
             f"static const char phonemes[] =\n{labels.rstrip()};\n", array("uint8_t", "milliseconds", MILLISECONDS),
             array("uint8_t", "classes", CLASSES), "\n", array("uint16_t", "roots", packed.roots),
             array("uint16_t", "bases", packed.bases), array("uint8_t", "leaves", packed.leaves),
             array("uint8_t", "labels", (part for label in packed.labels for part in label)),
             array("uint8_t", "trees", packed.trees), "\n", array("uint16_t", "buckets", packed.buckets),
             array("uint8_t", "patches", packed.patches or b"\0")]
    members = ["LABIAL_WORDS_FORMAT", str(len(PHONEMES)), f"{packed.multiplier}u", "roots", "bases", "leaves", "labels",
               "trees", "buckets", "patches", "phonemes", "milliseconds", "classes",
               f"{{ {', '.join(str(PHONEMES.index(label)) for label in FILLER)} }}"]
    listed = ",\n".join(f"    {member}" for member in members)
    parts.append(f"\nconst labial_words_model_t {name} = {{\n{listed}\n}};\n")
    return "".join(parts)


def write(packed: PackedWords, name: str, directory: PathLike) -> List[Path]:
    """Writes both files into `directory`; returns their paths."""
    check_name(name, "table of words")
    return write_files(directory, {f"{name}.c": source(packed, name), f"{name}.h": header(packed, name)})
