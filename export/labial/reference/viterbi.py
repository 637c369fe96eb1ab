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
from typing import Callable, List, Sequence

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
    return np.maximum(-(((_CHANNEL - begin) % stride - np.arange(frames)[:, None]) // stride), 0)


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


def search(chains: Chains, position: np.ndarray, closed: np.ndarray, searched: int = SEARCHED) -> Search:
    """The search of B blocks of N utterances, for the targets (B, N, 13) that are looked at.

    `closed` (B, N, 13) says which blocks end a unit. Of the edges into a state the least wins, the first of equals, a
    leap before all; of states the least, the first of equals.
    """
    width = min(searched, chains.mean.shape[1])
    rank = np.arange(width)
    first = window(position, chains.mean, width)
    winner = np.zeros(position.shape, dtype=np.int64)
    back = np.zeros((*position.shape, width), dtype=np.int64)
    score = state = None
    for b in range(len(position)):
        before, state = state, first[b][..., None] + rank
        if b == 0:
            enter = chains.initial[_CHANNEL[:, None], state]
        else:
            edges = chains.transition[_CHANNEL[:, None, None], before[..., :, None], state[..., None, :]]
            through = score[..., :, None] + edges
            origin = through.argmin(axis=-2)
            least = np.take_along_axis(through, origin[..., None, :], axis=-2)[..., 0, :]
            leaps = least >= chains.leap
            back[b] = np.where(leaps, winner[b - 1][..., None], origin)
            enter = np.where(leaps, chains.leap, least)
        total = enter + chains.emission(position[b], state)
        winner[b] = total.argmin(axis=-1)
        score = np.minimum(total - total.min(axis=-1, keepdims=True), chains.leap)
        score[closed[b][..., None] & (rank != winner[b][..., None])] = chains.leap
    return Search(first, winner, back)


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
