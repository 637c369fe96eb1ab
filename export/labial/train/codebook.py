"""The hidden Markov model of a channel (docs/method.md, States): an LBG codebook of human motion and its counts.

A frame's features are m, delta m = (m[t+1] - m[t-1]) / 2 and delta-delta m = m[t+1] - 2 m[t] + m[t-1]. The published
method clusters them unscaled; Labial's method divides each by its standard deviation over the corpus first. The
codebook is grown by binary splitting (Linde, Buzo and Gray 1980): each cell is split in two along its widest feature
and all are refined by Lloyd's iteration; if the size is not a power of two, the last round splits only the cells of
largest distortion.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, List, Sequence, Tuple

import numpy as np
from scipy.spatial import cKDTree

#: A split moves the two halves by this share of the cell's standard deviation, along its widest feature.
SPLIT = 0.5
#: Lloyd's iteration ends when the distortion falls by less than this share, or after MAXIMUM_ITERATIONS. Before the
#: last split a rougher solution does as well.
TOLERANCE = 1e-4
ROUGH_TOLERANCE = 1e-2
MAXIMUM_ITERATIONS = 60
#: A relative bound far above the rounding error of a distance.
_ROUNDING = 1e-9
#: Points whose distances to all centres are computed at once.
_BLOCK = 1024
#: Centres near a point's own that are tracked separately; all others count as far as the next one.
_NEAR = 4
#: Least variance of a state, as a share of the feature's variance over the corpus.
VARIANCE_FLOOR = 1e-3
#: Transitions and starts that were never counted have probability 0, except those that keep every state reachable: to
#: itself and to its neighbours in static mean, which get this count in addition.
NEIGHBOUR_COUNT = 0.5
#: Added to the starts of every state, in proportion to the state's frequency.
INITIAL_COUNT = 5.0


def features(motion: np.ndarray) -> np.ndarray:
    """(T, 3) m, delta m and delta-delta m of one channel's motion (T,); the ends repeat for the outer frames."""
    held = np.concatenate([motion[:1], motion, motion[-1:]])
    return np.stack([motion, (held[2:] - held[:-2]) / 2, held[2:] - 2 * motion + held[:-2]], axis=1)


