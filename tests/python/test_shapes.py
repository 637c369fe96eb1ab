"""Lip shape mixtures: scaling, back-off, the regression of shapes on durations; context-aware ones, whose EM climbs and
finds a planted dependence; closures and amplitude, which keep averaged lips from mumbling. Temporal kernels: against
the two-part regression they stand for, and on planted kernels."""

from __future__ import annotations

import dataclasses
from dataclasses import replace

import numpy as np
import pytest
from scipy.special import logsumexp
from scipy.stats import multivariate_normal
from sklearn.mixture import GaussianMixture

from labial.corpus.phonesets import SPEECH
from labial.errors import LabialError
from labial.files.faps import CHANNELS, FAP_NUMBERS
from labial.reference.shape import Choice, add_kernels, choose, neighbours, shapes
from labial.reference.stream import synthesise, targets
from labial.reference.tables import FloatTables
from labial.tables.model import mean_pose, widened
from labial.train import shapes as mixing
from labial.train.expression import AMPLITUDE, floors, gains
from labial.train.kernels import (
    PAIR_COUNT,
    Kernels,
    Penalties,
    fit_kernels,
    lags,
    pair_codes,
    regression,
    tapped,
)
from labial.train.recordings import Recording
from labial.train.workers import Workers
from models import random_model, without_floors


def two_clusters(rng: np.random.Generator, count: int) -> np.ndarray:
    """(count, 14) vectors around two lip shapes with durations of their own."""
    which = rng.integers(0, 2, count)
    centre = np.stack([np.linspace(-200, 100, 13), np.linspace(150, -300, 13)])
    shape = centre[which] + rng.normal(0, 20, (count, 13))
    return np.column_stack([shape, np.where(which, 0.06, 0.20) + rng.normal(0, 0.01, count)])


def test_density_equals_scikit_learns():
    # Catches a mean or covariance that is not scaled back to FAP and seconds, or scaled twice.
    vectors = two_clusters(np.random.default_rng(1), 200)
    scale = mixing.corpus_scale(vectors)
    mixture = mixing.fit_mixture(vectors, scale, 3, seed=4)
    oracle = GaussianMixture(3, reg_covar=mixing.REGULARISATION, max_iter=200, random_state=4).fit(vectors / scale)
    ours = logsumexp(np.log(mixture.weight) + mixing.log_normal(vectors, mixture.mean, mixture.covariance), axis=1)
    np.testing.assert_allclose(ours, oracle.score_samples(vectors / scale) - np.log(scale).sum(), rtol=1e-9)


def test_slope_recovers_a_linear_law():
    # Catches a slope in the wrong unit or sign.
    rng = np.random.default_rng(3)
    duration = rng.normal(0.12, 0.03, 4000)
    law = np.linspace(-900, 900, 13)  # FAP per second
    vectors = np.column_stack([40 + law * duration[:, None] + rng.normal(0, 10, (4000, 13)), duration])
    mixture = mixing.fit_mixture(vectors, mixing.corpus_scale(vectors), 1, seed=0)
    tables = mixing.shape_tables([mixture], conditional=True)
    np.testing.assert_allclose(tables.slope[0], law / (1 + mixing.REGULARISATION), atol=25)
    published = mixing.shape_tables([mixture], conditional=False)
    assert not published.slope.any()


def test_few_samples_get_few_components():
    # Catches a mixture with more components than samples can tell apart, or none at all.
    assert mixing.component_limit(5 * mixing.SAMPLES_PER_COMPONENT, 5) == 5
    assert mixing.component_limit(2 * mixing.SAMPLES_PER_COMPONENT - 1, 5) == 1
    assert mixing.component_limit(1, 5) == 1
    vectors = two_clusters(np.random.default_rng(5), mixing.MINIMUM_SAMPLES)
    mixture = mixing.fit_mixture(vectors, mixing.corpus_scale(vectors), 5, seed=0)
    assert len(mixture.weight) == 1 and np.linalg.eigvalsh(mixture.covariance[0]).min() > 0
    same = np.repeat(vectors[:1], 40, axis=0)  # repeated vectors have no spread
    assert np.linalg.eigvalsh(mixing.fit_mixture(same, mixing.corpus_scale(vectors), 2, seed=0).covariance).min() > 0


