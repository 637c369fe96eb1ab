"""Baseline: HMM-based synthesis, to which the paper compares its speech.

Left-to-right phoneme HMMs over m, delta m and delta-delta m of all channels, with explicit state durations, in the
phonemes' context; the whole utterance's trajectory by maximum likelihood (equation 3, without anchors).

- Alignment: the segments' states begin evenly divided and are re-aligned by Viterbi inside each segment.
- Context: a state's statistics are those of its triphone, shrunk towards those of the phoneme between its neighbours'
viseme classes, these towards the phoneme's, and these towards its own class's (maximum a posteriori, level by level),
so that the back-off is gradual and an unseen triphone uses its class context.
- Durations: a segment's frames are distributed as mean + rho * variance, with rho such that they fill it.

Number of states and strength of the back-off are chosen by inner validation.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Dict, List, Sequence, Tuple

import numpy as np

from labial.corpus.phonesets import PhoneSet
from labial.evaluate.material import Timeline, Utterance
from labial.evaluate.training import Training, choose
from labial.files.faps import CHANNELS
from labial.reference.published import solve
from labial.reference.tables import Equation

#: States per phoneme, and frames that a level's parent counts for, that are tried.
STATES = (3, 5)
STRENGTHS = (0.5, 2.0, 6.0, 20.0)
#: Rounds of re-alignment.
ALIGNMENTS = 3
#: Least variance of a state, as a share of the feature's variance over the training part.
VARIANCE_FLOOR = 1e-3


def features(frames: np.ndarray) -> np.ndarray:
    """(T, 39) m, delta m, delta-delta m of every channel, channel by channel; the ends repeat."""
    held = np.concatenate([frames[:1], frames, frames[-1:]])
    stacked = [frames, (held[2:] - held[:-2]) / 2, held[2:] - 2 * frames + held[:-2]]
    return np.stack(stacked, axis=-1).reshape(len(frames), -1)


def contexts(phoneme: np.ndarray, phone_set: PhoneSet, silence: int) -> np.ndarray:
    """(H, 4) int64 keys of H phonemes in a row: class, phoneme, class context, triphone."""
    of = np.array(phone_set.viseme_class, dtype=np.int64)
    around = np.concatenate([[silence], phoneme, [silence]])
    before, after = around[:-2], around[2:]
    count = len(of)
    class_context = (of[before] * count + phoneme) * count + of[after]
    triphone = (before * count + phoneme) * count + after
    return np.stack([of[phoneme], phoneme, class_context, triphone], axis=1)


@dataclass(frozen=True)
class Level:
    """Statistics of one level of context: `row` of each key, and (n, S, F) means and variances."""

    row: Dict[int, int]
    mean: np.ndarray
    variance: np.ndarray


def _weighted(values: np.ndarray, index: np.ndarray, size: int) -> np.ndarray:
    return np.stack([np.bincount(index, column, size) for column in values.T], axis=1)


def pool(keys: np.ndarray, state: np.ndarray, values: np.ndarray, states: int, strength: float,
         floor: np.ndarray) -> List[Level]:
    """The levels of context from samples: `keys` (n, levels), `state` (n,), `values` (n, F). Each level is drawn to the
    one before it as by `strength` samples; the first to the overall statistics."""
    width = values.shape[1]
    parent_mean = np.broadcast_to(values.mean(axis=0), (1, states, width))
    parent_variance = np.broadcast_to(values.var(axis=0), (1, states, width))
    above = np.zeros(len(keys), dtype=np.int64)  # each sample's row of the level above
    levels: List[Level] = []
    for level in range(keys.shape[1]):
        found, first, row = np.unique(keys[:, level], return_index=True, return_inverse=True)
        row = row.reshape(-1)
        size = len(found) * states
        cell = row * states + state
        count = np.bincount(cell, minlength=size)[:, None]
        own = _weighted(values, cell, size)
        prior_mean = parent_mean[above[first]].reshape(size, width)
        prior_variance = parent_variance[above[first]].reshape(size, width)
        mean = (own + strength * prior_mean) / (count + strength)
        squares = _weighted((values - mean[cell]) ** 2, cell, size)
        apart = strength * (prior_variance + (mean - prior_mean) ** 2)
        variance = np.maximum((squares + apart) / (count + strength), floor)
        parent_mean, parent_variance = (item.reshape(len(found), states, width) for item in (mean, variance))
        levels.append(Level({int(key): n for n, key in enumerate(found)}, parent_mean, parent_variance))
        above = row
    return levels


def look_up(levels: Sequence[Level], keys: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """(H, S, F) means and variances for keys (H, levels): of the last level that knows each; else the first row's."""
    rows = []
    for key in keys:
        known = [n for n, level in enumerate(levels) if int(key[n]) in level.row]
        rows.append((known[-1], levels[known[-1]].row[int(key[known[-1]])]) if known else (0, 0))
    mean = np.stack([levels[n].mean[row] for n, row in rows])
    return mean, np.stack([levels[n].variance[row] for n, row in rows])


