"""The Viterbi search for a state path, decided as the frames come (docs/method.md, The run-time's search; DESIGN.md,
Numbers on the device; ``lib/viterbi.c``).

Each channel has a state for every `stride` frames, a *block*, and a grid of its own: a block ends with every frame k
for which k and the channel's number leave the same remainder by `stride`, and with the last frame. A step scores a
window of states, those around the one whose mean is nearest to the target; states are sorted by mean. With a lag, a
frame's state is found by tracing back from the best state of the block some frames later, or at the unit's end.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, List, Optional, Sequence

import numpy as np

from labial.files.faps import CHANNELS
from labial.tables.fixed import COST_SCALE, LEAP, SEARCHED

#: The library's default of LABIAL_LAG, frames.
LAG = 0


@dataclass(frozen=True)
class Chains:
    """What the search sees of the C channels' hidden Markov models. Costs are negative log-probabilities, inf forbids.
    `emission` gives the costs (..., C, W) of states (..., C, W) for targets (..., C). Any state can be entered from the
    best one of the step before at the cost `leap`; scores are held to it."""

    mean: np.ndarray  #: (C, Q) ascending
    transition: np.ndarray  #: (C, Q, Q) [from, to]
    initial: np.ndarray  #: (C, Q)
    leap: float
    emission: Callable[[np.ndarray, np.ndarray], np.ndarray]


def normal_chains(mean: np.ndarray, variance: np.ndarray, log_transition: np.ndarray,
                  log_initial: np.ndarray) -> Chains:
    """The chains, in nats, of states that are Gaussians of these means and variances (C, Q), but for the constant."""

    def emission(targets: np.ndarray, states: np.ndarray) -> np.ndarray:
        own = np.arange(len(mean))[:, None], states
        return 0.5 * ((targets[..., None] - mean[own]) ** 2 / variance[own] + np.log(variance[own]))

    return Chains(mean, -log_transition, -log_initial, LEAP / COST_SCALE, emission)


def block_at(frames: int, stride: int, begin: int = 0, channels: int = CHANNELS, first: int = 0) -> np.ndarray:
    """(T, C) int64: the block of each frame from `first` on, per channel, of a solution whose first frame is the
    stream's `begin`."""
    frame = np.arange(first, frames)[:, None]
    return np.maximum(-(((np.arange(channels) - begin) % stride - frame) // stride), 0)


def block_ends(frames: int, stride: int, channel: int) -> np.ndarray:
    """(B,) int64: the last frames of a channel's blocks."""
    return np.append(np.arange(channel % stride, frames - 1, stride), frames - 1)


def looked_at(frames: int, stride: int, blocks: int, begin: int = 0, channels: int = CHANNELS) -> np.ndarray:
    """(B, C) int64: the frames whose targets the search sees: the middle ones of whole blocks, or the later of two."""
    end = (np.arange(channels) - begin) % stride + stride * np.arange(blocks)[:, None]
    return np.clip(end - stride + 1 + stride // 2, 0, frames - 1)


def window(position: np.ndarray, mean: np.ndarray, width: int) -> np.ndarray:
    """(..., C) int64: the first of the `width` states that are scored for targets (..., C), given means (C, Q)."""
    states = mean.shape[1]
    above = (mean < position[..., None]).sum(axis=-1)
    channel = np.arange(len(mean))
    upper = mean[channel, np.minimum(above, states - 1)]
    lower = mean[channel, np.maximum(above - 1, 0)]
    is_upper = (above < states) & ((above == 0) | (upper - position < position - lower))
    return np.clip(np.where(is_upper, above, above - 1) - width // 2, 0, states - width)


@dataclass(frozen=True)
class Search:
    """What the search of B blocks of N utterances found."""

    first: np.ndarray  #: (B, N, C) the first state of each window
    winner: np.ndarray  #: (B, N, C) the best one's place in it
    back: np.ndarray  #: (B, N, C, W) each one's predecessor's place in the window of the block before
    score: np.ndarray  #: (N, C, W) those of the last block's window

    def path(self, lag: int) -> np.ndarray:
        """(B, N, C) int64: the states from which the best of `lag` blocks later, or of the last block, come. A unit's
        end leaves its best alone, so that all later ones come from it."""
        result = np.empty_like(self.winner)
        for b in range(len(result)):
            last = min(b + lag, len(result) - 1)
            place = self.winner[last]
            for later in range(last, b, -1):
                place = np.take_along_axis(self.back[later], place[..., None], axis=-1)[..., 0]
            result[b] = self.first[b] + place
        return result


def search(chains: Chains, position: np.ndarray, closed: np.ndarray, searched: int = SEARCHED,
           before: Optional[Search] = None) -> Search:
    """The search of B blocks of N utterances, for the targets (B, N, C) that are looked at. `closed` (B, N, C) says
    which blocks end a unit. Of the edges into a state the least wins, the first of equals, a leap before all; of states
    the least, the first of equals. `before` is the search of the blocks before these."""
    width = min(searched, chains.mean.shape[1])
    rank, channel = np.arange(width), np.arange(len(chains.mean))
    first = window(position, chains.mean, width)
    winner = np.zeros(position.shape, dtype=np.int64)
    back = np.zeros((*position.shape, width), dtype=np.int64)
    state: Optional[np.ndarray] = None
    score = best = np.zeros(0, dtype=np.int64)
    if before is not None:
        score, state, best = before.score, before.first[-1][..., None] + rank, before.winner[-1]
    for b in range(len(position)):
        left, state = state, first[b][..., None] + rank
        if left is None:
            enter = chains.initial[channel[:, None], state]
        else:
            edges = chains.transition[channel[:, None, None], left[..., :, None], state[..., None, :]]
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

    def __init__(self, chains: Chains, stride: int) -> None:
        self._chains, self._stride, self._channels = chains, stride, len(chains.mean)
        self._target = np.zeros((0, self._channels))
        self._end = np.zeros(0, dtype=bool)
        self._begin = 0  # the frame that these begin with, the first one without a state
        self._blocks = 0  # that are searched
        self._found: Optional[Search] = None

    def take(self, target: np.ndarray, end: np.ndarray, last: bool) -> np.ndarray:
        """(n, C) int64: the states of the next frames, those whose blocks are complete, or of all that are left; for
        the next targets (T, C), of a frame or more, and which of them (T,) end units."""
        # A block is searched when it is complete in all channels.
        target = np.concatenate([self._target, target]) if len(self._target) else target
        end = np.concatenate([self._end, end])
        known = self._begin + len(target)
        number = block_at(known, self._stride, channels=self._channels, first=self._begin)
        blocks = int(number.max()) + 1 if last else known // self._stride
        until = known if last else max(self._stride * (blocks - 1) + 1, 0)
        path = np.zeros((0, self._channels), dtype=np.int64)
        if until > self._begin:
            block = np.arange(self._blocks, blocks)[:, None]
            turn = np.arange(self._channels) % self._stride
            seen = np.clip(turn + self._stride * (block - 1) + 1 + self._stride // 2,
                           self._begin, known - 1) - self._begin
            closed = np.zeros((len(block), 1, self._channels), dtype=bool)
            ending = number[np.flatnonzero(end)]
            inside = (ending >= self._blocks) & (ending < blocks)
            closed[ending[inside] - self._blocks, 0, np.nonzero(inside)[1]] = True
            before, position = self._found, np.take_along_axis(target, seen, axis=0)[:, None]
            self._found = search(self._chains, position, closed, before=before)
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
    """(T, C) int64 each: the state paths of utterances, given their targets (T, C) and which frames (T,) end units.
    Their first frames are frame `begin` of a stream. Every utterance has at least one frame, the last of which ends a
    unit."""
    channels = len(chains.mean)
    number = [block_at(len(target), stride, begin, channels) for target in targets]
    blocks = max(int(item.max()) for item in number) + 1
    seen = [looked_at(len(target), stride, blocks, begin, channels) for target in targets]
    position = np.stack([np.take_along_axis(target, at, axis=0) for target, at in zip(targets, seen)], axis=1)
    closed = np.zeros(position.shape, dtype=bool)
    for i, (end, item) in enumerate(zip(ends, number)):
        closed[item[np.flatnonzero(end)], i, np.arange(channels)] = True
    found = search(chains, position, closed, searched)
    by_blocks = [found.path(lag // stride), found.path(-(-lag // stride))]
    result = []
    for i, item in enumerate(number):
        until = item[np.minimum(np.arange(len(item)) + lag, len(item) - 1)]
        soon, late = (np.take_along_axis(path[:, i], item, axis=0) for path in by_blocks)
        result.append(np.where(until - item > lag // stride, late, soon))
    return result