def test_back_off_from_class_to_substitute():
    # Catches a phoneme that is silently missing, one that loses its own samples, and a substitute without samples.
    labels = SPEECH.phonemes
    counts = np.zeros(len(labels), dtype=np.int64)
    for label, count in {"SIL": 50, "P": 40, "B": 3, "AA": 30, "T": 12}.items():
        counts[labels.index(label)] = count
    plan = mixing.back_off(counts, SPEECH)
    assert plan.members[labels.index("P")] == (labels.index("P"),)
    assert set(plan.members[labels.index("B")]) == {labels.index("P"), labels.index("B")}
    assert plan.pooled["B"] == plan.pooled["M"] == "bilabial"
    assert plan.substitutes["F"] in labels and "P" not in plan.substitutes and "M" not in plan.substitutes
    for index, label in enumerate(labels):
        assert plan.members[plan.stand_in[index]] is not None
        assert (plan.stand_in[index] == index) == (label not in plan.substitutes)


def test_a_small_corpus_closes_no_vowel():
    # Catches vowels that all look like B, the only phoneme with samples enough of its own, and one that stands in with
    # no sample of its own.
    labels = SPEECH.phonemes
    counts = np.zeros(len(labels), dtype=np.int64)
    for label, count in {"SIL": 12, "B": 13, "AH": 2, "EH": 8, "T": 7, "N": 4, "AA": 3, "IY": 5, "F": 4}.items():
        counts[labels.index(label)] = count
    plan = mixing.back_off(counts, SPEECH)
    assert {plan.substitutes[label] for label in ("AA", "AE", "IY", "UW", "OW", "ER", "HH")} == {"AH", "EH"}
    assert {plan.substitutes[label] for label in ("K", "G", "S", "R", "CH")} == {"T", "N"}
    assert not {"P", "B", "M", "F", "V"} & set(plan.substitutes.values())


def test_an_empty_corpus_is_refused():
    # Catches an error from deep inside a library instead of one that says what is wrong.
    with pytest.raises(LabialError, match="samples"):
        mixing.back_off(np.zeros(len(SPEECH.phonemes), dtype=np.int64), SPEECH)


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
    samples = mixing.Samples(vectors / mixing.corpus_scale(vectors), previous, following, CLASSES)
    mixture = mixing.maximise(samples, rng.dirichlet(np.ones(3), 60))
    joint = mixing.log_joint(samples, mixture)
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
        samples = mixing.Samples(vectors / mixing.corpus_scale(vectors), previous, following, CLASSES)
        _, history = mixing.climb(samples, rng.dirichlet(np.ones(components), count))
        assert len(history) > 3
        assert (np.diff(history) > -1e-8 * abs(history[-1])).all()


def test_recovers_a_planted_dependence():
    # Catches context tables that are swapped (previous for next), transposed or without effect on the selection.
    rng = np.random.default_rng(2)
    vectors, previous, following = planted(rng, 800)
    scale = mixing.corpus_scale(vectors)
    mixture = mixing.fit_context(mixing.fit_mixture(vectors, scale, 2, 0), vectors, scale, previous, following, CLASSES)
    tables = mixing.shape_tables([mixture], conditional=True)
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
    scale = mixing.corpus_scale(vectors)
    mixture = mixing.fit_context(mixing.fit_mixture(vectors, scale, 2, 0), vectors, scale, previous, following, CLASSES)
    for table in (mixture.log_previous, mixture.log_next):
        assert table.min() >= mixing.LOG_FLOOR - 1e-12
        np.testing.assert_allclose(np.exp(table).sum(axis=1), 1)
    assert (mixture.log_next[:, 1] > -0.02).all()
    assert (mixture.covariance[:, mixing.DURATION, mixing.DURATION] > 0).all()


# ---- Closures and amplitude ------------------------------------------------------------------------------------------


