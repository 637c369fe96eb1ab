"""What a tree may ask about a letter of a word. Words are read from their last letter to their first.

A question is a number, 0 .. 399, and needs no table:

======== ====================================================================================================
0 .. 255 32 * place + what: place 0 .. 3 is the letter 1 .. 4 to the left, 4 .. 7 the letter 1 .. 4 to the right;
         `what` is a letter's number (0 outside the word) or, from 28 on, one of `CLASSES`
256 ..   64 * which + label: the letter 1 (which = 0) or 2 to the right has been given this label; 60 one that ends in
383      a vowel, 61 one of two phonemes, 62 silence or outside the word, 63 outside the word
384 ..   to the right are at most 0 .. 7 groups of vowels
391
392 ..   to the left are at most 0 .. 7 groups of vowels
399
======== ====================================================================================================

A group of vowels is a run of the letters a e i o u y. :func:`features` gives 12 numbers of a letter: the four letters
to the left and the four to the right, nearest first; the labels of the two to the right; the groups to the right and to
the left, at most 7.
"""

from __future__ import annotations

from functools import cached_property
from typing import List, Sequence, Tuple

import numpy as np

from labial.words.alignment import phonemes_of
from labial.words.dictionary import LETTERS, PHONEMES, letters_of

QUESTIONS = 400
FEATURES = 12
#: Classes of letters that a question may name, by number from 28 on.
CLASSES = ("aeiouy", "eiy", "lrmnw", "bcdfghjklmnpqrstvwxz")
#: The highest number of a label, and what stands for none.
LABELS_MOST = 60
OUTSIDE = 63

_VOWEL_LETTERS = frozenset(letters_of(CLASSES[0]))
_MEMBERS = tuple(frozenset(letters_of(name)) for name in CLASSES)
_GROUPS_MOST = 7
_FIRST_CLASS, _LABELS, _RIGHT, _LEFT = 28, 256, 384, 392
_VOWEL, _PAIR, _SILENT = 60, 61, 62
_VOWEL_PHONEMES = frozenset(PHONEMES.index(name) for name in "AA AE AH AO AW AY EH ER EY IH IY OW OY UH UW".split())


def ends_in_vowel(sound: int) -> bool:
    """Whether the last phoneme of a sound is a vowel."""
    return bool(_VOWEL_PHONEMES.intersection(phonemes_of(sound)[-1:]))


def vowel_groups(letters: Sequence[int]) -> int:
    """The number of runs of vowels among letters, at most 7."""
    vowels = [letter in _VOWEL_LETTERS for letter in letters]
    return min(_GROUPS_MOST, sum(here and not before for before, here in zip([False, *vowels], vowels)))


def features(letters: Sequence[int], place: int, labels: Sequence[int]) -> List[int]:
    """The 12 numbers of the letter at `place`, where `labels` has the labels of all letters behind it."""
    size = len(letters)
    left = [letters[place - k] if place >= k else 0 for k in range(1, 5)]
    right = [letters[place + k] if place + k < size else 0 for k in range(1, 5)]
    chosen = [labels[place + k] if place + k < size else OUTSIDE for k in (1, 2)]
    return [*left, *right, *chosen, vowel_groups(letters[place + 1 :]), vowel_groups(letters[:place])]


def answer(question: int, values: Sequence[int], sounds: Sequence[int]) -> bool:
    """The answer to a question of a letter with these features; `sounds` are those of all labels."""
    if question < _LABELS:
        place, what = divmod(question, 32)
        return values[place] == what if what < _FIRST_CLASS else values[place] in _MEMBERS[what - _FIRST_CLASS]
    if question < _RIGHT:
        which, what = divmod(question - _LABELS, 64)
        label = values[8 + which]
        if what == _VOWEL:
            return label != OUTSIDE and ends_in_vowel(sounds[label])
        if what == _PAIR:
            return label != OUTSIDE and len(phonemes_of(sounds[label])) == 2
        return label in (0, OUTSIDE) if what == _SILENT else label == what
    if question < _LEFT:
        return values[10] <= question - _RIGHT
    return values[11] <= question - _LEFT


class Asked:
    """All questions at once, for growing trees: which values of which feature are answered by yes."""

    def __init__(self, sounds: Sequence[int]) -> None:
        label = np.arange(64)
        known = label < len(sounds)
        self.feature = np.zeros(QUESTIONS, dtype=int)  #: (QUESTIONS,) the feature that each one looks at
        self.yes = np.zeros((QUESTIONS, 64), dtype=bool)  #: (QUESTIONS, 64) the answer for each value of it
        for question in range(QUESTIONS):
            if question < _LABELS:
                self.feature[question] = question // 32
            elif question < _RIGHT:
                self.feature[question] = 8 + (question - _LABELS) // 64
            else:
                self.feature[question] = 10 if question < _LEFT else 11
            for value in label:
                if not known[value] and value != OUTSIDE and self.feature[question] in (8, 9):
                    continue
                values = [int(value)] * FEATURES
                self.yes[question, value] = answer(question, values, sounds)

    def counts(self, histogram: np.ndarray) -> np.ndarray:
        """(QUESTIONS, L) of a `histogram` (FEATURES, 64, L), both of whole numbers: how many samples of each label
        answer yes. Sums of whole numbers are exact in float64, in which they are computed."""
        shape = histogram.shape[2]
        parts = [np.matmul(yes, histogram[first : first + len(yes)]).reshape(-1, shape) for first, yes in self._blocks]
        return np.concatenate(parts)

    @cached_property
    def _blocks(self) -> List[Tuple[int, np.ndarray]]:
        """The answers as matrices, with the first feature that they are about."""
        yes = self.yes.astype(float)
        return [(0, yes[:_LABELS].reshape(8, 32, 64)), (8, yes[_LABELS:_RIGHT].reshape(2, 64, 64)),
                (10, yes[_RIGHT:].reshape(2, 8, 64))]


assert len(LETTERS) == _FIRST_CLASS
