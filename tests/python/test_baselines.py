"""Each baseline recovers a law that was planted in the motion, and none sees what it is judged by."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d
from threadpoolctl import threadpool_limits

from labial.corpus.phonesets import SPEECH
from labial.evaluate.baselines import dominance, hmm, ridge, steps
from labial.evaluate.baselines.hmm import align, deal, even
from labial.evaluate.material import Timeline, timeline
from test_evaluate import FPS, LABELS, shape_of_phoneme, training, unseen


@pytest.fixture(autouse=True)
def one_thread():
    """As in an evaluation: threads that wait for each other take most of the time of small problems."""
    with threadpool_limits(1):
        yield


SHAPES = shape_of_phoneme()
CLASS = np.array(SPEECH.viseme_class)


def held(given: Timeline) -> np.ndarray:
    """A step per phoneme."""
    return SHAPES[given.phoneme_at]


def blurred(given: Timeline) -> np.ndarray:
    return gaussian_filter1d(held(given), 2.0, axis=0, mode="nearest")


def additive(given: Timeline) -> np.ndarray:
    """Phonemes add to the frames 60 ms before them and 20 ms after them."""
    padded = np.concatenate([[0], given.phoneme_at, [0, 0, 0]])
    return SHAPES[padded[4:]] + 0.5 * SHAPES[padded[: len(padded) - 4]]


def coarticulated(given: Timeline) -> np.ndarray:
    """The linear regression's law: own shape, a drift with the duration, and the neighbours' classes fading."""
    ids = given.phoneme
    around = np.concatenate([[0], ids, [0]])
    position = (np.arange(given.frames) + 0.5 - given.start[given.segment_at]) / given.length[given.segment_at]
    duration = np.log(given.milliseconds / 100.0)[given.segment_at]
    shift = SHAPES[::-1][: len(SPEECH.classes)]
    before, after = (CLASS[around[:-2]][given.segment_at], CLASS[around[2:]][given.segment_at])
    return (held(given) * (1 + 0.3 * duration[:, None]) + (1 - position[:, None]) * shift[before]
            + position[:, None] * shift[after])


def dominated(given: Timeline) -> np.ndarray:
    """Cohen and Massaro's law, written out: strengths of silence and P differ, rates differ by side."""
    time = (np.arange(given.frames) + 0.5) / FPS
    centre = (given.start + given.length / 2) / FPS
    away = (time[:, None] - centre[None, :]) / dominance.DISTANCE
    strength = np.where(given.phoneme == SPEECH.phonemes.index("P"), 4.0, 1.0)
    weight = strength * np.exp(-np.where(away > 0, 2.0, 1.2) * np.abs(away))
    return weight @ SHAPES[given.phoneme] / weight.sum(axis=1, keepdims=True)


def error(predictor, law, labels=LABELS) -> float:
    """RMS error on unseen timelines over the standard deviation of the motion, outside silence."""
    apart, size = [], []
    for item in unseen(law, labels=labels):
        mask = item.timeline.phoneme_at != 0
        apart.append((predictor(item.timeline) - item.human)[mask])
        size.append(item.human[mask])
    return float(np.sqrt((np.concatenate(apart) ** 2).mean()) / np.concatenate(size).std())


def test_mean_is_the_mean_outside_silence() -> None:
    part = training(held, noise=0.0)
    frames = np.concatenate([item.human[item.timeline.phoneme_at != 0] for item in part.utterances])
    motion = ridge.fit_mean(part)(timeline([0, 1], [40, 40], 50))
    np.testing.assert_allclose(motion, np.tile(frames.mean(0), (4, 1)))


@pytest.mark.parametrize("context", [False, True])
def test_steps_recover_a_shape_per_phoneme(context: bool) -> None:
    assert error(steps.fit(training(held), context=context), held) < 0.03