def sequence(phonemes: list, frames: np.ndarray, length: int) -> Recording:
    count = len(phonemes)
    return Recording(
        name="made up",
        phoneme=np.array(phonemes),
        duration=np.full(count, length / 50),
        length=np.full(count, length),
        apex=np.arange(count) * length,
        frames=frames,
    )


def test_floors_are_the_mean_pose_of_closures() -> None:
    """B closes firmly (to 40) three times in ten, hardly (to -60) otherwise; vowels hang at -300, nothing below. The
    firmer half counts; those of a recording that counts three times count three times."""
    b, vowel = SPEECH.phonemes.index("B"), SPEECH.phonemes.index("AA")
    lower = FAP_NUMBERS.index(52)
    frames = np.full((200, CHANNELS), -300.0)
    for i in range(10):  # vowels and closures of ten frames each in turn; contact in the middle of the closure
        frames[20 * i + 15, lower] = 40.0 if i % 4 == 1 else -60.0
    found, contact = floors([sequence([vowel, b] * 10, frames, 10)], SPEECH, 50)
    assert contact[b, lower] and not contact[b, FAP_NUMBERS.index(3)] and not contact[vowel].any()
    assert np.isclose(found[b, lower], (3 * 40.0 + 2 * -60.0) / 5)
    assert np.array_equal(found[b], found[SPEECH.phonemes.index("P")])
    other = np.where(frames > 0, 20.0, frames)  # three of ten
    heavy = dataclasses.replace(sequence([vowel, b] * 10, other, 10), weight=np.full(frames.shape, 3.0))
    both, _ = floors([sequence([vowel, b] * 10, frames, 10), heavy], SPEECH, 50)
    assert np.isclose(both[b, lower], (3 * 40.0 + 9 * 20.0 + 4 * -60.0) / 16)
    ignored = dataclasses.replace(heavy, weight=np.zeros(frames.shape))
    assert np.array_equal(floors([sequence([vowel, b] * 10, frames, 10), ignored], SPEECH, 50)[0], found)
    assert (found[vowel] == -300.0).all() and found[b, FAP_NUMBERS.index(3)] == -300.0
    free, _ = floors([sequence([vowel, b] * 10, frames, 10)], SPEECH, 50, free_corners=True)
    corners = np.isin(FAP_NUMBERS, (53, 54))
    sounds = np.arange(len(SPEECH.phonemes)) != SPEECH.phonemes.index("SIL")
    assert np.isneginf(free[sounds][:, corners]).all() and np.array_equal(free[:, ~corners], found[:, ~corners])


def test_widening_scales_targets_about_the_mean_pose() -> None:
    """Every term of the target has to be scaled; one that is forgotten bends the motion instead of widening it."""
    model = without_floors(random_model(4, knots=2))
    gain = np.linspace(0.5, 2.0, CHANNELS)
    asked = ([1, 4, 2, 7, 3], [120, 60, 200, 90, 70], [6, 3, 10, 5, 3])
    before = targets(FloatTables(model), *asked)
    after = targets(FloatTables(widened(model, gain)), *asked)
    centre = mean_pose(model)
    assert np.allclose(after, centre + (before - centre) * gain)
    assert np.ptp(before, axis=0).min() > 1


def test_amplitude_is_brought_to_its_goal() -> None:
    """The human here moves 1.4 times as far as the model: every channel must end at AMPLITUDE of that, within 2 %."""
    model = without_floors(random_model(5))
    rng = np.random.default_rng(5)
    material = []
    for _ in range(4):
        phonemes = rng.integers(1, 9, 30).tolist()
        motion = synthesise(FloatTables(model), [(p, 120) for p in phonemes])
        material.append(sequence(phonemes, 1.4 * motion, 6))
    with Workers(1, False) as workers:
        wide = widened(model, *gains(model, material, workers))
    found = np.concatenate([synthesise(FloatTables(wide), [(int(p), 120) for p in item.phoneme]) for item in material])
    human = np.concatenate([item.frames for item in material])
    assert np.abs(found.std(axis=0) / human.std(axis=0) - AMPLITUDE).max() < 0.06


