"""Tracking states (docs/method.md, Tracking): states with memory, for motion that is slower than the kernels' reach.

A smile sinks over seconds, while kernels see only some hundred milliseconds of the past. So the hidden chain describes
the motion: a state is a cell of people's positions, transitions are counted on people's paths, and a target is an
observation of the state, with the variance of the training data. The search then follows the motion like a filter. A
frame's position is a least-squares combination of its state's mean and its target.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import List, Sequence

import numpy as np

from labial.train.codebook import VARIANCE_FLOOR, Codebook, Division, features, initials, transitions
from labial.train.states import (
    PRIOR_FRAMES,
    Scales,
    StateTables,
    codebook_tables,
    decoded_channel,
    limit_range,
    state_moments,
)

#: Factors of precisions. Static and anchor share the precision from least squares.
SCALES = Scales(static=1.0, delta=0.1, acceleration=0.1, anchor=1.0)

#: How many times its variance a target is taken to stray: kernels overlap, so that targets of successive steps err
#: alike and tell less than as many that err by themselves. Chosen, as the number of states, on corpora of other seeds.
ALIKE = 2.0

#: The least share of a state's hold that its mean or the target has.
LEAST_SHARE = 0.02


@dataclass(frozen=True)
class ChannelTask:
    """One channel of the stretches (T,) that are learnt from, FAP."""

    motion: List[np.ndarray]
    targets: List[np.ndarray]
    begins: List[np.ndarray]  #: frames at which units begin in each
    size: int  #: Q
    stride: int  #: frames from one state of a path to the next
    divide: Division


@dataclass(frozen=True)
class Chain:
    """One channel's states, in the order of their means, and what targets are in them."""

    book: Codebook
    mean: np.ndarray  #: (Q,) FAP, ascending, of the targets
    variance: np.ndarray  #: (Q,) FAP^2


def chain(task: ChannelTask) -> Chain:
    """The chain of one channel."""
    motion, targets = np.concatenate(task.motion), np.concatenate(task.targets)
    points = np.concatenate([features(item) for item in task.motion])
    overall = points.var(axis=0)
    scale = max(float(np.sqrt(overall[0])), 1e-6)
    centres = scale * np.sort(task.divide(motion[:, None] / scale, task.size)[0][:, 0])
    cell = np.searchsorted((centres[1:] + centres[:-1]) / 2, motion)
    prior = np.concatenate([centres[:, None], np.zeros((task.size, 2))], axis=1)
    moments = [state_moments(points[:, k], np.ones(len(cell)), cell, prior[:, k]) for k in range(3)]
    mean, variance = (np.stack(items, axis=1) for items in zip(*moments))
    seen, strayed = state_moments(targets, np.ones(len(cell)), cell, centres)
    paths = np.split(cell, np.cumsum([len(item) for item in task.motion])[:-1])
    book = Codebook(
        mean=mean,
        variance=np.maximum(variance, np.maximum(VARIANCE_FLOOR * overall, 1e-6)),
        count=np.bincount(cell, minlength=task.size),
        log_transition=transitions(paths, task.size, task.stride),
        log_initial=initials(paths, task.begins, task.size),
    )
    least = max(VARIANCE_FLOOR * float(overall[0]), 1e-6)
    return Chain(book, np.maximum.accumulate(seen), ALIKE * np.maximum(strayed, least))


def chain_tables(chains: Sequence[Chain], stride: int) -> StateTables:
    """The tables of all channels, with which targets are decoded."""
    return replace(codebook_tables([item.book for item in chains], stride),
                   emission_mean=np.stack([item.mean for item in chains]),
                   emission_variance=np.stack([item.variance for item in chains]))


def balance_states(
    tables: StateTables,
    paths: Sequence[np.ndarray],
    targets: Sequence[np.ndarray],
    human: Sequence[np.ndarray],
    weights: Sequence[np.ndarray],
    scales: Scales,
) -> StateTables:
    """The tables with means, precisions and anchors estimated on decoded paths (T, 13) of targets and human motion
    (T, 13) in FAP, whose values count by `weights` (T, 13). What the search sees stays as it is.

    With m the mean of a state's human frames, y a human frame and x its target, the anchor has the share b of what
    holds a frame that makes y - m - b (x - m) least in squares; the hold is the inverse of that remainder's variance.
    """
    count, size = tables.emission_mean.shape
    mean, precision = np.empty((count, size, 3)), np.empty((count, size, 3))
    anchor = np.empty((count, size))
    for channel in range(count):
        own = decoded_channel(tables, channel, paths, targets, human, weights)
        mean[channel] = own.mean
        held = own.mean[own.states, 0]
        strayed, aimed = own.motion - held, own.target - held
        share = _share(strayed, aimed, own.weight, own.states, size)
        _, left = state_moments(strayed - share[own.states] * aimed, own.weight, own.states, np.zeros(size))
        hold = 1.0 / np.maximum(left, own.floor[0])
        anchor[channel] = scales.anchor * share * hold
        precision[channel, :, 0] = scales.static * (1.0 - share) * hold
        moving = np.array([scales.delta, scales.acceleration])
        precision[channel, :, 1:] = moving / np.maximum(own.variance, own.floor)[:, 1:]
    precision, anchor = limit_range(precision, anchor)
    return replace(tables, state_mean=mean, state_precision=precision, state_anchor=anchor)


def _share(wanted: np.ndarray, given: np.ndarray, weight: np.ndarray, states: np.ndarray, size: int) -> np.ndarray:
    """(Q,) the factor of `given` (n,) that comes nearest to `wanted` (n,) in each state, drawn to that of all states as
    by PRIOR_FRAMES, and held off 0 and 1."""
    across, square = weight * given * wanted, weight * given**2
    overall = across.sum() / max(float(square.sum()), 1e-9)
    prior = PRIOR_FRAMES * max(float(square.sum() / weight.sum()), 1e-9)
    share = (np.bincount(states, across, size) + prior * overall) / (np.bincount(states, square, size) + prior)
    factor: np.ndarray = np.minimum(np.maximum(share, LEAST_SHARE), 1.0 - LEAST_SHARE)
    return factor
