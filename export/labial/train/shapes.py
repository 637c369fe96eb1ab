"""Lip shape mixtures (docs/method.md, Equation 1): one Gaussian mixture per phoneme over shape and duration.

A training vector is the 13 channel values at the apex of a phoneme occurrence joined with its duration in seconds;
equation 1 gives each phoneme a mixture with full covariances over these 14 dimensions. scikit-learn fits it on
vectors divided by `scale` (the corpus's standard deviations), so that one regularisation suits FAP units and seconds.

Phonemes with few samples back off: one component per SAMPLES_PER_COMPONENT samples; below MINIMUM_SAMPLES the pooled
samples of the viseme class; where even those are too few, a substitute that the phone set declares.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Dict, List, Optional, Tuple

import numpy as np
from scipy.linalg import solve_triangular
from scipy.special import logsumexp
from sklearn.exceptions import ConvergenceWarning
from sklearn.mixture import GaussianMixture

from labial.corpus.phonesets import PhoneSet, substitute_for
from labial.errors import LabialError
from labial.files.faps import CHANNELS
from labial.reference.shape import ShapeTables

#: Samples per component: a full covariance of 14 dimensions needs about as many.
SAMPLES_PER_COMPONENT = 15
#: Least samples of a phoneme's own mixture.
MINIMUM_SAMPLES = 10
#: Added to the diagonal of every covariance of scaled vectors, whose variances over the corpus are 1.
REGULARISATION = 0.02
#: The time axis of a training vector.
DURATION = CHANNELS


@dataclass(frozen=True)
class Mixture:
    """A phoneme's mixture of C components over [shape, duration], with context tables where it was fitted with them."""

    weight: np.ndarray  #: (C,) a_c
    mean: np.ndarray  #: (C, 14) FAP and seconds
    covariance: np.ndarray  #: (C, 14, 14)
    log_previous: np.ndarray  #: (C, V) or (C, 0)
    log_next: np.ndarray  #: (C, V) or (C, 0)


