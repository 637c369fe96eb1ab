"""Lip shape mixtures: scaling, back-off, and the regression of shapes on durations."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import logsumexp
from sklearn.mixture import GaussianMixture

from labial.corpus.phonesets import SPEECH
from labial.errors import LabialError
from labial.reference.shape import choose, shapes
from labial.train.context import log_normal
from labial.train.shapes import (
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
