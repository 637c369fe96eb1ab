"""The reference decoder: a word's phonemes from trees and exceptions, as float models are to ``labial/labial.h``.

It walks the trees node by node and looks exceptions up by their spelling, so that it shares nothing with the packed
bytes and their decoder in C, which are compared with it.
"""

from __future__ import annotations

from typing import List, Optional, Sequence, Tuple

from labial.words.alignment import phonemes_of
from labial.words.dictionary import LETTERS, PHONEMES, letters_of
from labial.words.questions import answer, features
from labial.words.tables import WordTables

#: Phonemes that a letter has by its accent, or None.
Accent = Optional[Tuple[str, ...]]


def labels_by_trees(tables: WordTables, letters: Sequence[int], sounds: Sequence[Accent] = ()) -> List[int]:
    """The label of each letter, from the last to the first, without exceptions. `sounds` are those of accented letters;
    they hold where the letter's tree has a label for them."""
    labels = [0] * len(letters)
    for place in reversed(range(len(letters))):
        forced = _label_of(tables, letters, place, sounds) if sounds else None
        if forced is not None:
            labels[place] = forced
            continue
        values = features(letters, place, labels)
        question, yes, no, label = tables.nodes_of(letters[place])
        node = 0
        while question[node] >= 0:
            node = yes[node] if answer(question[node], values, tables.sounds) else no[node]
        labels[place] = label[node]
    return labels


def _label_of(tables: WordTables, letters: Sequence[int], place: int, sounds: Sequence[Accent]) -> Optional[int]:
    """The label of a letter with an accent: an e behind é is silent, and ë at the end of a word is IY."""
    sound = sounds[place]
    if sound is None:
        behind = LETTERS[letters[place]] == "e" and place > 0 and sounds[place - 1] == ("EY",)
        return 0 if behind else None
    if sound == ("EH", "IY"):
        is_last = place + 1 == len(letters) or LETTERS[letters[place + 1]] == "'"
        sound = ("IY",) if is_last else ("EH",)
    wanted = tuple(PHONEMES.index(name) for name in sound)
    question, _, _, label = tables.nodes_of(letters[place])
    for asked, given in zip(question, label):
        if asked < 0 and phonemes_of(tables.sounds[given]) == wanted:
            return given
    return None


def labels_of(tables: WordTables, word: str, sounds: Sequence[Accent] = ()) -> List[int]:
    """The label of each letter of a word of a to z and apostrophes, at most `LONGEST` letters."""
    accented = any(sounds)
    labels = labels_by_trees(tables, letters_of(word), sounds if accented else ())
    for place, label in () if accented else tables.exceptions.get(word, ()):
        labels[place] = label
    return labels


def read(tables: WordTables, word: str, sounds: Sequence[Accent] = ()) -> Tuple[Tuple[int, int], ...]:
    """The phonemes of such a word, each with the place of its letter."""
    labels = labels_of(tables, word, sounds)
    return tuple((phoneme, place) for place, label in enumerate(labels)
                 for phoneme in phonemes_of(tables.sounds[label]))


def phonemes(tables: WordTables, word: str) -> Tuple[int, ...]:
    """The phonemes of such a word."""
    return tuple(phoneme for phoneme, _ in read(tables, word))
