"""Viterbi search for the cheapest state path (section 3 of the paper), for all channels at once."""

from __future__ import annotations

import numpy as np


def viterbi(emission: np.ndarray, transition: np.ndarray, initial: np.ndarray) -> np.ndarray:
    """The state path of least total cost.

    `emission` is (T, ..., Q), the cost of each state in each frame; `transition` (..., Q, Q) that of going [from, to];
    `initial` (..., Q) that of starting. Costs are negative log-probabilities, +inf forbids. Any leading axes
    (channels) are searched independently, each with its own tables. Returns (T, ...) int64. Ties go to the lower
    state, and for a frame's predecessor to the lower predecessor.
    """
    emission = np.asarray(emission, dtype=np.float64)
    frames = len(emission)
    into = np.ascontiguousarray(np.swapaxes(transition, -1, -2), dtype=np.float64)  # [to, from]
    path = np.empty(emission.shape[:-1], dtype=np.int64)
    if frames == 0:
        return path
    back = np.empty(emission.shape, dtype=np.int64)
    cost = initial + emission[0]
    for t in range(1, frames):
        total = into + cost[..., None, :]
        back[t] = total.argmin(axis=-1)
        cost = np.take_along_axis(total, back[t][..., None], axis=-1)[..., 0] + emission[t]
    path[-1] = cost.argmin(axis=-1)
    for t in range(frames - 1, 0, -1):
        path[t - 1] = np.take_along_axis(back[t], path[t][..., None], axis=-1)[..., 0]
    return path


def path_cost(path: np.ndarray, emission: np.ndarray, transition: np.ndarray, initial: np.ndarray) -> np.ndarray:
    """(...) total cost of a path (T, ...) under the tables of :func:`viterbi`."""
    frames = len(path)
    index = tuple(np.indices(path.shape[1:]))
    cost = initial[index + (path[0],)] + emission[(0,) + index + (path[0],)]
    for t in range(1, frames):
        cost = cost + transition[index + (path[t - 1], path[t])] + emission[(t,) + index + (path[t],)]
    return cost
