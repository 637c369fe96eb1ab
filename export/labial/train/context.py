"""Context-aware mixtures: naive Bayes over shape, duration and the neighbours' viseme classes (docs/method.md,
Context).

Each component of equation 1 also has two categorical distributions, over the class of the previous and of the next
phoneme, fitted in the same EM. It maximises the posterior density of the parameters, with conjugate priors that keep
the estimates for rare phonemes plausible:

    weights       Dirichlet, WEIGHT_PRIOR counts per component
    classes       Dirichlet, CLASS_PRIOR counts per class (additive smoothing)
    covariance    inverse Wishart, COVARIANCE_PRIOR samples of the phoneme's overall diagonal covariance times
                  COVARIANCE_SHRINK, plus the regularisation of equation 1's mixture

so that no iteration lowers :func:`log_posterior`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import List, Tuple

import numpy as np
from scipy.linalg import solve_triangular
from scipy.special import logsumexp

from labial.train.shapes import REGULARISATION, Mixture

WEIGHT_PRIOR = 1.0
CLASS_PRIOR = 0.1
COVARIANCE_PRIOR = 3.0
COVARIANCE_SHRINK = 0.5

#: The least log-probability of a class: the device's tables end at 255 / 32 nats below the best.
LOG_FLOOR = -7.9

#: EM stops at a gain below this, in nats per sample, or after MAXIMUM_ITERATIONS.
TOLERANCE = 1e-4
MAXIMUM_ITERATIONS = 200


@dataclass(frozen=True)
class Samples:
    """A phoneme's n training samples."""

    vectors: np.ndarray  #: (n, 14) shape and duration, divided by the corpus's scale
    previous: np.ndarray  #: (n,) int64, viseme class
    next: np.ndarray  #: (n,) int64, viseme class
    classes: int  #: V


def log_normal(vectors: np.ndarray, mean: np.ndarray, covariance: np.ndarray) -> np.ndarray:
    """(n, C) log N(x; mean_c, covariance_c) of (n, D) vectors, (C, D) means and (C, D, D) covariances."""
    result = np.empty((len(vectors), len(mean)))
    for c, (centre, spread) in enumerate(zip(mean, covariance)):
        factor = np.linalg.cholesky(spread)
        z = solve_triangular(factor, (vectors - centre).T, lower=True)
        result[:, c] = -0.5 * (z**2).sum(axis=0) - np.log(np.diag(factor)).sum()
    found: np.ndarray = result - 0.5 * vectors.shape[1] * np.log(2 * np.pi)
    return found


def log_joint(samples: Samples, mixture: Mixture) -> np.ndarray:
    """(n, C) log of the weight times the probability of shape, duration and both neighbours."""
    result: np.ndarray = (
        np.log(mixture.weight)
        + log_normal(samples.vectors, mixture.mean, mixture.covariance)
        + mixture.log_previous.T[samples.previous]
        + mixture.log_next.T[samples.next]
    )
    return result


def prior_covariance(samples: Samples) -> np.ndarray:
    """(14, 14) the prior covariance."""
    return np.diag(COVARIANCE_SHRINK * samples.vectors.var(axis=0) + REGULARISATION)


def log_posterior(samples: Samples, mixture: Mixture) -> float:
    """Log-likelihood of the samples plus log-density of the priors, up to a constant: the objective of EM."""
    prior = prior_covariance(samples)
    value = float(logsumexp(log_joint(samples, mixture), axis=1).sum())
    value += WEIGHT_PRIOR * float(np.log(mixture.weight).sum())
    value += CLASS_PRIOR * float(mixture.log_previous.sum() + mixture.log_next.sum())
    for covariance in mixture.covariance:
        trace = np.trace(np.linalg.solve(covariance, prior))
        value -= 0.5 * COVARIANCE_PRIOR * (np.linalg.slogdet(covariance)[1] + trace)
    return value


def _class_table(responsibility: np.ndarray, of: np.ndarray, classes: int) -> np.ndarray:
    """(C, V) smoothed log-probabilities of the classes (n,) under responsibilities (n, C)."""
    counts: np.ndarray = np.stack([np.bincount(of, weights=column, minlength=classes) for column in responsibility.T])
    counts = counts + CLASS_PRIOR
    result: np.ndarray = np.log(counts / counts.sum(axis=1, keepdims=True))
    return result


def maximise(samples: Samples, responsibility: np.ndarray) -> Mixture:
    """The M step: the mixture that is most probable under responsibilities (n, C)."""
    prior = prior_covariance(samples)
    total = responsibility.sum(axis=0)
    weight = (total + WEIGHT_PRIOR) / (total.sum() + WEIGHT_PRIOR * len(total))
    mean = responsibility.T @ samples.vectors / np.maximum(total, 1e-9)[:, None]
    covariance = np.empty((len(total), *prior.shape))
    for c, centre in enumerate(mean):
        offset = samples.vectors - centre
        scatter = (responsibility[:, c, None] * offset).T @ offset
        covariance[c] = (scatter + COVARIANCE_PRIOR * prior) / (total[c] + COVARIANCE_PRIOR)
    return Mixture(
        weight=weight,
        mean=mean,
        covariance=covariance,
        log_previous=_class_table(responsibility, samples.previous, samples.classes),
        log_next=_class_table(responsibility, samples.next, samples.classes),
    )


def expect(samples: Samples, mixture: Mixture) -> np.ndarray:
    """The E step: responsibilities (n, C)."""
    joint = log_joint(samples, mixture)
    result: np.ndarray = np.exp(joint - logsumexp(joint, axis=1, keepdims=True))
    return result


def climb(samples: Samples, responsibility: np.ndarray) -> Tuple[Mixture, List[float]]:
    """EM from responsibilities (n, C). Returns the mixture and its log-posterior after every M step."""
    mixture = maximise(samples, responsibility)
    history = [log_posterior(samples, mixture)]
    for _ in range(MAXIMUM_ITERATIONS):
        mixture = maximise(samples, expect(samples, mixture))
        history.append(log_posterior(samples, mixture))
        if history[-1] - history[-2] < TOLERANCE * len(samples.vectors):
            break
    return mixture, history


def _floored(log_table: np.ndarray) -> np.ndarray:
    """The distributions (C, V) mixed with a uniform one so that none of their values is below LOG_FLOOR."""
    least = np.exp(LOG_FLOOR)
    result: np.ndarray = np.log(least + (1 - log_table.shape[1] * least) * np.exp(log_table))
    return result


def fit_context(
    start: Mixture, vectors: np.ndarray, scale: np.ndarray, previous: np.ndarray, following: np.ndarray, classes: int
) -> Mixture:
    """Fits the context-aware mixture of one phoneme from `start`, its mixture without context.

    `vectors` is (n, 14) in FAP and seconds, `scale` (14,) the corpus's standard deviations, `previous` and `following`
    (n,) the viseme classes of the neighbours, `classes` their number V.
    """
    samples = Samples(vectors / scale, previous, following, classes)
    joint = np.log(start.weight) + log_normal(
        samples.vectors, start.mean / scale, start.covariance / scale[:, None] / scale[None, :]
    )
    fitted, _ = climb(samples, np.exp(joint - logsumexp(joint, axis=1, keepdims=True)))
    return Mixture(
        weight=fitted.weight,
        mean=fitted.mean * scale,
        covariance=fitted.covariance * scale[:, None] * scale[None, :],
        log_previous=_floored(fitted.log_previous),
        log_next=_floored(fitted.log_next),
    )
