"""The states of frames within their phonemes, for HMM synthesis."""

from __future__ import annotations

import numpy as np


def even(frames: int, states: int) -> np.ndarray:
    """(frames,) int64: a segment divided evenly; states are skipped where there are fewer frames."""
    return ((np.arange(frames) + 0.5) * states / frames).astype(np.int64)


def deal(frames: int, mean: np.ndarray, variance: np.ndarray) -> np.ndarray:
    """(frames,) int64: a segment's frames distributed to states as mean + rho * variance, (S,) frames each.

    rho makes the states fill the segment; a negative number of frames becomes 0. A segment with fewer frames than
    states is divided evenly, as in training.
    """
    if frames < len(mean):
        return even(frames, len(mean))
    share = np.maximum(mean + (frames - mean.sum()) / variance.sum() * variance, 0.0)
    ends = np.cumsum(share) / share.sum() * frames
    return np.searchsorted(ends[:-1], np.arange(frames) + 0.5, side="right").astype(np.int64)


def log_likelihoods(values: np.ndarray, row: np.ndarray, mean: np.ndarray, variance: np.ndarray) -> np.ndarray:
    """(N, S) log N(value; state) without the constant, of N frames under the states of their own phoneme.

    `values` (N, F), `row` (N,) the frames' rows of `mean` and `variance` (n, S, F).
    """
    result = -0.5 * np.log(variance).sum(axis=2)[row]
    for k in range(values.shape[1]):
        result -= 0.5 * (values[:, k, None] - mean[row, :, k]) ** 2 / variance[row, :, k]
    found: np.ndarray = result
    return found


def align(
    values: np.ndarray, row: np.ndarray, mean: np.ndarray, variance: np.ndarray, length: np.ndarray
) -> np.ndarray:
    """(N,) int64: the likeliest states of the frames of segments of `length` frames each, which sum to N.

    A segment begins in the first state, ends in the last and skips none; one with fewer frames than states is divided
    evenly. Ties stay in the state.
    """
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
