"""States (docs/method.md, Matched states, Anchors and Tracking): statistics of human motion for the states of decoded
paths. Smooth targets use far fewer transitions than people do, so that the exporter can keep few."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import List, Sequence, Tuple

import numpy as np

from labial.reference import viterbi
from labial.train.codebook import VARIANCE_FLOOR, Codebook, Division, features, initials, transitions

#: A state's statistics are joined with those of its codebook cell (means) and of all states (variances), which
#: count as this many frames.
PRIOR_FRAMES = 20.0
#: Largest diagonal element of equation 3's matrix over the least of static + anchor, per channel. The device's weights
#: carry WEIGHT_SUM_MAX / WEIGHT_MIN, a little more.
DYNAMIC_RANGE = 2000.0


@dataclass(frozen=True)
class Scales:
    """What the inverse variances are multiplied by to become precisions. Static, delta and delta-delta features are
    correlated with each other and with the anchor, so that their precisions must be reduced; chosen on held-out
    episodes, the anchor's for motion as even as people's."""

    static: float = 0.2
    delta: float = 0.01
    acceleration: float = 0.04
    anchor: float = 0.75


@dataclass(frozen=True)
class StateTables:
    """The tables of C channels for decoding and for equation 3; see labial.tables.model."""

    emission_mean: np.ndarray  #: (C, Q) FAP
    emission_variance: np.ndarray  #: (C, Q) FAP^2
    state_mean: np.ndarray  #: (C, Q, 3)
    state_precision: np.ndarray  #: (C, Q, 3)
    state_anchor: np.ndarray  #: (C, Q)
    log_transition: np.ndarray  #: (C, Q, Q)
    log_initial: np.ndarray  #: (C, Q)
    stride: int  #: frames from one state of a path to the next


def codebook_tables(codebooks: Sequence[Codebook], stride: int) -> StateTables:
    """The paper's tables: the codebook's cells, without anchors."""
    mean = np.stack([book.mean for book in codebooks])
    variance = np.stack([book.variance for book in codebooks])
    return StateTables(emission_mean=mean[..., 0].copy(), emission_variance=variance[..., 0].copy(), state_mean=mean,
                       state_precision=1.0 / variance, state_anchor=np.zeros(mean.shape[:2]),
                       log_transition=np.stack([book.log_transition for book in codebooks]),
                       log_initial=np.stack([book.log_initial for book in codebooks]), stride=stride)


def decode(targets: Sequence[np.ndarray], ends: Sequence[np.ndarray], tables: StateTables) -> List[np.ndarray]:
    """(T, C) int64 each: the state paths of utterances as in the run-time, for targets (T, C) and the frames (T,)
    that end units."""
    hidden = tables.emission_mean, tables.emission_variance, tables.log_transition, tables.log_initial
    return viterbi.decode(viterbi.normal_chains(*hidden), targets, ends, tables.stride)


def state_moments(values: np.ndarray, weight: np.ndarray, path: np.ndarray,
                  prior_mean: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """Means and variances (Q,) of the values (n,), counting by weight (n,), under each state of the path (n,), with
    PRIOR_FRAMES."""
    size = len(prior_mean)
    count = np.bincount(path, weights=weight, minlength=size)
    total = np.bincount(path, weights=weight * values, minlength=size)
    mean = (total + PRIOR_FRAMES * prior_mean) / (count + PRIOR_FRAMES)
    squares = np.bincount(path, weights=weight * (values - mean[path]) ** 2, minlength=size)
    pooled = squares.sum() / count.sum()
    return mean, (squares + PRIOR_FRAMES * pooled) / (count + PRIOR_FRAMES)


def _feature_moments(rows: np.ndarray, weight: np.ndarray, path: np.ndarray, prior: np.ndarray) -> List[np.ndarray]:
    """(Q, 3) each: :func:`state_moments` of the three features (n, 3), whose prior means are (Q, 3)."""
    moments = [state_moments(rows[:, k], weight, path, prior[:, k]) for k in range(3)]
    return [np.stack(items, axis=1) for items in zip(*moments)]


@dataclass(frozen=True)
class DecodedChannel:
    """The frames of all utterances in one channel, and what they say of each state's three features."""

    states: np.ndarray  #: (n,) int64, decoded
    target: np.ndarray  #: (n,) FAP
    motion: np.ndarray  #: (n,) FAP, human
    weight: np.ndarray  #: (n,)
    mean: np.ndarray  #: (Q, 3)
    variance: np.ndarray  #: (Q, 3)
    floor: np.ndarray  #: (3,) the least variance


def decoded_channel(tables: StateTables, channel: int, paths: Sequence[np.ndarray], targets: Sequence[np.ndarray],
                    human: Sequence[np.ndarray], weights: Sequence[np.ndarray]) -> DecodedChannel:
    """One channel of decoded paths, targets, human motion and its weights (T, C); copies are made of this one only."""
    states, target, motion, weight = (np.concatenate([item[:, channel] for item in items])
                                      for items in (paths, targets, human, weights))
    rows = np.concatenate([features(item[:, channel]) for item in human])
    floor = np.maximum(VARIANCE_FLOOR * rows[weight > 0].var(axis=0), 1e-6)
    mean, variance = _feature_moments(rows, weight, states, tables.state_mean[channel])
    return DecodedChannel(states, target, motion, weight, mean, variance, floor)


