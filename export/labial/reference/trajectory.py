"""States to motion: equation 3 of the paper, with anchors, factored frame by frame (``lib/trajectory.c``; DESIGN.md).
In the backward pass each frame continues the motion of the frames after it, drawn by a fraction (rho) towards the
position that it would have if all frames after it were equal to it."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Callable, Optional, Tuple

import numpy as np

from labial.files.faps import CHANNELS
from labial.reference.tables import Equation

#: The library's default of LABIAL_WINDOW: frames that it has beyond the delivered ones.
WINDOW = 3


def _next(values: np.ndarray) -> np.ndarray:
    """Each frame's successor, 0 after the last."""
    return np.concatenate([values[1:], np.zeros_like(values[:1])])


def _rows(pick: Callable[..., np.ndarray], *terms: Equation) -> Equation:
    """An equation whose members are `pick` of the members of `terms`."""
    return Equation(*(pick(*(getattr(item, field.name) for item in terms)) for field in fields(Equation)))


def articulated(terms: Equation, contact: np.ndarray, gain: np.ndarray) -> Equation:
    """The terms of the same motion `gain` (T, C) times as far from the neutral face: means and targets are, counted
    from FAP 0, and so is the solution. Frames in `contact` (T, C) are held where they are with a gain of 1, or nearer
    to the neutral face."""
    return replace(terms, mean=terms.mean * gain[..., None],
                   target=terms.target * np.where(contact, np.minimum(gain, 1.0), gain))


class Forward:
    """The forward pass over a stream whose terms come in parts."""

    def __init__(self) -> None:
        self._kept: Optional[Equation] = None  # the last factored frame, if any, and the waiting one
        self._done = 0  # of the frames in `_kept`
        self._state: Tuple[np.ndarray, ...] = ()

    def take(self, terms: Equation, last: bool) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(n, C) each: like :func:`forward`, for the frames that have a successor, or for all remaining frames if
        `terms`, of at least one frame, are the `last` ones."""
        first = self._kept is None
        terms = terms if self._kept is None else _rows(lambda a, b: np.concatenate([a, b]), self._kept, terms)
        weight = terms.weight.copy()
        if first:
            weight[0, :, 1:] = 0.0  # rows whose delta window would leave the stream
        if last:
            weight[-1, :, 1:] = 0.0
        delta, bend = weight[..., 1] / 4.0, weight[..., 2]
        hold = weight[..., 0] + terms.anchor
        aim = (weight[..., 0] * terms.mean[..., 0] + terms.anchor * terms.target) / hold
        turn, pull = bend * terms.mean[..., 2], 2.0 * delta * terms.mean[..., 1]
        pushed = -2.0 * turn + _next(turn - pull)
        pushed[1:] += (turn + pull)[:-1]
        across = _next(bend - delta)  # the element two beside the diagonal, c
        along = 2.0 * (delta + _next(delta))
        begin, end = self._done, len(hold) if last else len(hold) - 1
        settled, rho, kappa = (np.zeros_like(hold) for _ in range(3))
        # k[t-1], k[t-2], rho F and kappa F of t-1, settled of t-1, t-2
        k1, k2, carried, bent, before1, before2 = self._state or (np.zeros(hold.shape[1:]),) * 6
        for t in range(begin, end):
            held = hold[t] + carried + 2.0 * k1 - k2
            tied = along[t] + 2.0 * k1 + bent
            pivot = held + tied + across[t]
            rho[t], kappa[t] = held / pivot, across[t] / pivot
            drawn = hold[t] * (aim[t] - before1) + k2 * (before1 - before2) + pushed[t]
            settled[t] = before1 + drawn / held
            k1, k2, carried, bent = rho[t] * across[t], k1, rho[t] * tied, kappa[t] * tied
            before1, before2 = settled[t], before1
        self._state = k1, k2, carried, bent, before1, before2
        keep = max(end - 1, 0)
        self._done = end - keep
        self._kept = _rows(lambda values: values[keep:].copy(), replace(terms, weight=weight))
        return settled[begin:end], rho[begin:end], kappa[begin:end]


def forward(terms: Equation) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(T, C) each: `settled`, rho and kappa of the frames. `settled` is the frame's value if all beyond it equalled it.
    With those beyond given it is m[t] = m[t+1] + rho[t] (settled[t] - m[t+1]) + kappa[t] (m[t+1] - m[t+2])."""
    return Forward().take(terms, True)


