"""The shape of each phoneme, and what its neighbours' kernels add to it frame by frame (``lib/shape.c``)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Tuple, Union

import numpy as np

if TYPE_CHECKING:
    from labial.tables.model import Model

#: Durations farther than this many standard deviations from a component's mean change its shape no more.
SLOPE_LIMIT = 3.0


@dataclass(frozen=True)
class ShapeTables:
    """The mixtures of P phonemes as the run-time reads them: N components, phoneme by phoneme. A
    :class:`labial.tables.model.Model` has the same members, and will do as well."""

    component_count: np.ndarray  #: (P,) int64
    log_weight: np.ndarray  #: (N,)
    duration_mean: np.ndarray  #: (N,) seconds
    duration_variance: np.ndarray  #: (N,) seconds squared
    shape: np.ndarray  #: (N, C) FAP
    slope: np.ndarray  #: (N, C) FAP per second
    log_previous: np.ndarray  #: (N, V) or (N, 0)
    log_next: np.ndarray  #: (N, V) or (N, 0)


@dataclass(frozen=True)
class Choice:
    """How (S,) phoneme occurrences share the components; a shape is the sum of share * (shape_c + slope_c * offset)."""

    component: np.ndarray  #: (S, K) int64
    share: np.ndarray  #: (S, K), sums to 1; 0 beyond a phoneme's own components
    offset: np.ndarray  #: (S, K) seconds from the component's mean duration, at most SLOPE_LIMIT deviations

    def of(self, rows: Union[slice, np.ndarray]) -> Choice:
        """That of some of the occurrences."""
        return Choice(self.component[rows], self.share[rows], self.offset[rows])


def choose(mixtures: Union[ShapeTables, Model], phoneme: np.ndarray, duration: np.ndarray, previous: np.ndarray,
           following: np.ndarray, *, soft: bool) -> Choice:
    """Equation 2 for (S,) phonemes with durations in seconds and neighbours' viseme classes: the best component alone,
    or with `soft` all by their probability."""
    first = np.concatenate([[0], np.cumsum(mixtures.component_count)])
    count = mixtures.component_count[phoneme][:, None]
    rank = np.arange(int(mixtures.component_count.max()))
    component = first[phoneme][:, None] + np.where(rank < count, rank, 0)
    variance = mixtures.duration_variance[component]
    offset = duration[:, None] - mixtures.duration_mean[component]
    score = mixtures.log_weight[component] - 0.5 * (np.log(2 * np.pi * variance) + offset**2 / variance)
    if mixtures.log_previous.shape[1]:
        score = score + mixtures.log_previous[component, previous[:, None]]
        score = score + mixtures.log_next[component, following[:, None]]
    score = np.where(rank < count, score, -np.inf)
    likelihood = np.exp(score - score.max(axis=1, keepdims=True))
    share = likelihood / likelihood.sum(axis=1, keepdims=True) if soft else np.eye(len(rank))[score.argmax(axis=1)]
    reach = SLOPE_LIMIT * np.sqrt(variance)
    return Choice(component, share, np.clip(offset, -reach, reach))


def shapes(mixtures: Union[ShapeTables, Model], choice: Choice) -> np.ndarray:
    """(S, C) the selected shapes, FAP."""
    each = mixtures.shape[choice.component] + mixtures.slope[choice.component] * choice.offset[..., None]
    return np.einsum("sk,skj->sj", choice.share, each)


def neighbours(phoneme: np.ndarray, silence: int) -> Tuple[np.ndarray, np.ndarray]:
    """The phonemes before and after each of (S,) phonemes; silence lies beyond both ends."""
    padded = np.concatenate([[silence], phoneme, [silence]])
    return padded[:-2], padded[2:]


def pairs_beside(key: np.ndarray, shape: np.ndarray, phoneme: np.ndarray, previous: np.ndarray,
                 following: np.ndarray) -> np.ndarray:
    """(S, K, C) FAP: what the neighbours of (S,) phonemes add to their shapes, from pairs `key` (R, 3), phoneme, side
    and neighbour, with shapes (R, K, C)."""
    rows = {tuple(each): row for row, each in enumerate(key.tolist())}
    added = np.zeros((len(phoneme), *shape.shape[1:]))
    for side, others in enumerate((previous, following)):
        for i, each in enumerate(zip(phoneme.tolist(), [side] * len(others), others.tolist())):
            if each in rows:
                added[i] += shape[rows[each]]
    return added


def add_kernels(shape_at: np.ndarray, phoneme_at: np.ndarray, kernel: np.ndarray, lag: np.ndarray,
                silence: int) -> np.ndarray:
    """(T, C) the moving target: the frames' shapes (T, C) plus their neighbours' kernels (P, L, C), FAP."""
    if not len(lag):
        return shape_at
    return shape_at + kernel[tapped(phoneme_at, lag, silence), np.arange(len(lag))].sum(axis=1)


def tapped(phoneme_at: np.ndarray, lag: np.ndarray, silence: int, here: slice = slice(None)) -> np.ndarray:
    """(N, L) int64: the phoneme at each lag from each of T frames, or of those `here`; `silence` outside the
    utterance."""
    at = np.arange(len(phoneme_at))[here, None] + lag[None, :]
    inside = (at >= 0) & (at < len(phoneme_at))
    return np.where(inside, phoneme_at[np.clip(at, 0, max(len(phoneme_at) - 1, 0))], silence)


def knot_shares(length: np.ndarray, knots: int) -> np.ndarray:
    """(T, K) the shares of K knots in each frame of phonemes of `length` (S,) frames: all of the one knot there is, or
    of the first of two 1 - w, of the second w = (2 j + 1) / (2 n) in frame j of n, which is linear in time."""
    if knots == 1:
        return np.ones((int(np.sum(length)), 1))
    frame = np.arange(int(np.sum(length))) - np.repeat(np.cumsum(length) - length, length)
    share = (2 * frame + 1) / (2 * np.repeat(length, length))
    return np.stack([1.0 - share, share], axis=1)