def test_steps_of_the_paper_are_one_components_mean() -> None:
    # Catches a soft or a duration-dependent shape in what tables call equation 2.
    part = training(blurred)
    for context, exact in ((False, True), (True, False)):
        fitted = steps.fit(part, context=context)
        found = fitted.selected(unseen(blurred)[0].timeline)
        away = np.abs(found[:, None] - fitted.tables.shape[None]).max(axis=2).min(axis=1)
        assert (away.max() < 1e-9) == exact


def test_steps_hold_each_shape_for_its_phoneme_even_where_some_have_no_frame() -> None:
    fitted = steps.fit(training(held))
    given = timeline([SPEECH.phonemes.index(name) for name in ("SIL", "AA", "P", "S")], [100, 100, 4, 100], 50)
    found = fitted(given)
    assert found.shape == (15, 13) and len(np.unique(found[:, 0])) == 3


def test_blur_finds_the_width() -> None:
    part = training(blurred)
    fitted = steps.fit_blur(part)
    shapes_alone = error(fitted.steps, blurred)
    assert error(fitted, blurred) < 0.75 * shapes_alone and 0.025 <= fitted.width <= 0.045  # planted: 0.04
    assert steps.fit_blur(training(held)).width < 0.01


@pytest.mark.slow
def test_dominance_recovers_its_law() -> None:
    fitted = dominance.fit(training(dominated, 40))
    assert fitted.exponent == 1.0
    assert error(fitted, dominated) < 0.05 < error(steps.fit(training(dominated)), dominated)


def test_dominance_gradient_is_exact() -> None:
    # Catches a gradient that descends, but elsewhere: the fit would stop early and the baseline be crippled.
    part = training(dominated, 4, noise=0.0)
    parts = [dominance.near(item.timeline, FPS) for item in part.utterances]
    around = dominance.Near(*(np.concatenate([getattr(p, name) for p in parts])
                              for name in ("phoneme", "distance", "present")))
    motion = np.concatenate([item.human[:, 0] for item in part.utterances])
    loss, begin = dominance.objective(around, motion, np.zeros(len(CLASS)), CLASS, 1.5, 3.0)
    x = begin + np.random.default_rng(0).normal(0, 0.3, len(begin))
    gradient = loss(x)[1]
    for k in np.flatnonzero(np.abs(gradient) > 1e-5)[::4]:
        step = np.zeros(len(x))
        step[k] = 1e-5
        assert (loss(x + step)[0] - loss(x - step)[0]) / 2e-5 == pytest.approx(gradient[k], rel=1e-3, abs=1e-8)


def test_regression_recovers_its_law() -> None:
    assert error(ridge.fit_regression(training(coarticulated, 60)), coarticulated) < 0.05


def test_windows_recover_additive_kernels() -> None:
    assert error(ridge.fit_phonemes(training(additive, 60)), additive) < 0.15
    assert error(steps.fit(training(additive)), additive) > 0.4


def test_class_window_takes_phonemes_from_the_shapes() -> None:
    # P and B, S and Z share a class: only the stream of shapes tells them apart.
    labels = ("P", "B", "AA", "AE", "S", "Z")
    assert error(ridge.fit_classes(training(held, 40, labels=labels)), held, labels) < 0.15


def test_ridge_solves_the_weighted_normal_equations() -> None:
    part = training(held, 6)
    design = ridge._design_of_neighbours(part)
    base = np.full(13, 7.0)
    equations = ridge.normal(design, part.utterances, base, 0)
    rows = np.concatenate([design(item.timeline).sparse.toarray() for item in part.utterances])
    weight = np.where(np.concatenate([item.timeline.phoneme_at for item in part.utterances]) == 0, 0.1, 1.0)
    motion = np.concatenate([item.human for item in part.utterances]) - base
    penalty = np.full(rows.shape[1], 2.0)
    root = np.concatenate([rows * np.sqrt(weight)[:, None], np.diag(np.sqrt(penalty))])
    target = np.concatenate([motion * np.sqrt(weight)[:, None], np.zeros((rows.shape[1], 13))])
    np.testing.assert_allclose(ridge.solve(equations, penalty), np.linalg.lstsq(root, target, rcond=None)[0], atol=1e-6)


