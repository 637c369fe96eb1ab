"""Talkers as random effects: what they share, and the deviation of each (docs/method.md, Talkers).

The coefficients of talker t's regression, kernels, shapes, slopes and pairs, are b + u_t. With P the inverse prior
covariance that one talker alone would have, and v the variance of talkers,

    b ~ N(0, C),    u_t ~ N(0, V),    C = (SHARED P)^-1,    V = v C

and all talkers' normal equations A_t, B_t, with u_t marginalised, give

    (sum over t of (I + A_t V)^-1 A_t  +  C^-1) b = sum over t of (I + A_t V)^-1 B_t
    u_t = V (I + A_t V)^-1 (B_t - A_t b)

However much there is of a talker, (I + A_t V)^-1 A_t stays below V^-1: forty minutes of one say no more about people
than one person can. Both sums count a talker by the weight of his corpus. A channel that one talker alone teaches is
fitted as without talkers, with prior P.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Dict, Mapping, Optional, Sequence, Tuple

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from labial.errors import LabialError
from labial.files.faps import CHANNELS
from labial.reference.shape import Choice
from labial.train.kernels import PAIR_COUNT, Kernels, Penalties, Regression, columns_alike
from labial.train.recordings import Recording

#: How many times stronger the prior of what talkers share is than that of one talker; chosen on talkers left out, where
#: 1 was the best v.
SHARED = 3.0

#: The largest v: beyond it talkers share nothing.
LARGEST_VARIANCE = 1000.0

#: Penalties with talkers, chosen on talkers left out. How one talker's slow phonemes differ from his fast ones, or what
#: single neighbours add, carries over to others least; how a phoneme looks, and its peak, most.
PENALTIES = Penalties(smoothness=0.1, shape=5.0, slope=300.0, pair=40.0)

#: Least occurrences of a pair with talkers: with 20 as without, the tables are larger and the motion no closer.
PAIR_COUNT_SHARED = 25


def check_variance(variance: Optional[float]) -> None:
    """Raises LabialError for an invalid variance of talkers."""
    if variance is not None and not 0.0 < variance <= LARGEST_VARIANCE:
        raise LabialError(f"talker variance is {variance:g}, not above 0 and at most {LARGEST_VARIANCE:g}")


def penalties_of(variance: Optional[float]) -> Penalties:
    """The penalties of a regression with talkers of this variance, or without talkers."""
    return Penalties() if variance is None else PENALTIES


def pair_count_of(variance: Optional[float]) -> int:
    """The least occurrences of a pair with talkers of this variance, or without talkers."""
    return PAIR_COUNT if variance is None else PAIR_COUNT_SHARED


def counted_once(item: Recording) -> Recording:
    """The recording with equal weights of all values for training, regardless of its corpus's weight."""
    return item if item.weight is None else replace(item, weight=(item.weight > 0).astype(np.float64))


def covariance_of(prior: np.ndarray, variance: float) -> np.ndarray:
    """V (D, D), given P (D, D) and v."""
    return variance / SHARED * np.linalg.inv(prior)


