"""Temporal kernels: against the two-part regression they stand for, and on planted kernels."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from labial.reference.shape import Choice, add_kernels, knot_shares, neighbours, shapes
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
from labial.train.shapes import ShapeTables

CLASS = np.array([0, 1, 1, 2, 2, 2])  # phoneme 0 is silence, phoneme 5 never occurs
PHONEMES = len(CLASS)
FPS = 50


def tables() -> ShapeTables:
    """One component per phoneme, of 100 ms +- 20 ms."""
    zero = np.zeros((PHONEMES, 13))
    none = np.zeros((PHONEMES, 0))
    return ShapeTables(
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


def targets(item: Recording, given: ShapeTables, kernel: np.ndarray) -> np.ndarray:
    shape = np.repeat(shapes(given, choice_of([item])), item.length, axis=0)
    return add_kernels(shape, item.phoneme_at(), kernel, lags(FPS), 0)


def planted(seed: int, episodes: int):
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
        motion = targets(item, given, kernel)
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
    material, _, _ = planted(1, 120)
    weak = Penalties(kernel=1e-2, shape=1e-2, slope=1e-2, silence=1.0)
    fitted = fitted_to(material, range(PHONEMES), weak)
    for item in planted(2, 5)[0]:
        error = targets(item, fitted.tables, fitted.kernel) - item.frames
        assert np.sqrt((error**2).mean()) < 0.01 * item.frames.std()


def test_recovers_the_curve_itself():
    # Catches kernels that only predict in sum: away from lag 0, where shapes do the same, differences are unique.
    material, _, kernel = planted(3, 200)
    weak = Penalties(kernel=1e-2, shape=1e-2, slope=1e-2, silence=1.0)
    fitted = fitted_to(material, range(PHONEMES), weak)
    away = np.abs(lags(FPS)) >= 2
    found, true = ((item[1:5] - item[1])[:, away] for item in (fitted.kernel, kernel))
    assert np.abs(found - true).max() < 0.05 * np.abs(true).max()


@pytest.mark.parametrize(("intercept", "weighted"), [(np.inf, False), (10.0, False), (10.0, True)])
def test_equals_the_regression_in_two_parts(intercept: float, weighted: bool) -> None:
    # Catches a prior that is not that of a class kernel plus a residual, intercepts that are not solved for with the
    # rest, knots and weights in the wrong place: here all are columns and rows of a plain ridge.
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
    assert 2 < len(pairs) < 40
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
    material, _, _ = planted(6, 12)
    once = fitted_to(material, range(PHONEMES), Penalties())
    heavy = [replace(item, weight=np.full(item.frames.shape, 7.0)) for item in material]
    again = fitted_to(heavy, range(PHONEMES), Penalties())
    np.testing.assert_array_equal(again.pair_key, once.pair_key)
    np.testing.assert_allclose(again.kernel, once.kernel, atol=1e-6)
    silent = [*material, *(replace(item, weight=np.zeros(item.frames.shape)) for item in planted(7, 12)[0])]
    without = fitted_to(silent, range(PHONEMES), Penalties())
    np.testing.assert_array_equal(without.pair_key, once.pair_key)
    np.testing.assert_allclose(without.tables.shape, once.tables.shape, atol=1e-6)


def test_shares_of_knots_by_hand() -> None:
    # Catches knots at the middle of the outer frames instead of at the phoneme's ends.
    np.testing.assert_allclose(knot_shares(np.array([1, 4]), 2)[:, 1], [0.5, 0.125, 0.375, 0.625, 0.875])
    np.testing.assert_array_equal(knot_shares(np.array([2, 3]), 2).sum(axis=1), np.ones(5))
    np.testing.assert_array_equal(knot_shares(np.array([2, 3]), 1), np.ones((5, 1)))


def test_a_substituted_phoneme_moves_as_its_substitute():
    # Catches a phoneme whose whole class is missing and that would rest at the mean of all motion.
    material, _, _ = planted(5, 20)
    stand_in = [0, 1, 2, 3, 4, 1]
    fitted = fitted_to(material, stand_in, Penalties())
    np.testing.assert_array_equal(fitted.kernel[5], fitted.kernel[1])
    np.testing.assert_array_equal(fitted.tables.shape[5], fitted.tables.shape[1])
    np.testing.assert_array_equal(fitted.tables.slope[5], fitted.tables.slope[1])
    assert np.abs(fitted.tables.shape[4] - fitted.tables.shape[1]).max() > 1


def test_pairs_are_recovered_and_rare_ones_left_out():
    # Catches sides or neighbours taken for each other, and rows for pairs that are too rare to be believed.
    rng = np.random.default_rng(11)
    truth = {(1, 0, 2): 40.0, (1, 1, 3): -30.0}
    material = []
    for count in [40] * 30:
        item = episode(rng, count)
        frames = item.frames.copy()
        before, after = neighbours(item.phoneme, 0)
        for i, start in enumerate(np.cumsum(item.length) - item.length):
            own = int(item.phoneme[i])
            value = truth.get((own, 0, int(before[i])), 0.0) + truth.get((own, 1, int(after[i])), 0.0)
            frames[start : start + item.length[i]] = value
        material.append(replace(item, frames=frames))
    stiff = Penalties(kernel=1e6)
    fitted = fitted_to(material, range(PHONEMES), stiff)
    row = {tuple(key): value for key, value in zip(fitted.pair_key.tolist(), fitted.pair_shape.mean(axis=1)[:, 0])}
    for key, value in truth.items():
        others = [row[other] for other in row if other[:2] == key[:2] and other != key]
        assert abs(row[key] - np.mean(others) - value) < 0.15 * abs(value)
        assert np.ptp(others) < 0.15 * abs(value)
    codes, counts = np.unique(pair_codes(material, PHONEMES, 0), return_counts=True)
    assert len(row) == int((counts >= PAIR_COUNT).sum()) < len(codes)