@pytest.mark.slow
def test_hmm_synthesis_recovers_motion_within_phonemes() -> None:
    # Blurred steps: the first and last states of a phoneme lean on its neighbours.
    fitted = hmm.fit(training(blurred, 60))
    assert error(fitted, blurred) < 0.2


def test_hmm_backs_off_from_triphone_to_phoneme_to_class() -> None:
    keys = np.array([[0, 0, 0, 0]] * 50 + [[0, 0, 0, 1]] * 2 + [[0, 2, 5, 7]])
    values = np.array([[10.0]] * 50 + [[20.0]] * 2 + [[40.0]])
    levels = hmm.pool(keys, np.zeros(53, dtype=np.int64), values, 1, 2.0, np.array([1e-3]))
    asked = np.array([[0, 0, 0, 0], [0, 0, 0, 1], [0, 0, 0, 9], [0, 0, 9, 9], [0, 9, 9, 9], [9, 9, 9, 9]])
    found = hmm.look_up(levels, asked)[0][:, 0, 0]
    assert found[0] == pytest.approx(10, abs=0.1) and 13 < found[1] < 17
    assert found[2] == levels[2].mean[levels[2].row[0], 0, 0] == pytest.approx(found[3], abs=0.2)
    assert found[4] == levels[0].mean[0, 0, 0] == found[5]


def test_durations_are_dealt_by_mean_and_variance() -> None:
    even_states = deal(9, np.array([2.0, 2.0, 2.0]), np.array([1.0, 1.0, 1.0]))
    assert np.bincount(even_states).tolist() == [3, 3, 3]
    stretched = deal(10, np.array([2.0, 2.0, 2.0]), np.array([0.01, 2.0, 0.01]))
    assert np.bincount(stretched).tolist() == [2, 6, 2]
    squeezed = deal(3, np.array([1.0, 8.0, 1.0]), np.array([0.1, 9.0, 0.1]))
    assert np.bincount(squeezed, minlength=3).tolist() == [1, 1, 1]
    assert deal(2, np.ones(3), np.ones(3)).tolist() == even(2, 3).tolist() == [0, 2]


def test_alignment_is_the_best_of_all_monotone_paths() -> None:
    # Against every path: catches back-pointers that are off by a state or a frame.
    rng = np.random.default_rng(3)
    values, length = rng.normal(size=(9, 2)), np.array([7, 2])
    row, mean_, variance = np.zeros(9, dtype=np.int64), rng.normal(size=(1, 3, 2)), np.ones((1, 3, 2))
    found = align(values, row, mean_, variance, length)
    cost = ((values[:7, None] - mean_[0]) ** 2).sum(axis=2)
    paths = [[0] * a + [1] * b + [2] * (7 - a - b) for a in range(1, 6) for b in range(1, 7 - a)]
    assert found[:7].tolist() == min(paths, key=lambda p: cost[np.arange(7), p].sum())
    assert found[7:].tolist() == [0, 2]


@pytest.mark.parametrize("fit", [ridge.fit_mean, steps.fit, steps.fit_blur, ridge.fit_regression,
                                 ridge.fit_phonemes, ridge.fit_classes, hmm.fit])
def test_unseen_phonemes_short_segments_and_single_frames(fit) -> None:
    # Catches a KeyError, a NaN or a frame too few for what the training part never showed.
    fitted = fit(training(held, 12))
    numbers = [SPEECH.phonemes.index(name) for name in ("SIL", "OY", "ZH", "B", "P", "OY")]
    for given in (timeline(numbers, [200, 15, 3, 3, 300, 20], 50), timeline(numbers[1:2], [20], 50)):
        found = fitted(given)
        assert found.shape == (given.frames, 13) and np.isfinite(found).all()