def assign(points: np.ndarray, centres: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """(n,) the nearest centre of each of (n, D) points, and its squared distance."""
    distance, nearest = cKDTree(centres).query(points)
    return nearest.astype(np.int64), distance**2


class _Nearest:
    """:func:`assign` for centres that move a little from call to call (Lloyd's iteration), with the same results bit
    for bit. It skips points whose nearest centre cannot have changed. A point keeps its centre if that is nearer than
    any other centre can be (Hamerly 2010). Each point has a lower bound of the distance to its second nearest centre.
    Each call reduces it by the largest move of the centres near its own; farther centres are bounded by their distance
    from its own centre."""

    def __init__(self, points: np.ndarray) -> None:
        self._points = points
        self._columns = np.ascontiguousarray(points.T)
        self._longest = float(np.square(points).sum(axis=1).max())
        self._before = np.zeros((0, points.shape[1]))
        self._cell = np.zeros(len(points), dtype=np.int64)
        self._others = np.zeros(len(points))  # least distance of any other centre

    def __call__(self, centres: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
        """As :func:`assign`."""
        if len(centres) != len(self._before):
            self._cell[:] = 0
            distance, rows = np.zeros(len(self._cell)), np.arange(len(self._cell))
        else:
            distance = self._own(centres, self._columns, self._cell)
            self._let_move(centres, distance)
            rows = np.flatnonzero(distance >= self._others * (1 - _ROUNDING))
        if len(centres) > 1:
            self._search(centres, rows)
        distance[rows] = self._own(centres, self._columns[:, rows], self._cell[rows])
        self._before = centres.copy()
        return self._cell.copy(), np.square(distance, out=distance)

    def _let_move(self, centres: np.ndarray, distance: np.ndarray) -> None:
        """Updates the lower bounds of distances to other centres; `distance` (n,) is that of each point's own
        centre."""
        moved = np.sqrt(np.square(centres - self._before).sum(axis=1)) * (1 + _ROUNDING)
        apart = np.sqrt(np.square(centres[:, None] - centres).sum(axis=2))
        np.fill_diagonal(apart, -1.0)  # first, also where two centres are one
        order = np.argsort(apart, axis=1)[:, 1:]
        near, further = order[:, :_NEAR], order[:, _NEAR : _NEAR + 1]
        far = np.take_along_axis(apart, further, axis=1).min(axis=1, initial=np.inf)
        close = np.minimum(self._others - moved[near].max(axis=1, initial=0.0).take(self._cell),
                           far.take(self._cell) * (1 - _ROUNDING) - distance)
        self._others = np.maximum(self._others - moved.max(), close)

    def _search(self, centres: np.ndarray, rows: np.ndarray) -> None:
        """Finds the nearest centres of the points `rows`. Squared distances are matrix products, block by block, with
        the number of the centre in their last bits; nearer ties are left to :func:`assign`."""
        length = np.square(centres).sum(axis=1)[:, None]
        slack = 1e-3 * _ROUNDING * max(self._longest, float(length.max()))  # still far above the rounding error
        number = np.arange(len(centres), dtype=np.int64)[:, None]
        mask = (1 << len(centres).bit_length()) - 1
        factors = np.concatenate([-2.0 * centres, length + slack, np.ones((len(centres), 1))], axis=1)
        for block in np.array_split(rows, range(_BLOCK, len(rows), _BLOCK)):
            columns = self._columns[:, block]
            one, own = np.ones((1, len(block))), np.square(columns).sum(axis=0)[None]
            squares = factors @ np.concatenate([columns, one, own])
            packed = squares.view(np.int64)  # positive floats are ordered like their bits
            packed &= ~mask
            packed |= number
            nearest = squares.min(axis=0)
            self._cell[block] = cell = nearest.view(np.int64) & mask
            squares[cell, np.arange(len(block))] = np.inf
            second = squares.min(axis=0)
            self._others[block] = np.sqrt(np.maximum(second * (1 - _ROUNDING) - 2 * slack, 0.0))
            near = block[second * (1 - _ROUNDING) - 2 * slack <= nearest]
            if len(near):
                self._cell[near] = assign(self._points[near], centres)[0]

    @staticmethod
    def _own(centres: np.ndarray, columns: np.ndarray, cell: np.ndarray) -> np.ndarray:
        """(n,) distances of points, columns (D, n), to the centres of their cells (n,), summed in the order in which
        the tree sums."""
        total = np.zeros(len(cell))
        for column, place in zip(columns, centres.T):
            away = column - place.take(cell)
            total += np.multiply(away, away, out=away)
        return np.sqrt(total, out=total)


def _moments(points: np.ndarray, cell: np.ndarray, size: int) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Counts (size,), means and variances (size, D) of the points in each cell; zeros where a cell is empty."""
    count, mean = _means(points, cell, size)
    return count, mean, _means((points - mean[cell]) ** 2, cell, size)[1]


def _means(points: np.ndarray, cell: np.ndarray, size: int) -> Tuple[np.ndarray, np.ndarray]:
    """Counts (size,) and means (size, D) of the points in each cell; zeros where a cell is empty."""
    count = np.bincount(cell, minlength=size).astype(np.float64)
    total = np.stack([np.bincount(cell, weights=column, minlength=size) for column in points.T], axis=1)
    return count, total / np.maximum(count, 1)[:, None]


def lloyd(points: np.ndarray, centres: np.ndarray,
          tolerance: float = TOLERANCE) -> Tuple[np.ndarray, np.ndarray, float]:
    """Refines (Q, D) centres on (n, D) points. Returns centres, cells (n,) and the mean squared distance. A centre that
    loses all its points moves beside the centre of the cell with the largest distortion, which it splits."""
    before, nearest = np.inf, _Nearest(points)
    for _ in range(MAXIMUM_ITERATIONS):
        cell, distance = nearest(centres)
        count, mean = _means(points, cell, len(centres))
        distortion = float(distance.mean())
        empty = np.flatnonzero(count == 0)
        if not len(empty) and before - distortion <= tolerance * distortion:
            return centres, cell, distortion
        before = np.inf if len(empty) else distortion
        centres = mean
        if len(empty):
            variance = _moments(points, cell, len(centres))[2]
            load = count * variance.sum(axis=1)
        for lost in empty:
            widest = int(load.argmax())
            axis = int(variance[widest].argmax())
            if load[widest] <= 0:
                break  # fewer different points than centres: the other cells stay empty
            centres[lost] = centres[widest]
            centres[lost, axis] += SPLIT * np.sqrt(variance[widest, axis])
            load[widest] = 0
    cell, distance = nearest(centres)
    return centres, cell, float(distance.mean())


def lbg(points: np.ndarray, size: int) -> Tuple[np.ndarray, np.ndarray, float]:
    """The codebook of `size` centres for (n, D) points: centres (size, D), cells (n,), mean squared distance."""
    centres, cell, distortion = lloyd(points, points.mean(axis=0, keepdims=True))
    while len(centres) < size:
        count, mean, variance = _moments(points, cell, len(centres))
        split = np.argsort(-(count * variance.sum(axis=1)), kind="stable")[: min(len(centres), size - len(centres))]
        axis = variance[split].argmax(axis=1)
        step = np.zeros((len(split), points.shape[1]))
        step[np.arange(len(split)), axis] = SPLIT * np.sqrt(variance[split, axis])
        grown = centres.copy()
        grown[split] -= step
        grown = np.concatenate([grown, centres[split] + step])
        centres, cell, distortion = lloyd(points, grown, TOLERANCE if len(grown) == size else ROUGH_TOLERANCE)
    return centres, cell, distortion


#: A function that divides points into cells like :func:`lbg`; a caching one saves time if the same motion recurs.
Division = Callable[[np.ndarray, int], Tuple[np.ndarray, np.ndarray, float]]


@dataclass(frozen=True)
class Codebook:
    """One channel's states in the order of their static means."""

    mean: np.ndarray  #: (Q, 3) of m, delta m, delta-delta m, FAP (per frame, per frame^2)
    variance: np.ndarray  #: (Q, 3)
    count: np.ndarray  #: (Q,) training frames
    log_transition: np.ndarray  #: (Q, Q) [from, to]
    log_initial: np.ndarray  #: (Q,)


def transitions(paths: Sequence[np.ndarray], size: int, stride: int = 1) -> np.ndarray:
    """(Q, Q) log-probabilities [from, to] of going from the state of a frame to that `stride` frames later, from the
    counts of state paths; see NEIGHBOUR_COUNT for the smoothing."""
    counts = np.zeros((size, size))
    for path in paths:
        np.add.at(counts, (path[:-stride], path[stride:]), 1)
    counts += NEIGHBOUR_COUNT * (np.abs(np.subtract.outer(np.arange(size), np.arange(size))) <= 1)
    with np.errstate(divide="ignore"):
        return np.log(counts / counts.sum(axis=1, keepdims=True))


def initials(paths: Sequence[np.ndarray], starts: Sequence[np.ndarray], size: int) -> np.ndarray:
    """(Q,) log-probabilities of the states at the frames `starts` of each path, where units begin."""
    occurring = np.sum([np.bincount(path, minlength=size) for path in paths], axis=0) + 1.0
    counts = INITIAL_COUNT * occurring / occurring.sum()
    for path, start in zip(paths, starts):
        counts = counts + np.bincount(path[start], minlength=size)
    return np.log(counts / counts.sum())


def train_channel(motion: Sequence[np.ndarray], starts: Sequence[np.ndarray], size: int, stride: int = 1,
                  divide: Division = lbg, normalised: bool = True) -> Codebook:
    """The codebook of one channel. `motion` holds the channel's human motion (T,) of every sequence in FAP, `starts`
    the frames at which boundary phonemes, and so units, begin; `stride` is how many frames a transition spans. Features
    are `normalised` by their standard deviations before they are clustered, or clustered as they are, in FAP units per
    frame and frame squared."""
    points = np.concatenate([features(item) for item in motion])
    overall = points.var(axis=0)
    scale = np.where(normalised & (overall > 1e-12), np.sqrt(overall), 1.0)
    _, cell, _ = divide(points / scale, size)
    count, mean, variance = _moments(points, cell, size)
    for values in (mean, variance):
        values[count == 0] = values[count.argmax()]  # where motion has fewer different values than there are cells
    variance = np.maximum(variance, np.maximum(VARIANCE_FLOOR * overall, 1e-6))
    order = np.lexsort((mean[:, 2], mean[:, 1], mean[:, 0]))
    paths: List[np.ndarray] = np.split(np.argsort(order)[cell], np.cumsum([len(item) for item in motion])[:-1])
    return Codebook(mean=mean[order], variance=variance[order], count=count[order],
                    log_transition=transitions(paths, size, stride), log_initial=initials(paths, starts, size))