def test_a_channel_is_widened_about_the_middle_of_its_range() -> None:
    """A pose that stays where it is under the gain lies between the 5th and the 95th percentile of human motion, not at
    the mean, which in a skewed channel is near the end that it rests at."""
    model = without_floors(random_model(6))
    rng = np.random.default_rng(6)
    phonemes = rng.integers(1, 9, 200).tolist()
    motion = 2.0 * synthesise(FloatTables(model), [(p, 120) for p in phonemes])
    motion[:, 2] = 4.0 * np.maximum(motion[:, 2], np.percentile(motion[:, 2], 80))
    with Workers(1, False) as workers:
        wide = widened(model, *gains(model, [sequence(phonemes, motion, 6)], workers))
    asked = ([1, 4, 2, 7, 3], [120, 60, 200, 90, 70], [6, 3, 10, 5, 3])
    before, after = (targets(FloatTables(item), *asked) for item in (model, wide))
    gain = np.ptp(after, axis=0) / np.ptp(before, axis=0)
    still = (after - gain * before)[0] / (1 - gain)
    low, high = np.percentile(motion, [5, 95], axis=0)
    assert (gain > 1.2).all() and np.allclose(still, (low + high) / 2)


# ---- Temporal kernels ------------------------------------------------------------------------------------------------


CLASS = np.array([0, 1, 1, 2, 2, 2])  # phoneme 0 is silence, phoneme 5 never occurs
PHONEMES = len(CLASS)
FPS = 50


def tables() -> mixing.ShapeTables:
    """One component per phoneme, of 100 ms +- 20 ms."""
    zero = np.zeros((PHONEMES, 13))
    none = np.zeros((PHONEMES, 0))
    return mixing.ShapeTables(
        component_count=np.ones(PHONEMES, dtype=np.int64),
        log_weight=np.zeros(PHONEMES),
        duration_mean=np.full(PHONEMES, 0.10),
        duration_variance=np.full(PHONEMES, 0.02**2),
        shape=zero,
        slope=zero,
        log_previous=none,
        log_next=none,
    )


def episode(rng: np.random.Generator, count: int) -> Recording:
    """A random sequence of phonemes 0 to 4 with no motion yet."""
    length = rng.integers(2, 9, count)
    phoneme = np.concatenate([[0], rng.integers(1, 5, count - 2), [0]])
    return Recording("x", phoneme, length / FPS, length, np.cumsum(length) - 1, np.zeros((length.sum(), 13)))


def choice_of(material) -> Choice:
    phoneme = np.concatenate([item.phoneme for item in material])
    offset = np.clip(np.concatenate([item.duration for item in material]) - 0.10, -0.06, 0.06)
    return Choice(phoneme[:, None], np.ones((len(phoneme), 1)), offset[:, None])


def fitted_to(material, stand_in, penalties: Penalties, pair_count: int = PAIR_COUNT) -> Kernels:
    asked = regression(material, tables(), CLASS, stand_in, 0, FPS, penalties, pair_count=pair_count)
    return fit_kernels(asked, material, choice_of(material))


def moved(item: Recording, given: mixing.ShapeTables, kernel: np.ndarray) -> np.ndarray:
    shape = np.repeat(shapes(given, choice_of([item])), item.length, axis=0)
    return add_kernels(shape, item.phoneme_at(), kernel, lags(FPS), 0)


def planted_kernels(seed: int, episodes: int):
    """Episodes whose motion is exactly what smooth kernels, shapes and slopes of each phoneme make."""
    rng = np.random.default_rng(seed)
    taps = len(lags(FPS))
    hump = np.exp(-0.5 * ((np.arange(taps) - taps / 2) / 3) ** 2)
    truth = np.random.default_rng(99)
    kernel = truth.normal(0, 40, (PHONEMES, 1, 13)) * np.roll(hump, 2)[None, :, None]
    given = replace(tables(), shape=truth.normal(0, 50, (6, 13)), slope=truth.normal(0, 300, (6, 13)))
    result = []
    for _ in range(episodes):
        item = episode(rng, 30)
        motion = moved(item, given, kernel)
        result.append(Recording(item.name, item.phoneme, item.duration, item.length, item.apex, motion))
    return result, given, kernel


