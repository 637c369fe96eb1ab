"""Context-aware mixtures: EM climbs, finds a planted dependence, and its tables are distributions."""

from __future__ import annotations

import numpy as np
from scipy.stats import multivariate_normal

from labial.reference.shape import choose, shapes
from labial.train.context import LOG_FLOOR, Samples, climb, fit_context, log_joint, maximise
from labial.train.shapes import DURATION, corpus_scale, fit_mixture, shape_tables

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