def match_states(tables: StateTables, paths: Sequence[np.ndarray], targets: Sequence[np.ndarray],
                 human: Sequence[np.ndarray], weights: Sequence[np.ndarray], scales: Scales) -> StateTables:
    """The tables with means, precisions, anchors and transitions re-estimated on decoded paths (T, C) of targets and
    human motion (T, C) in FAP, whose values count by `weights` (T, C). The emissions of the search are unchanged."""
    count, size = tables.emission_mean.shape
    mean = np.empty((count, size, 3))
    variance = np.empty((count, size, 3))
    anchor = np.empty((count, size))
    for channel in range(count):
        own = decoded_channel(tables, channel, paths, targets, human, weights)
        mean[channel], variance[channel] = own.mean, np.maximum(own.variance, own.floor)
        _, residual = state_moments(own.motion - own.target, own.weight, own.states, np.zeros(size))
        anchor[channel] = scales.anchor / np.maximum(residual, own.floor[0])
    scale = np.array([scales.static, scales.delta, scales.acceleration])
    precision, anchor = limit_range(scale / variance, anchor)
    return replace(
        tables, state_mean=mean, state_precision=precision, state_anchor=anchor,
        # A path repeats each state throughout its block, so that the blocks' ends are the chain that was decoded; human
        # paths change in every frame, and codebooks count all pairs that lie a stride apart.
        log_transition=np.stack([
            transitions([item[viterbi.block_ends(len(item), tables.stride, k), k] for item in paths], size)
            for k in range(count)
        ]))


def limit_range(precision: np.ndarray, anchor: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """Holds (C, Q, 3) precisions and (C, Q) anchors within DYNAMIC_RANGE, channel by channel. A frame's diagonal
    element is static + anchor and at most delta / 2 + 6 delta-delta. Either part of a state is scaled down where it
    exceeds half of DYNAMIC_RANGE times the channel's least static + anchor."""
    hold = precision[..., 0] + anchor
    moving = precision[..., 1] / 2 + 6 * precision[..., 2]
    most = DYNAMIC_RANGE / 2 * hold.min(axis=1, keepdims=True)
    hold_share = np.minimum(1.0, most / hold)
    moving_share = np.minimum(1.0, most / moving)
    return precision * np.stack([hold_share, moving_share, moving_share], axis=-1), anchor * hold_share


# ---- Tracking states (docs/method.md) --------------------------------------------------------------------------------

#: Factors of precisions. Static and anchor share the precision from least squares.
SCALES = Scales(static=1.0, delta=0.1, acceleration=0.1, anchor=1.0)
#: How many times its variance a target strays: kernels overlap, so that targets of successive steps err
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


def chain(task: ChannelTask) -> Tuple[Codebook, np.ndarray, np.ndarray]:
    """One channel's states, in the order of their means, and of the targets in them the means (Q,), FAP, ascending, and
    the variances (Q,), FAP^2."""
    motion, targets = np.concatenate(task.motion), np.concatenate(task.targets)
    points = np.concatenate([features(item) for item in task.motion])
    overall = points.var(axis=0)
    scale = max(float(np.sqrt(overall[0])), 1e-6)
    centres = scale * np.sort(task.divide(motion[:, None] / scale, task.size)[0][:, 0])
    cell = np.searchsorted((centres[1:] + centres[:-1]) / 2, motion)
    once, least = np.ones(len(cell)), np.maximum(VARIANCE_FLOOR * overall, 1e-6)
    prior = np.pad(centres[:, None], [(0, 0), (0, 2)])
    mean, variance = _feature_moments(points, once, cell, prior)
    seen, strayed = state_moments(targets, once, cell, centres)
    paths = np.split(cell, np.cumsum([len(item) for item in task.motion])[:-1])
    book = Codebook(mean=mean, variance=np.maximum(variance, least), count=np.bincount(cell, minlength=task.size),
                    log_transition=transitions(paths, task.size, task.stride),
                    log_initial=initials(paths, task.begins, task.size))
    return book, np.maximum.accumulate(seen), ALIKE * np.maximum(strayed, least[0])


def chain_tables(chains: Sequence[Tuple[Codebook, np.ndarray, np.ndarray]], stride: int) -> StateTables:
    """The tables of all channels, with which targets are decoded."""
    books, means, variances = zip(*chains)
    return replace(codebook_tables(books, stride), emission_mean=np.stack(means), emission_variance=np.stack(variances))


def balance_states(tables: StateTables, paths: Sequence[np.ndarray], targets: Sequence[np.ndarray],
                   human: Sequence[np.ndarray], weights: Sequence[np.ndarray], scales: Scales) -> StateTables:
    """The tables with means, precisions and anchors estimated on decoded paths (T, 13) of targets and human motion (T,
    13) in FAP, whose values count by `weights` (T, 13). What the search sees stays as it is. With m the mean of a
    state's human frames, y a human frame and x its target, the anchor has the share b of what holds a frame that makes
    y - m - b (x - m) least in squares; the hold is the inverse of that remainder's variance."""
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
    return np.minimum(np.maximum(share, LEAST_SHARE), 1.0 - LEAST_SHARE)