def test_lags_and_taps_by_hand():
    # Catches lags with the sign turned round or beyond the device's limits, and neighbours beyond the ends that are
    # not silence.
    np.testing.assert_array_equal(lags(50), np.arange(-18, 7, 2))
    np.testing.assert_array_equal(lags(25), np.arange(-9, 4))
    np.testing.assert_array_equal(lags(50, 0.1), np.arange(-18, 5, 2))
    assert lags(50, 0.0)[-1] == 0
    np.testing.assert_array_equal(lags(100, 0.36), np.arange(-20, 21, 4))  # the device sees 20 frames to each side
    for fps in range(1, 251):
        assert 1 <= len(lags(fps, 0.36)) <= 32 and -20 <= lags(fps, 0.36)[0] == -lags(fps, 0.36)[-1]
    found = tapped(np.array([1, 2, 3]), np.array([-2, 0, 1]), silence=7)
    np.testing.assert_array_equal(found, [[7, 1, 2], [7, 2, 3], [1, 3, 7]])


def test_recovers_planted_kernels():
    # Catches a kernel, shape or slope laid at the wrong lag, phoneme or scale: motion of other episodes is predicted.
    # And kernels that only predict in sum: away from lag 0, where shapes do the same, differences are unique.
    material, _, kernel = planted_kernels(3, 200)
    weak = Penalties(kernel=1e-2, shape=1e-2, slope=1e-2, silence=1.0)
    fitted = fitted_to(material, range(PHONEMES), weak)
    for item in planted_kernels(2, 5)[0]:
        error = moved(item, fitted.tables, fitted.kernel) - item.frames
        assert np.sqrt((error**2).mean()) < 0.01 * item.frames.std()
    away = np.abs(lags(FPS)) >= 2
    found, true = ((item[1:5] - item[1])[:, away] for item in (fitted.kernel, kernel))
    assert np.abs(found - true).max() < 0.05 * np.abs(true).max()


