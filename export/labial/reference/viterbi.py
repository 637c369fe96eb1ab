"""The Viterbi search for a state path, decided as the frames come (docs/method.md, Units and search;
``lib/viterbi.c``).

Each channel has a state for every `stride` frames, a *block*, and a grid of its own: a block ends with every frame k
for which k and the channel's number leave the same remainder by `stride`, and with the last frame. So in each tick some
of the channels take a step. A step scores a window of states, those around the one whose mean is nearest to the target;
states are sorted by mean. Without a lag, a frame's state is the best one of its block. With a lag, it is found by
tracing back from the best state of the block some frames later, or at the unit's end. Scores continue from block to
block, but at the end of a unit only its best state is kept.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, List, Optional, Sequence

import numpy as np

from labial.faps import CHANNELS
from labial.fixed import COST_SCALE, LEAP, SEARCHED

#: The library's default of LABIAL_LAG, frames.
LAG = 0

_CHANNEL = np.arange(CHANNELS)


@dataclass(frozen=True)
class Chains:
    """What the search sees of the 13 channels' hidden Markov models. Costs are negative log-probabilities, inf forbids.

    `emission` gives the costs (..., 13, W) of states (..., 13, W) for targets (..., 13). Any state can be entered from
    the best one of the step before at the cost `leap`; scores are held to it.
    """

    mean: np.ndarray  #: (13, Q) ascending
    transition: np.ndarray  #: (13, Q, Q) [from, to]
    initial: np.ndarray  #: (13, Q)
    leap: float
    emission: Callable[[np.ndarray, np.ndarray], np.ndarray]


def normal_chains(
    mean: np.ndarray, variance: np.ndarray, log_transition: np.ndarray, log_initial: np.ndarray
) -> Chains:
    """The chains, in nats, of states that are Gaussians of these means and variances (13, Q), but for the constant."""

    def emission(targets: np.ndarray, states: np.ndarray) -> np.ndarray:
        own = _CHANNEL[:, None], states
        return 0.5 * ((targets[..., None] - mean[own]) ** 2 / variance[own] + np.log(variance[own]))

    return Chains(mean, -log_transition, -log_initial, LEAP / COST_SCALE, emission)


def block_at(frames: int, stride: int, begin: int = 0) -> np.ndarray:
    """(T, 13) int64: the block of each frame, per channel, of a solution whose first frame is the stream's `begin`."""
    return _blocks_of(np.arange(frames), stride, begin)


