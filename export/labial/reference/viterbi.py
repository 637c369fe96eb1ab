"""Viterbi search for the cheapest state path (section 3 of the paper), for all channels at once."""

from __future__ import annotations

from typing import Callable

import numpy as np


def viterbi(
    emission: np.ndarray,
    transition: np.ndarray,
    initial: np.ndarray,
    *,
    beam: float = np.inf,
    leap: float = np.inf,
) -> np.ndarray:
    """The state path of least total cost.

    `emission` is (T, ..., Q), the cost of each state in each step; `transition` (..., Q, Q) that of going [from, to];
    `initial` (..., Q) that of starting. Costs are negative log-probabilities, +inf forbids. Any leading axes
    (channels) are searched independently, each with its own tables. Returns (T, ...) int64. Ties go to the lower
    state, and for a step's predecessor to the lower predecessor.

    Any state can also be entered from the best one of the step before, at the cost `leap`. States whose emission costs
    more than `beam` above the least of their step are passed over, but for the first step: they can be entered in no
    other way, and do not count for the best.
    """
    emission = np.asarray(emission, dtype=np.float64)
    steps = len(emission)
    into = np.ascontiguousarray(np.swapaxes(transition, -1, -2), dtype=np.float64)  # [to, from]
    path = np.empty(emission.shape[:-1], dtype=np.int64)
    if steps == 0:
        return path
    back = np.empty(emission.shape, dtype=np.int64)
    passed = emission > emission.min(axis=-1, keepdims=True) + beam
    passed[0] = False
    cost = initial + emission[0]
    for t in range(1, steps):
        total = into + cost[..., None, :]
        if leap < np.inf:
            within = np.where(passed[t - 1], np.inf, cost)
            best = within.argmin(axis=-1)[..., None]
            leapt = np.where(np.arange(cost.shape[-1]) == best, within + leap, np.inf)
            total = np.where(passed[t][..., None], np.inf, total)
            total = np.minimum(total, leapt[..., None, :])
        back[t] = total.argmin(axis=-1)
        cost = np.take_along_axis(total, back[t][..., None], axis=-1)[..., 0] + emission[t]
    path[-1] = cost.argmin(axis=-1)
    for t in range(steps - 1, 0, -1):
        path[t - 1] = np.take_along_axis(back[t], path[t][..., None], axis=-1)[..., 0]
    return path


def normal_costs(targets: np.ndarray, mean: np.ndarray, variance: np.ndarray) -> np.ndarray:
    """(T, 13, Q) cost of every state for targets (T, 13), in nats: -log N of the states' means and variances (13, Q),
    without the constant."""
    distance = targets[:, :, None] - mean
    return 0.5 * (distance**2 / variance + np.log(variance))


def decode(
    emission: Callable[[np.ndarray], np.ndarray],
    targets: np.ndarray,
    transition: np.ndarray,
    initial: np.ndarray,
    stride: int,
    *,
    beam: float = np.inf,
    leap: float = np.inf,
) -> np.ndarray:
    """(T, 13) int64: the state path for targets (T, 13), a state for every `stride` frames.

    Of these the search sees the middle one, or the later of two. `emission` gives the costs (S, 13, Q) of some targets
    (S, 13); the other arguments are those of :func:`viterbi`.
    """
    seen = targets[looked_at(len(targets), stride)]
    path = viterbi(emission(seen), transition, initial, beam=beam, leap=leap)
    return np.repeat(path, stride, axis=0)[: len(targets)]


def looked_at(frames: int, stride: int) -> np.ndarray:
    """(S,) the frames, of `frames`, whose targets the search sees."""
    return np.minimum(np.arange(0, frames, stride) + stride // 2, frames - 1)


def path_cost(path: np.ndarray, emission: np.ndarray, transition: np.ndarray, initial: np.ndarray) -> np.ndarray:
    """(...) total cost of a path (T, ...) under the tables of :func:`viterbi`."""
    frames = len(path)
    index = tuple(np.indices(path.shape[1:]))
    cost = initial[index + (path[0],)] + emission[(0,) + index + (path[0],)]
    for t in range(1, frames):
        cost = cost + transition[index + (path[t - 1], path[t])] + emission[(t,) + index + (path[t],)]
    return cost