@pytest.mark.parametrize(("intercept", "weighted"), [(np.inf, False), (10.0, False), (10.0, True)])
def test_equals_the_regression_in_two_parts(intercept: float, weighted: bool) -> None:
    # Catches a prior that is not that of a class kernel plus a residual, intercepts that are not solved for with the
    # rest, knots, sides of pairs and weights in the wrong place, and rows for pairs that are too rare to be believed:
    # here all are columns and rows of a plain ridge.
    rng = np.random.default_rng(4)
    material = [episode(rng, 25) for _ in range(6)]
    material = [
        Recording(i.name, i.phoneme, i.duration, i.length, i.apex, rng.normal(0, 50, i.frames.shape)) for i in material
    ]
    each = np.ones((6, 13))
    if weighted:
        each[4:], each[4:, 2] = 3.0, 0.0  # the last two count three times, but for the third channel
        material = [replace(i, weight=np.tile(row, (len(i.frames), 1))) for i, row in zip(material, each)]
    penalties = Penalties(kernel=20.0, residual=6.0, smoothness=0.0, shape=15.0, slope=25.0, silence=0.25, pair=8.0,
                          intercept=intercept)
    fitted = fitted_to(material, range(PHONEMES), penalties, 9)

    lag, classes, pairs = lags(FPS), 3, [tuple(key) for key in fitted.pair_key.tolist()]
    codes, counts = np.unique(pair_codes(material, PHONEMES, 0), return_counts=True)
    assert 2 < len(pairs) == (counts >= 9).sum() < len(codes)
    blocks = []
    for number, item in enumerate(material):
        taps = tapped(item.phoneme_at(), lag, 0)
        own = np.eye(PHONEMES)[item.phoneme_at()]
        z = np.repeat(choice_of([item]).offset / 0.02, item.length, axis=0)
        parts = [np.eye(classes)[CLASS[taps]], np.eye(PHONEMES)[taps]]
        knots = np.zeros((len(taps), 2, len(pairs)))
        starts, around = np.cumsum(item.length) - item.length, neighbours(item.phoneme, 0)
        for row, (phoneme, side, other) in enumerate(pairs):
            for i in np.flatnonzero((item.phoneme == phoneme) & (around[side] == other)):
                for j in range(item.length[i]):
                    middle = (j + 0.5) / item.length[i]
                    knots[starts[i] + j, :, row] = 1 - middle, middle
        alone = np.eye(len(material))[np.full(len(taps), number)] * np.isfinite(intercept)
        blocks.append(np.hstack([part.transpose(0, 2, 1).reshape(len(taps), -1) for part in parts]
                                + [own, own * z, knots.reshape(len(taps), -1), alone]))
    x, y = np.concatenate(blocks), np.concatenate([item.frames for item in material])
    quiet = np.where(np.concatenate([item.phoneme_at() for item in material]) == 0, 0.25, 1.0)
    counts = [classes * len(lag), PHONEMES * len(lag), PHONEMES, PHONEMES, 2 * len(pairs), len(material)]
    last = intercept if np.isfinite(intercept) else 1.0
    ridge = np.repeat([20.0, 120.0, 15.0, 25.0, 8.0, last], counts)
    for channel in (0, 2):
        weight = quiet * np.repeat(each[:, channel], [len(item.frames) for item in material])
        target = y[:, channel] - np.average(y[:, channel], weights=weight)
        strength = each[:, channel].max()
        rows = (x * weight[:, None]).T
        solution = np.linalg.solve(rows @ x + strength * np.diag(ridge), rows @ target)
        by_class, residual, _, slope, pair, _ = np.split(solution, np.cumsum(counts)[:-1])
        kernel = by_class.reshape(-1, len(lag))[CLASS] + residual.reshape(-1, len(lag))
        np.testing.assert_allclose(fitted.kernel[..., channel], kernel, atol=1e-6)
        np.testing.assert_allclose(fitted.tables.slope[:, channel] * 0.02, slope, atol=1e-6)
        np.testing.assert_allclose(fitted.pair_shape[..., channel], pair.reshape(2, -1).T, atol=1e-6)
    np.testing.assert_allclose(fitted.kernel[5, :, 2], by_class.reshape(-1, len(lag))[2], atol=1e-6)  # never seen


def test_a_weight_for_all_changes_nothing_and_makes_no_pair() -> None:
    # Catches penalties that do not go with the weights, and rows for what is seen often by weight alone.
    material, _, _ = planted_kernels(6, 12)
    once = fitted_to(material, range(PHONEMES), Penalties())
    heavy = [replace(item, weight=np.full(item.frames.shape, 7.0)) for item in material]
    again = fitted_to(heavy, range(PHONEMES), Penalties())
    np.testing.assert_array_equal(again.pair_key, once.pair_key)
    np.testing.assert_allclose(again.kernel, once.kernel, atol=1e-6)
    silent = [*material, *(replace(item, weight=np.zeros(item.frames.shape)) for item in planted_kernels(7, 12)[0])]
    without = fitted_to(silent, range(PHONEMES), Penalties())
    np.testing.assert_array_equal(without.pair_key, once.pair_key)
    np.testing.assert_allclose(without.tables.shape, once.tables.shape, atol=1e-6)


def test_a_substituted_phoneme_moves_as_its_substitute():
    # Catches a phoneme whose whole class is missing and that would rest at the mean of all motion.
    material, _, _ = planted_kernels(5, 20)
    stand_in = [0, 1, 2, 3, 4, 1]
    fitted = fitted_to(material, stand_in, Penalties())
    np.testing.assert_array_equal(fitted.kernel[5], fitted.kernel[1])
    np.testing.assert_array_equal(fitted.tables.shape[5], fitted.tables.shape[1])
    np.testing.assert_array_equal(fitted.tables.slope[5], fitted.tables.slope[1])
    assert np.abs(fitted.tables.shape[4] - fitted.tables.shape[1]).max() > 1