@dataclass(frozen=True)
class Equations:
    """Normal equations of some channels, without the columns (D,) that the talker does not use."""

    columns: np.ndarray  #: (K,) the used columns
    normal: np.ndarray  #: (K, K)
    right: np.ndarray  #: (K, C)

    def marginal(self, covariance: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
        """(I + A V)^-1 A and (I + A V)^-1 B of a deviation's covariance V (D, D)."""
        own = covariance[np.ix_(self.columns, self.columns)]
        count = len(self.columns)
        both = np.linalg.solve(np.eye(count) + self.normal @ own, np.concatenate([self.normal, self.right], axis=1))
        return (both[:, :count] + both[:, :count].T) / 2, both[:, count:]

    def deviation(self, covariance: np.ndarray, shared: np.ndarray) -> np.ndarray:
        """(D, C) u = V (I + A V)^-1 (B - A b) beside the shared coefficients b (D, C)."""
        own = covariance[np.ix_(self.columns, self.columns)]
        left = self.right - self.normal @ shared[self.columns]
        return covariance[:, self.columns] @ np.linalg.solve(np.eye(len(own)) + self.normal @ own, left)


def equations_of(
    asked: Regression, material: Sequence[Recording], choice: Choice, base: np.ndarray
) -> Dict[int, Tuple[Equations, int]]:
    """By channel, for those that the talker of `material` teaches: his equations and which column of their right sides
    is the channel's."""
    found: Dict[int, Tuple[Equations, int]] = {}
    taught = np.any([item.weights.any(axis=0) for item in material], axis=0)
    for sums in asked.sums(material, choice, base):
        if not taught[sums.channels[0]]:
            continue
        normal, right = sums.equations(asked.penalties.intercept)
        columns = np.flatnonzero(normal.diagonal() > 0)
        equations = Equations(columns, normal[np.ix_(columns, columns)], right[columns])
        found.update({int(channel): (equations, place) for place, channel in enumerate(sums.channels)})
    return found


def deviation_of(
    found: Dict[int, Tuple[Equations, int]], channels: np.ndarray, covariance: np.ndarray, shared: np.ndarray
) -> np.ndarray:
    """(D, C) a talker's deviation from the shared coefficients (D, 13) in `channels` (C,), which have the same
    equations but for their right sides; V is `covariance` (D, D)."""
    equations = found[int(channels[0])][0]
    right = equations.right[:, [found[int(channel)][1] for channel in channels]]
    return replace(equations, right=right).deviation(covariance, shared[:, channels])


def _rows(material: Sequence[Recording], choice: Choice, chosen: Sequence[int]) -> Choice:
    """The part of `choice` for the occurrences of the chosen recordings."""
    ends = np.cumsum([len(item.phoneme) for item in material])
    rows = np.concatenate([np.arange(ends[i] - len(material[i].phoneme), ends[i]) for i in chosen])
    return Choice(choice.component[rows], choice.share[rows], choice.offset[rows])


def weights_of(material: Sequence[Recording]) -> Dict[str, float]:
    """The weight of each talker: the largest weight of his recordings, which is their corpora's."""
    counts: Dict[str, float] = {}
    for item in material:
        most = 1.0 if item.weight is None else float(item.weight.max(initial=0.0))
        counts[item.talker] = max(counts.get(item.talker, 0.0), most)
    return counts


def fit_talkers(
    asked: Regression, material: Sequence[Recording], choice: Choice, variance: float,
    counts: Optional[Mapping[str, float]] = None,
) -> Tuple[Kernels, Dict[str, Kernels]]:
    """What all talkers of `material` share, and each talker's own, by name; `choice` are the components of the
    material's occurrences, `variance` is v, `counts` says how much each talker counts for what they share."""
    base, prior = asked.base(material, choice), asked.prior()
    covariance = covariance_of(prior, variance)
    each: Dict[str, Dict[int, Tuple[Equations, int]]] = {}
    for talker in dict.fromkeys(item.talker for item in material):
        chosen = [index for index, item in enumerate(material) if item.talker == talker]
        each[talker] = equations_of(asked, [material[i] for i in chosen], _rows(material, choice, chosen), base)
    shared = np.zeros((len(prior), CHANNELS))
    own = {talker: np.zeros(shared.shape) for talker in each}
    for channels in columns_alike(material):
        first = int(channels[0])
        teachers = [talker for talker, equations in each.items() if first in equations]
        alone = len(teachers) == 1
        normal, right = prior * (1.0 if alone else SHARED), np.zeros((len(prior), len(channels)))
        for talker in teachers:
            equations = each[talker][first][0]
            places = [each[talker][int(channel)][1] for channel in channels]
            a, b = (equations.normal, equations.right) if alone else equations.marginal(covariance)
            count = 1.0 if alone or counts is None else counts[talker]
            normal[np.ix_(equations.columns, equations.columns)] += count * a
            right[equations.columns] += count * b[:, places]
        shared[:, channels] = cho_solve(cho_factor(normal), right)
        for talker in [] if alone else teachers:
            own[talker][:, channels] = deviation_of(each[talker], channels, covariance, shared)
    return asked.kernels(shared, base), {name: asked.kernels(shared + part, base) for name, part in own.items()}
