"""Decision trees: one for each letter, which gives it a label (what it sounds like).

A tree grows by the question with the highest information gain, and is cut back where a leaf costs more than the errors
that it avoids. One price per leaf holds for all trees; it is chosen so that as many leaves remain as are wanted.
Weights are whole numbers and the logarithms of the gains are rounded to 2^-24, so that gains are exact sums and equal
questions tie on every machine; the first one wins.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import List, Sequence, Tuple

import numpy as np

from labial.errors import ModelError
from labial.words.questions import FEATURES, Asked

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
    """A tree in the making."""

    def __init__(self, samples: Samples, asked: Asked) -> None:
        self.asked = asked
        self.present = np.unique(samples.labels)
        self.samples = samples
        self.local = np.searchsorted(self.present, samples.labels)
        self.nodes: List[List[int]] = []
        total = int(samples.weights.sum())
        numbers = np.arange(total + 1, dtype=float)
        self.bits = np.rint(_SCALE * numbers * np.log(np.maximum(numbers, 1.0))).astype(np.int64)
        size = len(self.present)
        base = (np.arange(FEATURES) * 64 + samples.features.astype(np.int64)) * size
        self.cells = base + self.local[:, None]

    def impurity(self, counts: np.ndarray) -> np.ndarray:
        """The entropy of counts along the last axis, times their sum."""
        return np.asarray(self.bits[counts.sum(axis=-1)] - self.bits[counts].sum(axis=-1))

    def split(self, rows: np.ndarray, here: np.ndarray) -> Tuple[int, np.ndarray]:
        """The best question about the samples `rows`, -1 for none, and which of them answer yes."""
        weights = self.samples.weights[rows]
        shape = (FEATURES, 64, len(self.present))
        histogram = np.bincount(self.cells[rows].ravel(), np.repeat(weights, FEATURES), FEATURES * 64 * shape[2])
        yes = self.asked.counts(histogram.reshape(shape)).astype(np.int64)
        no = here - yes
        sums = yes.sum(axis=1)
        gain = self.impurity(here) - self.impurity(yes) - self.impurity(no)
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
        node = [-1, 0, 0, int(self.present[label]), errors]
        number = len(self.nodes)
        self.nodes.append(node)
        if errors <= _CHEAP or depth >= _DEEPEST:
            return number
        question, is_yes = self.split(rows, here)
        if question >= 0:
            node[0] = question
            node[1] = self.grow(rows[is_yes], depth + 1)
            node[2] = self.grow(rows[~is_yes], depth + 1)
        return number


def grow(samples: Samples, asked: Asked) -> Tree:
    """The full tree of a letter."""
    growth = _Growth(samples, asked)
    growth.grow(np.arange(len(samples.labels)))
    return Tree(*np.array(growth.nodes, dtype=np.int64).T)


def _kept(tree: Tree, price: float) -> Tuple[np.ndarray, int]:
    """Which nodes remain split at a price per leaf, and how many leaves that leaves."""
    question, yes, no, errors = (item.tolist() for item in (tree.question, tree.yes, tree.no, tree.errors))
    cost = [float(value) for value in errors]
    leaves = [1] * len(errors)
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
        number = len(nodes)
        nodes.append([-1, 0, 0, int(tree.label[node]), int(tree.errors[node])])
        if split[node]:
            nodes[number][0] = int(tree.question[node])
            nodes[number][1] = take(int(tree.yes[node]))
            nodes[number][2] = take(int(tree.no[node]))
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
        if sum(_kept(tree, price)[1] for tree in trees) > leaves:
            low = price
        else:
            high = price
    if low > 0.0 and high < _CHEAP:
        raise ModelError(f"{leaves} leaves are more than these words can give: choose fewer")
    return [_cut(tree, _kept(tree, high)[0]) for tree in trees]