def _blocks_of(frame: np.ndarray, stride: int, begin: int = 0) -> np.ndarray:
    """(T, 13) int64: :func:`block_at` of the frames (T,)."""
    return np.maximum(-(((_CHANNEL - begin) % stride - frame[:, None]) // stride), 0)


def block_ends(frames: int, stride: int, channel: int) -> np.ndarray:
    """(B,) int64: the last frames of a channel's blocks."""
    return np.append(np.arange(channel % stride, frames - 1, stride), frames - 1)


def looked_at(frames: int, stride: int, blocks: int, begin: int = 0) -> np.ndarray:
    """(B, 13) int64: the frames whose targets the search sees: the middle ones of whole blocks, or the later of two."""
    end = (_CHANNEL - begin) % stride + stride * np.arange(blocks)[:, None]
    return np.clip(end - stride + 1 + stride // 2, 0, frames - 1)


def window(position: np.ndarray, mean: np.ndarray, width: int) -> np.ndarray:
    """(..., 13) int64: the first of the `width` states that are scored for targets (..., 13), given means (13, Q)."""
    states = mean.shape[1]
    above = (mean < position[..., None]).sum(axis=-1)
    upper = mean[_CHANNEL, np.minimum(above, states - 1)]
    lower = mean[_CHANNEL, np.maximum(above - 1, 0)]
    is_upper = (above < states) & ((above == 0) | (upper - position < position - lower))
    return np.clip(np.where(is_upper, above, above - 1) - width // 2, 0, states - width)


@dataclass(frozen=True)
class Search:
    """What the search of B blocks of N utterances found."""

    first: np.ndarray  #: (B, N, 13) the first state of each window
    winner: np.ndarray  #: (B, N, 13) the best one's place in it
    back: np.ndarray  #: (B, N, 13, W) each one's predecessor's place in the window of the block before
    score: np.ndarray  #: (N, 13, W) those of the last block's window

    def path(self, lag: int) -> np.ndarray:
        """(B, N, 13) int64: the states from which the best of `lag` blocks later, or of the last block, come. A unit's
        end leaves its best alone, so that all later ones come from it."""
        result = np.empty_like(self.winner)
        for b in range(len(result)):
            last = min(b + lag, len(result) - 1)
            place = self.winner[last]
            for later in range(last, b, -1):
                place = np.take_along_axis(self.back[later], place[..., None], axis=-1)[..., 0]
            result[b] = self.first[b] + place
        return result


def search(
    chains: Chains, position: np.ndarray, closed: np.ndarray, searched: int = SEARCHED, before: Optional[Search] = None
) -> Search:
    """The search of B blocks of N utterances, for the targets (B, N, 13) that are looked at.

    `closed` (B, N, 13) says which blocks end a unit. Of the edges into a state the least wins, the first of equals, a
    leap before all; of states the least, the first of equals. `before` is the search of the blocks before these.
    """
    width = min(searched, chains.mean.shape[1])
    rank = np.arange(width)
    first = window(position, chains.mean, width)
    winner = np.zeros(position.shape, dtype=np.int64)
    back = np.zeros((*position.shape, width), dtype=np.int64)
    score = state = best = None
    if before is not None:
        score, state, best = before.score, before.first[-1][..., None] + rank, before.winner[-1]
    for b in range(len(position)):
        left, state = state, first[b][..., None] + rank
        if left is None:
            enter = chains.initial[_CHANNEL[:, None], state]
        else:
            edges = chains.transition[_CHANNEL[:, None, None], left[..., :, None], state[..., None, :]]
            through = score[..., :, None] + edges
            origin = through.argmin(axis=-2)
            least = np.take_along_axis(through, origin[..., None, :], axis=-2)[..., 0, :]
            leaps = least >= chains.leap
            back[b] = np.where(leaps, best[..., None], origin)
            enter = np.where(leaps, chains.leap, least)
        total = enter + chains.emission(position[b], state)
        best = winner[b] = total.argmin(axis=-1)
        score = np.minimum(total - total.min(axis=-1, keepdims=True), chains.leap)
        score[closed[b][..., None] & (rank != winner[b][..., None])] = chains.leap
    return Search(first, winner, back, score)


class Decode:
    """:func:`decode` of one utterance whose targets come in parts, without a lag."""

    def __init__(self, chains: Chains, stride: int, searched: int = SEARCHED) -> None:
        self._chains, self._stride, self._searched = chains, stride, searched
        self._target = np.zeros((0, CHANNELS))
        self._end = np.zeros(0, dtype=bool)
        self._begin = 0  # the frame that these begin with, the first one whose state is not told
        self._blocks = 0  # that are searched
        self._found: Optional[Search] = None

    def take(self, target: np.ndarray, end: np.ndarray, last: bool) -> np.ndarray:
        """(n, 13) int64: the states of the next frames, those whose blocks are complete, or of all that are left; for
        the next targets (T, 13), of a frame or more, and which of them (T,) end units."""
        # A block is searched when it is complete in all channels.
        target = np.concatenate([self._target, target]) if len(self._target) else target
        end = np.concatenate([self._end, end])
        known = self._begin + len(target)
        number = _blocks_of(np.arange(self._begin, known), self._stride)
        blocks = int(number.max()) + 1 if last else known // self._stride
        until = known if last else max(self._stride * (blocks - 1) + 1, 0)
        path = np.zeros((0, CHANNELS), dtype=np.int64)
        if until > self._begin:
            block = np.arange(self._blocks, blocks)[:, None]
            seen = np.clip(_CHANNEL % self._stride + self._stride * (block - 1) + 1 + self._stride // 2,
                           self._begin, known - 1) - self._begin
            closed = np.zeros((len(block), 1, CHANNELS), dtype=bool)
            ending = number[np.flatnonzero(end)]
            inside = (ending >= self._blocks) & (ending < blocks)
            closed[ending[inside] - self._blocks, 0, np.nonzero(inside)[1]] = True
            before, position = self._found, np.take_along_axis(target, seen, axis=0)[:, None]
            self._found = search(self._chains, position, closed, self._searched, before)
            state = (self._found.first + self._found.winner)[:, 0]
            if before is not None:
                state = np.concatenate([(before.first + before.winner)[-1:, 0], state])
            told = number[: until - self._begin] - (self._blocks - (before is not None))
            path = np.take_along_axis(state, told, axis=0)
            self._blocks = blocks
        self._target, self._end = target[len(path) :].copy(), end[len(path) :].copy()
        self._begin += len(path)
        return path


def decode(chains: Chains, targets: Sequence[np.ndarray], ends: Sequence[np.ndarray], stride: int, *, lag: int = LAG,
           searched: int = SEARCHED, begin: int = 0) -> List[np.ndarray]:
    """(T, 13) int64 each: the state paths of utterances, given their targets (T, 13) and which frames (T,) end units.
    Their first frames are frame `begin` of a stream.

    Every utterance has at least one frame, the last of which ends a unit.
    """
    number = [block_at(len(target), stride, begin) for target in targets]
    blocks = max(int(item.max()) for item in number) + 1
    seen = [looked_at(len(target), stride, blocks, begin) for target in targets]
    position = np.stack([np.take_along_axis(target, at, axis=0) for target, at in zip(targets, seen)], axis=1)
    closed = np.zeros(position.shape, dtype=bool)
    for i, (end, item) in enumerate(zip(ends, number)):
        closed[item[np.flatnonzero(end)], i, _CHANNEL] = True
    found = search(chains, position, closed, searched)
    by_blocks = [found.path(lag // stride), found.path(-(-lag // stride))]
    result = []
    for i, item in enumerate(number):
        until = item[np.minimum(np.arange(len(item)) + lag, len(item) - 1)]
        soon, late = (np.take_along_axis(path[:, i], item, axis=0) for path in by_blocks)
        result.append(np.where(until - item > lag // stride, late, soon))
    return result