def component_limit(samples: int, components: int) -> int:
    """The number of components for `samples` vectors."""
    return max(1, min(components, samples // SAMPLES_PER_COMPONENT))


def corpus_scale(vectors: np.ndarray) -> np.ndarray:
    """(14,) standard deviations of all training vectors (S, 14); 1 where a dimension never moves."""
    deviation = vectors.std(axis=0)
    return np.where(deviation > 1e-9, deviation, 1.0)


def fit_mixture(vectors: np.ndarray, scale: np.ndarray, components: int, seed: int) -> Mixture:
    """Equation 1: the mixture of one phoneme from its vectors (n, 14). `scale` is :func:`corpus_scale`."""
    scaled = vectors / scale
    count = component_limit(len(vectors), components)
    model = GaussianMixture(count, covariance_type="full", reg_covar=REGULARISATION, max_iter=200, random_state=seed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ConvergenceWarning)  # repeated vectors leave fewer clusters than components
        model.fit(scaled if len(scaled) > 1 else np.repeat(scaled, 2, axis=0))
    none = np.zeros((count, 0))
    return Mixture(weight=model.weights_, mean=model.means_ * scale,
                   covariance=model.covariances_ * scale[:, None] * scale[None, :], log_previous=none, log_next=none)


@dataclass(frozen=True)
class Plan:
    """The sources of each phoneme's mixture."""

    members: Tuple[Optional[Tuple[int, ...]], ...]  #: per phoneme the phonemes whose samples it uses; None: substituted
    stand_in: Tuple[int, ...]  #: per phoneme the phoneme whose mixture it uses; itself unless substituted
    pooled: Dict[str, str]  #: phoneme with too few samples -> viseme class whose samples it uses
    substitutes: Dict[str, str]  #: phoneme whose class has too few samples -> its substitute


def back_off(counts: np.ndarray, phone_set: PhoneSet) -> Plan:
    """Decides for every phoneme, from its samples (P,), whether it has its own mixture, its class's or another's."""
    labels = phone_set.phonemes
    classes = np.asarray(phone_set.viseme_class, dtype=np.int64)
    members: List[Optional[Tuple[int, ...]]] = []
    pooled: Dict[str, str] = {}
    for index, label in enumerate(labels):
        group = np.flatnonzero(classes == classes[index])
        if counts[index] >= MINIMUM_SAMPLES:
            members.append((index,))
        elif counts[group].sum() >= MINIMUM_SAMPLES:
            members.append(tuple(int(other) for other in group if counts[other]))
            pooled[label] = phone_set.classes[classes[index]]
        else:
            members.append(None)
    available = [label for label, who, count in zip(labels, members, counts) if who is not None and count]
    if not available:
        raise LabialError(f"no phoneme has the {MINIMUM_SAMPLES} samples that a lip shape mixture needs")
    stand_in = list(range(len(labels)))
    substitutes: Dict[str, str] = {}
    for index, label in enumerate(labels):
        if members[index] is None:
            substitutes[label] = substitute_for(label, available)
            stand_in[index] = labels.index(substitutes[label])
    return Plan(tuple(members), tuple(stand_in), pooled, substitutes)


def shape_tables(mixtures: List[Mixture], *, conditional: bool) -> ShapeTables:
    """Tables of the mixtures of P phonemes. `conditional` gives each component its regression of the shape on the
    duration, slope = cov(m, d) / var(d). Without it the shape is mu_c^(m) alone, as in equation 2."""

    def joined(name: str) -> np.ndarray:
        return np.concatenate([getattr(mixture, name) for mixture in mixtures])

    mean, covariance = joined("mean"), joined("covariance")
    variance = covariance[:, DURATION, DURATION]
    slope = covariance[:, :CHANNELS, DURATION] / variance[:, None]
    return ShapeTables(component_count=np.array([len(mixture.weight) for mixture in mixtures], dtype=np.int64),
                       log_weight=np.log(np.maximum(joined("weight"), 1e-12)), duration_mean=mean[:, DURATION].copy(),
                       duration_variance=variance.copy(), shape=mean[:, :CHANNELS].copy(),
                       slope=slope if conditional else np.zeros_like(slope), log_previous=joined("log_previous"),
                       log_next=joined("log_next"))


# ---- Context-aware mixtures ------------------------------------------------------------------------------------------

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
    return result - 0.5 * vectors.shape[1] * np.log(2 * np.pi)


def log_joint(samples: Samples, mixture: Mixture) -> np.ndarray:
    """(n, C) log of the weight times the probability of shape, duration and both neighbours."""
    result: np.ndarray = np.log(mixture.weight) + log_normal(samples.vectors, mixture.mean, mixture.covariance)
    return result + mixture.log_previous.T[samples.previous] + mixture.log_next.T[samples.next]


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
    counts = np.stack([np.bincount(of, column, classes) for column in responsibility.T]) + CLASS_PRIOR
    return np.log(counts / counts.sum(axis=1, keepdims=True))


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
    return Mixture(weight=weight, mean=mean, covariance=covariance,
                   log_previous=_class_table(responsibility, samples.previous, samples.classes),
                   log_next=_class_table(responsibility, samples.next, samples.classes))


def expect(samples: Samples, mixture: Mixture) -> np.ndarray:
    """The E step: responsibilities (n, C)."""
    return _shared(log_joint(samples, mixture))


def _shared(joint: np.ndarray) -> np.ndarray:
    """(n, C) responsibilities of log-probabilities (n, C)."""
    return np.exp(joint - logsumexp(joint, axis=1, keepdims=True))


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
    return np.log(least + (1 - log_table.shape[1] * least) * np.exp(log_table))


def fit_context(start: Mixture, vectors: np.ndarray, scale: np.ndarray, previous: np.ndarray, following: np.ndarray,
                classes: int) -> Mixture:
    """Fits the context-aware mixture of one phoneme from `start`, its mixture without context. `vectors` is (n, 14) in
    FAP and seconds, `scale` (14,) the corpus's standard deviations, `previous` and `following` (n,) the viseme classes
    of the neighbours, `classes` their number V."""
    samples = Samples(vectors / scale, previous, following, classes)
    joint = np.log(start.weight) + log_normal(samples.vectors, start.mean / scale,
                                              start.covariance / scale[:, None] / scale[None, :])
    fitted, _ = climb(samples, _shared(joint))
    return Mixture(weight=fitted.weight, mean=fitted.mean * scale,
                   covariance=fitted.covariance * scale[:, None] * scale[None, :],
                   log_previous=_floored(fitted.log_previous), log_next=_floored(fitted.log_next))
