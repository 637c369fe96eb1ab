"""Shape selection (equation 2) for many phoneme occurrences at once, as the training needs it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Tuple

import numpy as np
from scipy.special import logsumexp

from labial.reference.tables import SLOPE_LIMIT
from labial.train.shapes import ShapeTables


def scores(
    tables: ShapeTables, phoneme: np.ndarray, duration: np.ndarray, previous: np.ndarray, following: np.ndarray
) -> Tuple[np.ndarray, np.ndarray]:
    """Log-scores of the components of (S,) phonemes with durations in seconds and neighbours' viseme classes.

    Returns (S, K) component indices and scores, K the largest component count; the score is -inf beyond a phoneme's
    own components.
    """
    first = np.concatenate([[0], np.cumsum(tables.component_count)])
    rank = np.arange(int(tables.component_count.max()))
    valid = rank[None, :] < tables.component_count[phoneme][:, None]
    component = np.where(valid, first[phoneme][:, None] + rank, first[phoneme][:, None])
    variance = tables.duration_variance[component]
    offset = duration[:, None] - tables.duration_mean[component]
    score = tables.log_weight[component] - 0.5 * (np.log(2 * np.pi * variance) + offset**2 / variance)
    if tables.log_previous.shape[1]:
        score = score + tables.log_previous[component, previous[:, None]]
        score = score + tables.log_next[component, following[:, None]]
    return component, np.where(valid, score, -np.inf)


@dataclass(frozen=True)
class Choice:
    """How (S,) phoneme occurrences share the components; a shape is the sum of share * (shape_c + slope_c * offset)."""

    component: np.ndarray  #: (S, K) int64
    share: np.ndarray  #: (S, K), sums to 1; 0 beyond a phoneme's own components
    offset: np.ndarray  #: (S, K) seconds from the component's mean duration, at most SLOPE_LIMIT deviations


def choose(
    tables: ShapeTables,
    phoneme: np.ndarray,
    duration: np.ndarray,
    previous: np.ndarray,
    following: np.ndarray,
    *,
    soft: bool,
) -> Choice:
    """The components of (S,) phonemes: the best alone (equation 2), or with `soft` all by their probability."""
    component, score = scores(tables, phoneme, duration, previous, following)
    share = np.exp(score - logsumexp(score, axis=1, keepdims=True))
    if not soft:
        share = np.eye(score.shape[1])[score.argmax(axis=1)]
    reach = SLOPE_LIMIT * np.sqrt(tables.duration_variance[component])
    offset = np.clip(duration[:, None] - tables.duration_mean[component], -reach, reach)
    return Choice(component, share, offset)


def shapes(tables: ShapeTables, choice: Choice) -> np.ndarray:
    """(S, 13) the selected shapes, FAP."""
    each = tables.shape[choice.component] + tables.slope[choice.component] * choice.offset[..., None]
    return np.einsum("sk,skj->sj", choice.share, each)
