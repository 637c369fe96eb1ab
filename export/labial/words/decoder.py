"""The reference decoder: a word's phonemes from trees and exceptions, as float models are to ``labial/labial.h``.

It walks the trees node by node and looks exceptions up by their spelling, so that it shares nothing with the packed
bytes and their decoder in C, which are compared with it.
"""

from __future__ import annotations

from typing import List, Sequence, Tuple

from labial.words.alignment import phonemes_of
from labial.words.dictionary import letters_of
from labial.words.questions import answer, features
from labial.words.tables import WordTables


def labels_by_trees(tables: WordTables, letters: Sequence[int]) -> List[int]:
    """The label of each letter, from the last to the first, without exceptions."""
    labels = [0] * len(letters)
    for place in reversed(range(len(letters))):
        values = features(letters, place, labels)
        question, yes, no, label = tables.nodes_of(letters[place])
        node = 0
        while question[node] >= 0:
            node = yes[node] if answer(question[node], values, tables.sounds) else no[node]
        labels[place] = label[node]
    return labels


def labels_of(tables: WordTables, word: str) -> List[int]:
    """The label of each letter of a word of a to z and apostrophes, at most `LONGEST` letters."""
    labels = labels_by_trees(tables, letters_of(word))
    for place, label in tables.exceptions.get(word, ()):
        labels[place] = label
    return labels


def read(tables: WordTables, word: str) -> Tuple[Tuple[int, int], ...]:
    """The phonemes of such a word, each with the place of its letter."""
    labels = labels_of(tables, word)
    return tuple((phoneme, place) for place, label in enumerate(labels)
                 for phoneme in phonemes_of(tables.sounds[label]))


def phonemes(tables: WordTables, word: str) -> Tuple[int, ...]:
    """The phonemes of such a word."""
    return tuple(phoneme for phoneme, _ in read(tables, word))
