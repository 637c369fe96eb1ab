"""Decision trees: one for each letter, which gives it a label (what it sounds like).

A tree grows by the question with the highest information gain, and is cut back where a leaf costs more than the errors
that it avoids. One price per leaf holds for all trees; it is chosen so that as many leaves remain as are wanted.
Weights are whole numbers and the logarithms of the gains are rounded to 2^-24, so that gains are exact sums and equal
questions tie on every machine; the first one wins.

Words are read from their last letter to their first. What a tree may ask about a letter is a number, 0 .. 399, and
needs no table:

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

from dataclasses import dataclass
from functools import cached_property
from typing import List, Sequence, Tuple

import numpy as np

from labial.corpus.phonesets import VOWELS
from labial.errors import ModelError
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
_VOWEL_PHONEMES = frozenset(PHONEMES.index(name) for name in VOWELS.split())


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
        #: (QUESTIONS,) the feature that each one looks at
        self.feature = np.repeat(np.arange(FEATURES), [32] * 8 + [64] * 2 + [8] * 2)
        self.yes = np.zeros((QUESTIONS, 64), dtype=bool)  #: (QUESTIONS, 64) the answer for each value of it
        for question, feature in enumerate(self.feature):
            for value in range(64):
                if value < len(sounds) or value == OUTSIDE or feature not in (8, 9):
                    self.yes[question, value] = answer(question, [value] * FEATURES, sounds)

    def counts(self, histogram: np.ndarray) -> np.ndarray:
        """(QUESTIONS, L) of a `histogram` (FEATURES, 64, L), both of whole numbers: how many samples of each label
        answer yes. Sums of whole numbers are exact in float64, in which they are computed."""
        return np.concatenate([np.matmul(yes, histogram[first : first + len(yes)]).reshape(-1, histogram.shape[2])
                               for first, yes in self._blocks])

    @cached_property
    def _blocks(self) -> List[Tuple[int, np.ndarray]]:
        """The answers as matrices, with the first feature that they are about."""
        yes = self.yes.astype(float)
        return [(0, yes[:_LABELS].reshape(8, 32, 64)), (8, yes[_LABELS:_RIGHT].reshape(2, 64, 64)),
                (10, yes[_RIGHT:].reshape(2, 8, 64))]


assert len(LETTERS) == _FIRST_CLASS


#: Weight of a word's first pronunciation and of any other; a leaf needs as much as a first one.
FIRST, OTHER = 4, 2
_LEAST = FIRST
#: Nodes with no more errors than this are not split: the price of a leaf turns out higher, which is checked.
_CHEAP = FIRST
_DEEPEST = 60
_SCALE = float(1 << 24)


@dataclass(frozen=True)
class Samples:
    """All samples of one letter."""

    features: np.ndarray  #: (N, FEATURES) uint8
    labels: np.ndarray  #: (N,) which of all labels the letter has
    weights: np.ndarray  #: (N,) FIRST or OTHER


@dataclass(frozen=True)
class Tree:
    """The nodes of a tree, each before those below it; node 0 is the root.

    A leaf has question -1 and its label; another node has the nodes to go to.
    """

    question: np.ndarray  #: (K,) int
    yes: np.ndarray  #: (K,) int
    no: np.ndarray  #: (K,) int
    label: np.ndarray  #: (K,) int, the most frequent label below the node
    errors: np.ndarray  #: (K,) int, the weight of the samples below the node that have another label


class _Growth:
    def __init__(self, samples: Samples, asked: Asked) -> None:
        self.asked, self.samples = asked, samples
        self.present, self.local = np.unique(samples.labels, return_inverse=True)
        self.nodes: List[List[int]] = []
        numbers = np.arange(int(samples.weights.sum()) + 1, dtype=float)
        self.bits = np.rint(_SCALE * numbers * np.log(np.maximum(numbers, 1.0))).astype(np.int64)
        base = (np.arange(FEATURES) * 64 + samples.features.astype(np.int64)) * len(self.present)
        self.cells = base + self.local[:, None]

    def impurity(self, counts: np.ndarray) -> np.ndarray:
        """The entropy of counts along the last axis, times their sum."""
        return np.asarray(self.bits[counts.sum(axis=-1)] - self.bits[counts].sum(axis=-1))

    def split(self, rows: np.ndarray, here: np.ndarray) -> Tuple[int, np.ndarray]:
        """The best question about the samples `rows`, -1 for none, and which of them answer yes."""
        weights = np.repeat(self.samples.weights[rows], FEATURES)
        histogram = np.bincount(self.cells[rows].ravel(), weights, FEATURES * 64 * len(here))
        yes = self.asked.counts(histogram.reshape(FEATURES, 64, len(here))).astype(np.int64)
        sums = yes.sum(axis=1)
        gain = self.impurity(here) - self.impurity(yes) - self.impurity(here - yes)
        gain[(sums < _LEAST) | (here.sum() - sums < _LEAST)] = -1
        best = int(np.argmax(gain))
        if gain[best] <= 0:
            return -1, rows[:0]
        return best, self.asked.yes[best, self.samples.features[rows, self.asked.feature[best]]]

    def grow(self, rows: np.ndarray, depth: int = 0) -> int:
        """Adds the node of the samples `rows` and those below it; returns its number."""
        here = np.bincount(self.local[rows], self.samples.weights[rows], len(self.present)).astype(np.int64)
        label = int(np.argmax(here))
        errors = int(here.sum() - here[label])
        node, number = [-1, 0, 0, int(self.present[label]), errors], len(self.nodes)
        self.nodes.append(node)
        if errors > _CHEAP and depth < _DEEPEST:
            question, is_yes = self.split(rows, here)
            if question >= 0:
                node[:3] = question, self.grow(rows[is_yes], depth + 1), self.grow(rows[~is_yes], depth + 1)
        return number


def grow(samples: Samples, asked: Asked) -> Tree:
    """The full tree of a letter."""
    growth = _Growth(samples, asked)
    growth.grow(np.arange(len(samples.labels)))
    return Tree(*np.array(growth.nodes, dtype=np.int64).T)


def _kept(tree: Tree, price: float) -> Tuple[np.ndarray, int]:
    """Which nodes remain split at a price per leaf, and how many leaves that leaves."""
    question, yes, no, errors = (item.tolist() for item in (tree.question, tree.yes, tree.no, tree.errors))
    cost, leaves = list(map(float, errors)), [1] * len(errors)
    split = np.zeros(len(errors), dtype=bool)
    for node in reversed(range(len(errors))):
        if question[node] < 0:
            continue
        below = leaves[yes[node]] + leaves[no[node]]
        reached = cost[yes[node]] + cost[no[node]]
        if errors[node] > reached + price * (below - 1):
            cost[node], leaves[node], split[node] = reached, below, True
    return split, leaves[0]


def _cut(tree: Tree, split: np.ndarray) -> Tree:
    """The tree without what lies below nodes that are not split."""
    nodes: List[List[int]] = []

    def take(node: int) -> int:
        row, number = [-1, 0, 0, int(tree.label[node]), int(tree.errors[node])], len(nodes)
        nodes.append(row)
        if split[node]:
            row[:3] = int(tree.question[node]), take(int(tree.yes[node])), take(int(tree.no[node]))
        return number

    take(0)
    return Tree(*np.array(nodes, dtype=np.int64).T)


def prune(trees: Sequence[Tree], leaves: int) -> List[Tree]:
    """The trees cut back at one price per leaf, the lowest that leaves at most `leaves` leaves in all.

    Raises ModelError if that price is so low that the trees should have grown further.
    """
    low, high = 0.0, float(1 + max(int(tree.errors[0]) for tree in trees))
    for _ in range(24):
        price = (low + high) / 2
        is_low = sum(_kept(tree, price)[1] for tree in trees) > leaves
        low, high = (price, high) if is_low else (low, price)
    if low > 0.0 and high < _CHEAP:
        raise ModelError(f"{leaves} leaves are more than these words can give: choose fewer")
    return [_cut(tree, _kept(tree, high)[0]) for tree in trees]