@dataclass(frozen=True)
class Synthesis:
    """The fitted HMMs."""

    motion: List[Level]  #: F = 39
    durations: List[Level]  #: F = 1, frames
    phone_set: PhoneSet
    silence: int

    def __call__(self, timeline: Timeline) -> np.ndarray:
        """(T, 13) FAP."""
        held = timeline.held
        keys = contexts(timeline.phoneme[held], self.phone_set, self.silence)
        mean, variance = look_up(self.motion, keys)
        lasting, spread = look_up(self.durations, keys)
        states = [deal(int(n), m[:, 0], v[:, 0]) for n, m, v in zip(timeline.length[held], lasting, spread)]
        state = np.concatenate(states)
        segment = np.repeat(np.arange(len(held)), timeline.length[held])
        shape = (len(state), CHANNELS, 3)
        none = np.zeros(shape[:2])
        return solve(Equation(1.0 / variance[segment, state].reshape(shape), mean[segment, state].reshape(shape),
                              none, none))


def _fit(utterances: Sequence[Utterance], training: Training, states: int, strength: float) -> Synthesis:
    keys = [contexts(u.timeline.phoneme[u.timeline.held], training.phone_set, training.silence) for u in utterances]
    length = np.concatenate([u.timeline.length[u.timeline.held] for u in utterances])
    segment_keys = np.concatenate(keys)
    segment = np.repeat(np.arange(len(length)), length)
    values = np.concatenate([features(u.human) for u in utterances])
    floor = np.maximum(VARIANCE_FLOOR * values.var(axis=0), 1e-6)
    state = np.concatenate([even(int(count), states) for count in length])
    monophones = segment_keys[:, :2]
    for _ in range(ALIGNMENTS):
        model = pool(monophones[segment], state, values, states, strength, floor)[-1]
        row = np.array([model.row[int(key)] for key in monophones[:, 1]])[segment]
        state = align(values, row, model.mean, model.variance, length)
    motion = pool(segment_keys[segment], state, values, states, strength, floor)
    spent = np.bincount(segment * states + state, minlength=len(length) * states).astype(np.float64)
    long_enough = np.repeat(length >= states, states)  # shorter ones skip states, and so do not show durations
    each = np.tile(np.arange(states), len(length))[long_enough]
    durations = pool(np.repeat(segment_keys, states, axis=0)[long_enough], each, spent[long_enough, None], states,
                     strength, np.array([0.1]))
    return Synthesis(motion, durations, training.phone_set, training.silence)


def fit(training: Training) -> Synthesis:
    """Chooses the settings on the inner validation part, then fits on the whole."""
    return _fit(training.utterances, training, *choose(
        training, list(itertools.product(STATES, STRENGTHS)),
        lambda part: lambda setting: _fit(part.utterances, training, *setting)))


# ---- The states of frames within their phonemes, for HMM synthesis ---------------------------------------------------


def even(frames: int, states: int) -> np.ndarray:
    """(frames,) int64: a segment divided evenly; states are skipped where there are fewer frames."""
    return ((np.arange(frames) + 0.5) * states / frames).astype(np.int64)


def deal(frames: int, mean: np.ndarray, variance: np.ndarray) -> np.ndarray:
    """(frames,) int64: a segment's frames distributed to states as mean + rho * variance, (S,) frames each, or 0 where
    that is negative. rho makes them fill the segment; one with fewer frames than states is divided evenly."""
    if frames < len(mean):
        return even(frames, len(mean))
    share = np.maximum(mean + (frames - mean.sum()) / variance.sum() * variance, 0.0)
    ends = np.cumsum(share) / share.sum() * frames
    return np.searchsorted(ends[:-1], np.arange(frames) + 0.5, side="right").astype(np.int64)


def log_likelihoods(values: np.ndarray, row: np.ndarray, mean: np.ndarray, variance: np.ndarray) -> np.ndarray:
    """(N, S) log N(value; state) without the constant, of N frames under the states of their own phoneme. `values` (N,
    F), `row` (N,) the frames' rows of `mean` and `variance` (n, S, F)."""
    result = -0.5 * np.log(variance).sum(axis=2)[row]
    for k in range(values.shape[1]):
        away = values[:, k, None] - mean[:, :, k].take(row, axis=0)
        np.square(away, out=away)
        away *= 0.5
        away /= variance[:, :, k].take(row, axis=0)
        result -= away
    return result


def align(values: np.ndarray, row: np.ndarray, mean: np.ndarray, variance: np.ndarray,
          length: np.ndarray) -> np.ndarray:
    """(N,) int64: the likeliest states of the frames of segments of `length` frames each, which sum to N. A segment has
    all states in order; one with fewer frames than states is divided evenly. Ties stay in the state."""
    states = mean.shape[1]
    score = log_likelihoods(values, row, mean, variance)
    start = np.cumsum(length) - length
    state = np.empty(len(values), dtype=np.int64)
    for count in np.unique(length):
        frames = start[length == count][:, None] + np.arange(count)
        state[frames] = even(count, states) if count < states else _search(score[frames])
    return state


def _search(score: np.ndarray) -> np.ndarray:
    """(n, T) the best monotone state paths of n segments with scores (n, T, S)."""
    segments, frames, states = score.shape
    total = np.full((segments, states), -np.inf)
    total[:, 0] = score[:, 0, 0]
    stepped = np.zeros((segments, frames, states), dtype=bool)
    for t in range(1, frames):
        come = np.concatenate([np.full((segments, 1), -np.inf), total[:, :-1]], axis=1)
        stepped[:, t] = come > total
        total = np.maximum(come, total) + score[:, t]
    path = np.empty((segments, frames), dtype=np.int64)
    path[:, -1] = states - 1
    for t in range(frames - 1, 0, -1):
        path[:, t - 1] = path[:, t] - stepped[np.arange(segments), t, path[:, t]]
    return path