def starts(frames: int, stride: int, window: int = WINDOW, lag: int = 0, begin: int = 0,
           channels: int = CHANNELS) -> np.ndarray:
    """(T, C) int64: the frame from which the way back to each frame starts, where the first is the stream's `begin`. A
    channel's frames k - window - stride .. k - window - 1 are delivered with its block that ends `lag` frames after
    frame k, when the states up to k are decided. Then the frame before k has all that it is tied to, and k itself where
    it is the stream's last."""
    frame = np.arange(frames)[:, None]
    earliest = frame + window + 1
    end = earliest + (np.arange(channels) - lag - begin - earliest) % stride
    return np.where(end == frames - 1, end, np.minimum(end - 1, frames - 1))


def solve(terms: Equation, start: np.ndarray) -> np.ndarray:
    """(T, C) trajectories m of equation 3, (W' U^-1 W + A) m = W' U^-1 mu + A x, each frame by a way back of its own,
    which takes the frames beyond its `start` (T, C) to equal that one. It is exact where that is the last frame. W
    stacks the static, delta ((m[t+1] - m[t-1]) / 2) and delta-delta (m[t+1] - 2 m[t] + m[t-1]) rows of every frame;
    those whose window would leave the stream are dropped."""
    return _back(*forward(terms), start)


def _back(settled: np.ndarray, rho: np.ndarray, kappa: np.ndarray, start: np.ndarray) -> np.ndarray:
    """(N, C) the first N of the frames of a forward pass (T, C), each by a way back of its own from `start` (N, C)."""
    frame = np.arange(len(start))[:, None]
    channel = np.arange(settled.shape[1])
    m = np.take_along_axis(settled, start, axis=0)
    beyond = m  # m of the frame behind
    for back in range(int((start - frame).max(initial=0)) - 1, -1, -1):
        at = np.minimum(frame + back, len(settled) - 1), channel
        step = m + rho[at] * (settled[at] - m) + kappa[at] * (m - beyond)
        under_way = frame + back < start
        m, beyond = np.where(under_way, step, m), np.where(under_way, m, beyond)
    return m


class Solve:
    """:func:`solve` for a stream whose terms come in parts, without a lag."""

    def __init__(self, stride: int) -> None:
        self._stride = stride
        self._forward = Forward()
        self._passed: Tuple[np.ndarray, ...] = ()  # of the forward pass, from the first frame that is not delivered on
        self._begin = 0  # that frame

    def take(self, terms: Equation, last: bool) -> np.ndarray:
        """(n, C) the next frames whose way back has a start, or all that are left."""
        passed = self._forward.take(terms, last)
        joined = tuple(np.concatenate(pair) for pair in zip(self._passed, passed)) if self._passed else passed
        known = len(joined[0])
        # The backward pass starts before the last known frame, unless the stream ends there.
        ready = known if last else max(known - 1 - WINDOW - self._stride, 0)
        settled, rho, kappa = joined
        start = starts(known, self._stride, begin=self._begin, channels=settled.shape[1])
        motion = _back(settled, rho, kappa, start[:ready])
        self._passed = tuple(item[ready:].copy() for item in joined)
        self._begin += ready
        return motion


def solve_whole(terms: Equation) -> np.ndarray:
    """(T, C) trajectories of equation 3 by one way back over all frames, exactly."""
    settled, rho, kappa = forward(terms)
    m = settled.copy()
    for t in range(len(m) - 2, -1, -1):
        beyond = m[min(t + 2, len(m) - 1)]
        m[t] = m[t + 1] + rho[t] * (settled[t] - m[t + 1]) + kappa[t] * (m[t + 1] - beyond)
    return m
