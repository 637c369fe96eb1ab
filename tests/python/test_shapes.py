"""Lip shape mixtures: scaling, back-off, the regression of shapes on durations; context-aware ones, whose EM climbs and
finds a planted dependence."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import logsumexp
from scipy.stats import multivariate_normal
from sklearn.mixture import GaussianMixture

from labial.corpus.phonesets import SPEECH
from labial.errors import LabialError
from labial.reference.shape import choose, shapes
from labial.train.context import LOG_FLOOR, Samples, climb, fit_context, log_joint, log_normal, maximise
from labial.train.shapes import (
    DURATION,
    MINIMUM_SAMPLES,
    REGULARISATION,
    SAMPLES_PER_COMPONENT,
    back_off,
    component_limit,
    corpus_scale,
    fit_mixture,
    shape_tables,
)


def two_clusters(rng: np.random.Generator, count: int) -> np.ndarray:
    """(count, 14) vectors around two lip shapes with durations of their own."""
    which = rng.integers(0, 2, count)
    centre = np.stack([np.linspace(-200, 100, 13), np.linspace(150, -300, 13)])
    shape = centre[which] + rng.normal(0, 20, (count, 13))
    return np.column_stack([shape, np.where(which, 0.06, 0.20) + rng.normal(0, 0.01, count)])


def test_density_equals_scikit_learns():
    # Catches a mean or covariance that is not scaled back to FAP and seconds, or scaled twice.
    vectors = two_clusters(np.random.default_rng(1), 200)
    scale = corpus_scale(vectors)
    mixture = fit_mixture(vectors, scale, 3, seed=4)
    oracle = GaussianMixture(3, reg_covar=REGULARISATION, max_iter=200, random_state=4).fit(vectors / scale)
    ours = logsumexp(np.log(mixture.weight) + log_normal(vectors, mixture.mean, mixture.covariance), axis=1)
    np.testing.assert_allclose(ours, oracle.score_samples(vectors / scale) - np.log(scale).sum(), rtol=1e-9)


def test_equation_2_selects_by_duration():
    # Catches a selection that ignores the duration or mixes shapes up.
    vectors = two_clusters(np.random.default_rng(2), 300)
    tables = shape_tables([fit_mixture(vectors, corpus_scale(vectors), 2, seed=0)], conditional=False)
    zero = np.zeros(2, dtype=np.int64)
    selected = shapes(tables, choose(tables, zero, np.array([0.06, 0.20]), zero, zero, soft=False))
    np.testing.assert_allclose(selected[0], np.linspace(150, -300, 13), atol=8)
    np.testing.assert_allclose(selected[1], np.linspace(-200, 100, 13), atol=8)


def test_slope_recovers_a_linear_law():
    # Catches a slope in the wrong unit or sign.
    rng = np.random.default_rng(3)
    duration = rng.normal(0.12, 0.03, 4000)
    law = np.linspace(-900, 900, 13)  # FAP per second
    vectors = np.column_stack([40 + law * duration[:, None] + rng.normal(0, 10, (4000, 13)), duration])
    mixture = fit_mixture(vectors, corpus_scale(vectors), 1, seed=0)
    tables = shape_tables([mixture], conditional=True)
    np.testing.assert_allclose(tables.slope[0], law / (1 + REGULARISATION), atol=25)
    published = shape_tables([mixture], conditional=False)
    assert not published.slope.any()


def test_few_samples_get_few_components():
    # Catches a mixture with more components than samples can tell apart, or none at all.
    assert component_limit(5 * SAMPLES_PER_COMPONENT, 5) == 5
    assert component_limit(2 * SAMPLES_PER_COMPONENT - 1, 5) == 1
    assert component_limit(1, 5) == 1
    vectors = two_clusters(np.random.default_rng(5), MINIMUM_SAMPLES)
    mixture = fit_mixture(vectors, corpus_scale(vectors), 5, seed=0)
    assert len(mixture.weight) == 1 and np.linalg.eigvalsh(mixture.covariance[0]).min() > 0
    same = np.repeat(vectors[:1], 40, axis=0)  # repeated vectors have no spread
    assert np.linalg.eigvalsh(fit_mixture(same, corpus_scale(vectors), 2, seed=0).covariance).min() > 0


def test_back_off_from_class_to_substitute():
    # Catches a phoneme that is silently missing, one that loses its own samples, and a substitute without samples.
    labels = SPEECH.phonemes
    counts = np.zeros(len(labels), dtype=np.int64)
    for label, count in {"SIL": 50, "P": 40, "B": 3, "AA": 30, "T": 12}.items():
        counts[labels.index(label)] = count
    plan = back_off(counts, SPEECH)
    assert plan.members[labels.index("P")] == (labels.index("P"),)
    assert set(plan.members[labels.index("B")]) == {labels.index("P"), labels.index("B")}
    assert plan.pooled["B"] == plan.pooled["M"] == "bilabial"
    assert plan.substitutes["F"] in labels and "P" not in plan.substitutes and "M" not in plan.substitutes
    for index, label in enumerate(labels):
        assert plan.members[plan.stand_in[index]] is not None
        assert (plan.stand_in[index] == index) == (label not in plan.substitutes)


def test_an_empty_corpus_is_refused():
    # Catches an error from deep inside a library instead of one that says what is wrong.
    with pytest.raises(LabialError, match="samples"):
        back_off(np.zeros(len(SPEECH.phonemes), dtype=np.int64), SPEECH)


CLASSES = 6


def planted(rng: np.random.Generator, count: int):
    """Vectors (count, 14) in FAP and seconds whose shape depends on the next class alone, and both neighbours."""
    previous, following = rng.integers(0, CLASSES, (2, count))
    centre = np.where((following >= 3)[:, None], np.linspace(0, 60, 13), np.linspace(60, -60, 13))
    return np.column_stack([centre + rng.normal(0, 15, (count, 13)), rng.normal(0.1, 0.02, count)]), previous, following


def test_joint_is_the_product_of_its_parts():
    # Catches a term that is left out or looked up in the wrong table.
    rng = np.random.default_rng(0)
    vectors, previous, following = planted(rng, 60)
    samples = Samples(vectors / corpus_scale(vectors), previous, following, CLASSES)
    mixture = maximise(samples, rng.dirichlet(np.ones(3), 60))
    joint = log_joint(samples, mixture)
    for n, c in ((0, 0), (17, 2), (59, 1)):
        expected = np.log(mixture.weight[c])
        expected += multivariate_normal(mixture.mean[c], mixture.covariance[c]).logpdf(samples.vectors[n])
        expected += mixture.log_previous[c, previous[n]] + mixture.log_next[c, following[n]]
        np.testing.assert_allclose(joint[n, c], expected, rtol=1e-10)


def test_em_never_falls():
    # Catches an M step that does not maximise what the E step expects, priors included.
    rng = np.random.default_rng(1)
    for count, components in ((20, 3), (150, 5), (600, 4)):
        vectors, previous, following = planted(rng, count)
        samples = Samples(vectors / corpus_scale(vectors), previous, following, CLASSES)
        _, history = climb(samples, rng.dirichlet(np.ones(components), count))
        assert len(history) > 3
        assert (np.diff(history) > -1e-8 * abs(history[-1])).all()


def test_recovers_a_planted_dependence():
    # Catches context tables that are swapped (previous for next), transposed or without effect on the selection.
    rng = np.random.default_rng(2)
    vectors, previous, following = planted(rng, 800)
    scale = corpus_scale(vectors)
    mixture = fit_context(fit_mixture(vectors, scale, 2, 0), vectors, scale, previous, following, CLASSES)
    tables = shape_tables([mixture], conditional=True)
    asked = np.arange(CLASSES)
    zero = np.zeros(CLASSES, dtype=np.int64)
    for soft in (False, True):
        chosen = choose(tables, zero, np.full(CLASSES, 0.1), asked[::-1], asked, soft=soft)
        selected = shapes(tables, chosen)
        np.testing.assert_allclose(selected[:3], np.tile(np.linspace(60, -60, 13), (3, 1)), atol=5)
        np.testing.assert_allclose(selected[3:], np.tile(np.linspace(0, 60, 13), (3, 1)), atol=5)


def test_tables_are_distributions_above_the_floor():
    # Catches probabilities that the device's tables cannot hold, and a floor that is paid for by the others.
    rng = np.random.default_rng(3)
    vectors, previous, following = planted(rng, 3000)
    following[:] = 1  # never any other class
    scale = corpus_scale(vectors)
    mixture = fit_context(fit_mixture(vectors, scale, 2, 0), vectors, scale, previous, following, CLASSES)
    for table in (mixture.log_previous, mixture.log_next):
        assert table.min() >= LOG_FLOOR - 1e-12
        np.testing.assert_allclose(np.exp(table).sum(axis=1), 1)
    assert (mixture.log_next[:, 1] > -0.02).all()
    assert (mixture.covariance[:, DURATION, DURATION] > 0).all()
