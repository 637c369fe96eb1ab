"""Aligns letters with phonemes: each letter sounds as nothing, one phoneme or two.

The probability of each sound of a letter is learnt from all alignments of all words, weighted by their probability
(expectation maximisation), so that no table of allowed pairs is made by hand and nothing depends on chance. Pairs of
phonemes that remain rare are removed on the way; each word then takes its most probable alignment.

A *sound* is numbered: 0 nothing, p phoneme p, PAIR + PAIR * p + q the phonemes p and q.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, List, Optional, Sequence, Tuple

import numpy as np

from labial.words.dictionary import LETTERS, PHONEMES, Entry

#: Base of the numbers of pairs.
PAIR = len(PHONEMES)
SOUNDS = PAIR + PAIR * PAIR
#: Rounds of learning; from which round on a pair must be expected so many times, and a single phoneme of a letter 3.
_ROUNDS = 14
_RARE_PAIRS = {6: 30.0, 9: 80.0}
_RARE_SINGLE = (9, 3.0)
#: Of a sound that a letter never has, where a word cannot be aligned otherwise.
_LOOSE = 1e-9
#: Probabilities to begin with.
_START = {"silent": 0.2, "single": 0.02, "pair": 0.0002}


def phonemes_of(sound: int) -> Tuple[int, ...]:
    """The phonemes of a sound: none, one or two."""
    if sound == 0:
        return ()
    return (sound,) if sound < PAIR else divmod(sound - PAIR, PAIR)


@dataclass(frozen=True)
class _Group:
    """Entries of n letters and m phonemes, B of them."""

    index: np.ndarray  #: (B,) places of the entries
    letters: np.ndarray  #: (B, n)
    sounds: Tuple[np.ndarray, np.ndarray, np.ndarray]  #: of 0, 1 and 2 phonemes from each on: (B, m + 1), (B, m), ...

    @property
    def sizes(self) -> Tuple[int, int, int]:
        """B, n and m."""
        return (*self.letters.shape, self.sounds[1].shape[1])

    def of_letter(self, probability: np.ndarray, letter: int) -> List[np.ndarray]:
        """The probabilities of each sound of the letters at one place, shaped as `sounds`."""
        return [probability[self.letters[:, letter, None], sounds] for sounds in self.sounds]


def _groups(entries: Sequence[Entry]) -> List[_Group]:
    places: Dict[Tuple[int, int], List[int]] = {}
    for place, entry in enumerate(entries):
        places.setdefault((len(entry.letters), len(entry.phonemes)), []).append(place)
    groups = []
    for (_, m), index in sorted(places.items()):
        letters = np.array([entries[i].letters for i in index])
        phonemes = np.array([entries[i].phonemes for i in index])
        pairs = PAIR + PAIR * phonemes[:, :-1] + phonemes[:, 1:]
        groups.append(_Group(np.array(index), letters, (np.zeros((len(index), m + 1), dtype=int), phonemes, pairs)))
    return groups


def _expected(group: _Group, probability: np.ndarray, counts: np.ndarray) -> None:
    """Adds to `counts` (letters * SOUNDS,) how often each letter is expected to sound as what."""
    size, n, m = group.sizes
    emissions = [group.of_letter(probability, a) for a in range(n)]
    forward = np.zeros((n + 1, size, m + 1))
    forward[0, :, 0] = 1.0
    for a in range(n):
        for k in range(min(2, m) + 1):
            forward[a + 1, :, k:] += forward[a, :, : m + 1 - k] * emissions[a][k]
    total = forward[n, :, m]
    backward = np.zeros((size, m + 1))
    backward[:, m] = np.divide(1.0, total, out=np.zeros(size), where=total > 0.0)
    for a in reversed(range(n)):
        before = np.zeros_like(backward)
        for k in range(min(2, m) + 1):
            reached = emissions[a][k] * backward[:, k:]
            before[:, : m + 1 - k] += reached
            place = group.letters[:, a, None] * SOUNDS + group.sounds[k]
            counts += np.bincount(place.ravel(), (forward[a, :, : m + 1 - k] * reached).ravel(), len(counts))
        backward = before


def learn(entries: Sequence[Entry]) -> np.ndarray:
    """(letters, SOUNDS) the probability of each sound of each letter; rows sum to 1, that of letter 0 is empty."""
    probability = np.full((len(LETTERS), SOUNDS), _START["pair"])
    probability[:, :PAIR] = _START["single"]
    probability[:, 0] = _START["silent"]
    groups = _groups(entries)
    for round_ in range(_ROUNDS):
        counts = np.zeros(probability.size)
        for group in groups:
            _expected(group, probability, counts)
        table = counts.reshape(probability.shape)
        rare = max([0.0, *(least for since, least in _RARE_PAIRS.items() if round_ >= since)])
        table[:, PAIR:][table[:, PAIR:] < rare] = 0.0
        if round_ >= _RARE_SINGLE[0]:
            table[:, 1:PAIR][table[:, 1:PAIR] < _RARE_SINGLE[1]] = 0.0
        table[0] = 0.0
        probability = table / np.maximum(table.sum(axis=1, keepdims=True), 1e-300)
    return probability


def loosened(probability: np.ndarray, sounds: Sequence[int]) -> np.ndarray:
    """(letters, SOUNDS) the same, but any letter may be any of `sounds`, where nothing more probable is possible."""
    loose = probability.copy()
    loose[:, list(sounds)] = np.maximum(loose[:, list(sounds)], _LOOSE)
    return loose


def align(entries: Sequence[Entry], probability: np.ndarray) -> List[Optional[Tuple[int, ...]]]:
    """The most probable sounds of each entry's letters, or None where no alignment is possible."""
    result: List[Optional[Tuple[int, ...]]] = [None] * len(entries)
    with np.errstate(divide="ignore"):
        logarithm = np.log(probability)
    for group in _groups(entries):
        size, n, m = group.sizes
        best = np.full((size, m + 1), -np.inf)
        best[:, 0] = 0.0
        taken = np.zeros((n, size, m + 1), dtype=np.int8)
        for a in range(n):
            cost = group.of_letter(logarithm, a)
            after = np.full_like(best, -np.inf)
            for k in range(min(2, m) + 1):
                reached = best[:, : m + 1 - k] + cost[k]
                better = reached > after[:, k:]
                after[:, k:][better] = reached[better]
                taken[a, :, k:][better] = k
            best = after
        place, sounds, rows = np.full(size, m), np.zeros((size, n), dtype=int), np.arange(size)
        for a in reversed(range(n)):
            k = taken[a, rows, place]
            place -= k
            for count in range(min(2, m) + 1):
                sounds[k == count, a] = group.sounds[count][k == count, place[k == count]]
        for row, entry in enumerate(group.index.tolist()):
            if np.isfinite(best[row, m]):
                result[entry] = tuple(sounds[row].tolist())
    return result
