"""LBG codebook and its counts, against SPTK's lbg and by hand; states that track slow motion, by hand and on a level
that targets tell only now and then."""

from __future__ import annotations

import subprocess
from dataclasses import replace
from typing import List, Tuple

import numpy as np
import pytest

from labial.corpus.phonesets import LAUGHTER
from labial.files.faps import CHANNELS, FAP_NUMBERS
from labial.train import codebook, pipeline
from labial.train import states as tracking
from labial.train.expression import HELD, floors
from labial.train.recordings import Recording
from labial.train.states import StateTables, decode
from packages import sptk


def motion(seed: int, frames: int = 3000) -> np.ndarray:
    """(frames,) a smooth wandering channel in FAP."""
    noise = np.random.default_rng(seed).normal(0, 1, frames)
    window = np.hanning(15)
    return 100 * np.convolve(np.cumsum(noise) * 0.05 + noise, window / window.sum(), "same")


def scaled(seed: int) -> np.ndarray:
    points = codebook.features(motion(seed))
    return points / points.std(axis=0)


def test_features_by_hand():
    # Catches a delta of two frames' difference without the half, or a shifted window.
    found = codebook.features(np.array([1.0, 2.0, 5.0, 4.0]))
    np.testing.assert_allclose(found, [[1, 0.5, 1], [2, 2, 2], [5, 1, -4], [4, -0.5, 1]])


def test_distortion_is_no_worse_than_sptks(tmp_path):
    # Catches poor splits and a refinement that ends too early.
    for seed, size in ((1, 16), (2, 32), (3, 64)):
        points = scaled(seed).astype(np.float32)
        source = tmp_path / f"points{seed}"
        points.tofile(source)
        command = [*sptk("lbg"), "-l", "3", "-s", "1", "-e", str(size)]
        with open(source, "rb") as stream:
            done = subprocess.run(command, stdin=stream, capture_output=True, check=True)
        centres = np.frombuffer(done.stdout, dtype=np.float32).reshape(size, 3).astype(np.float64)
        theirs = codebook.assign(points.astype(np.float64), centres)[1].mean()
        _, _, ours = codebook.lbg(points.astype(np.float64), size)
        assert ours < 1.03 * theirs


def test_sizes_between_powers_of_two():
    # Catches a last round that splits too many cells or leaves some empty, and a distortion of another codebook.
    points = scaled(4)
    distortions = []
    for size in (32, 50, 64):
        centres, cell, distortion = codebook.lbg(points, size)
        assert centres.shape == (size, 3) and (np.bincount(cell, minlength=size) > 0).all()
        np.testing.assert_allclose(((points - centres[cell]) ** 2).sum(axis=1).mean(), distortion)
        distortions.append(distortion)
    assert distortions[0] > distortions[1] > distortions[2]


def test_finds_separate_clusters():
    # Catches a split that never leaves a large cluster for a small one.
    rng = np.random.default_rng(5)
    centres = np.array([[0, 0, 0], [9, 0, 0], [0, 9, 0], [0, 0, 9], [9, 9, 9.0]])
    points = np.repeat(centres, [4000, 20, 30, 40, 50], axis=0)
    found, _, distortion = codebook.lbg(points + rng.normal(0, 0.1, points.shape), 5)
    assert distortion < 0.04
    assert codebook.assign(centres, found)[1].max() < 0.05


def test_fewer_values_than_states():
    # Catches an endless loop, NaN or a state at no place that was seen, where a channel hardly moves.
    still = [np.zeros(50), np.repeat([0.0, 40.0], 25)]
    book = codebook.train_channel(still, [np.array([0]), np.array([0, 25])], 50)
    for table in (book.mean, book.variance, book.log_initial):
        assert np.isfinite(table).all()
    assert set(np.round(book.mean[:, 0])) <= {0.0, 40.0}
    assert (book.variance > 0).all() and np.isfinite(book.log_transition).any(axis=0).all()


def test_counts_by_hand():
    # Catches [to, from], counts across the ends of sequences, and rows that do not sum to 1; starts that are read from
    # the wrong frame, and a state that no unit could start in.
    near = codebook.NEIGHBOUR_COUNT
    expected = np.array(
        [[1 + near, near, 0, 1], [near, near, 1 + near, 0], [0, near, near, near], [1, 0, near, 1 + near]])
    found = np.exp(codebook.transitions([np.array([0, 0, 3, 3, 0]), np.array([1, 2])], 4))
    np.testing.assert_allclose(found, expected / expected.sum(axis=1, keepdims=True), atol=1e-12)
    spread = codebook.INITIAL_COUNT * np.array([2, 2, 3, 1]) / 8
    found = np.exp(codebook.initials([np.array([0, 2, 2, 1])], [np.array([1, 3])], 4))
    np.testing.assert_allclose(found, (np.array([0, 1, 1, 0]) + spread) / (2 + codebook.INITIAL_COUNT))


def test_states_are_sorted_and_repeatable():
    # Catches an order or a codebook that changes from run to run, and statistics of other frames than the state's.
    starts = [np.array([0, 40])]
    first, second = (codebook.train_channel([motion(6)], starts, 20) for _ in range(2))
    assert (np.diff(first.mean[:, 0]) >= 0).all() and first.count.sum() == 3000
    np.testing.assert_array_equal(first.mean, second.mean)
    np.testing.assert_allclose(first.count @ first.mean[:, 0] / 3000, motion(6).mean())


def test_nearest_centres_are_the_trees_to_the_last_bit():
    """Catches a point that is not looked at although another centre has come nearer, and a distance that is rounded
    otherwise; with points that are the same, centres that are, ones that are as far, and ones that move alone."""
    rng = np.random.default_rng(4)
    for points in (scaled(2), np.round(scaled(3)), rng.normal(size=(500, 3))):
        nearest = codebook._Nearest(points)
        centres = np.round(points[rng.choice(len(points), 24, replace=False)], 1)
        centres[5] = centres[6]
        for step in range(12):
            cell, squared = nearest(centres)
            expected = codebook.assign(points, centres)
            assert np.array_equal(cell, expected[0]) and np.array_equal(squared, expected[1])
            centres = centres + rng.normal(size=centres.shape) * 0.3 * 0.3**step
            if step > 6:  # one comes from afar
                centres[step] = centres[20] + 0.1


# ---- States that track slow motion -----------------------------------------------------------------------------------


STRIDE = 3


@pytest.fixture(scope="module")
def slow() -> Tuple[List[np.ndarray], List[np.ndarray]]:
    """Motion (T, 13) of a level that changes every two seconds at most, and targets that see it through noise."""
    rng = np.random.default_rng(0)
    level = [np.repeat(rng.choice([0.0, 50.0, 100.0], 12), 100) for _ in range(12)]
    motion = [np.repeat(np.convolve(np.pad(item, 5, mode="edge"), np.ones(11) / 11, "valid")[:, None], CHANNELS, 1)
              + rng.normal(0, 0.5, (1200, CHANNELS)) for item in level]
    return motion, [item + rng.normal(0, 40.0, item.shape) for item in motion]


def tables(motion: List[np.ndarray], targets: List[np.ndarray]) -> StateTables:
    begins = [np.array([0])] * len(motion)
    chains = [tracking.chain(tracking.ChannelTask([item[:, c] for item in motion], [item[:, c] for item in targets],
                                                  begins, 3, STRIDE, codebook.lbg)) for c in range(CHANNELS)]
    return tracking.chain_tables(chains, STRIDE)


def test_states_remember_what_targets_do_not_tell(slow) -> None:
    """Would catch emissions of the motion in place of the targets, and transitions of other steps than the search's:
    the states of the targets' own positions stray by as much as the targets do."""
    motion, targets = slow
    made = tables(motion, targets)
    ends = [np.arange(len(item)) == len(item) - 1 for item in motion]
    paths = decode(targets, ends, made)
    channels = np.arange(CHANNELS)
    strayed = np.mean([np.abs(made.state_mean[channels, path, 0] - item).mean() for path, item in zip(paths, motion)])
    assert strayed < 0.5 * np.mean([np.abs(item - target).mean() for item, target in zip(motion, targets)])
    by_position = replace(made, emission_mean=made.state_mean[..., 0],
                          emission_variance=np.full_like(made.emission_variance, 25.0))
    hasty = decode(targets, ends, by_position)
    assert strayed < 0.8 * np.mean([np.abs(made.state_mean[channels, path, 0] - item).mean()
                                    for path, item in zip(hasty, motion)])
    assert (np.diff(made.emission_mean, axis=1) >= 0).all()


def test_the_anchor_has_the_share_that_least_squares_gives_it() -> None:
    """By hand: in state 0 motion is its mean plus a quarter of what the target strays from it, in state 1 the target.
    Would catch shares of one state given to the other, and a hold that is not the inverse variance of what is left."""
    rng = np.random.default_rng(1)
    count = 40_000
    states = np.repeat([0, 1], count // 2)
    mean = np.array([0.0, 100.0])
    target = mean[states] + rng.normal(0, 20.0, count)
    left = rng.normal(0, 5.0, count)
    human = mean[states] + np.where(states == 0, 0.25, 0.9) * (target - mean[states]) + left
    flat = np.zeros((CHANNELS, 2))
    given = StateTables(np.tile(mean, (CHANNELS, 1)), flat + 1, np.zeros((CHANNELS, 2, 3)), np.ones((CHANNELS, 2, 3)),
                        flat, np.zeros((CHANNELS, 2, 2)), flat, STRIDE)
    wide = [np.repeat(values[:, None], CHANNELS, axis=1) for values in (states, target, human)]
    made = tracking.balance_states(given, [wide[0]], [wide[1]], [wide[2]], [np.ones((count, CHANNELS))],
                                   tracking.SCALES)
    hold = made.state_precision[0, :, 0] + made.state_anchor[0]
    np.testing.assert_allclose(made.state_anchor[0] / hold, [0.25, 0.9], atol=0.01)
    np.testing.assert_allclose(hold, 1 / 25.0, rtol=0.03)


def test_what_does_not_count_is_not_balanced(slow) -> None:
    """Would catch weights that are left out of the sums."""
    motion, targets = slow
    made = tables(motion, targets)
    paths = [np.zeros(item.shape, dtype=np.int64) for item in motion]
    weights = [np.full(item.shape, float(n < 6)) for n, item in enumerate(motion)]
    spoilt = [item if n < 6 else item + 500.0 for n, item in enumerate(motion)]
    once, again = (tracking.balance_states(made, paths, targets, human, weights, tracking.SCALES)
                   for human in (motion, spoilt))
    np.testing.assert_allclose(once.state_anchor, again.state_anchor)
    np.testing.assert_allclose(once.state_mean, again.state_mean)


def test_laughter_alone_tracks_and_the_published_method_does_not() -> None:
    """Would catch sizes of one kind or method used for another."""
    sizes = {}
    for kind in ("speech", "laughter"):
        for method in ("paper", "labial"):
            item = pipeline._setting(kind, method, 50, None, None, 0, 0.12, 3, codebook.lbg, False)
            sizes[kind, method] = item.codebook, item.components, item.tracking
    assert sizes.pop(("laughter", "labial")) == (10, 1, True)
    assert set(sizes.values()) == {(50, 5, False)}
    assert pipeline._setting("laughter", "labial", 50, 20, 3, 0, 0.12, 3, codebook.lbg, False).codebook == 20


def test_lips_that_rest_on_each_other_are_held_without_a_floor() -> None:
    """Would catch a floor that presses the lips together in a laugh, and pauses in which a laugh's smile would rest."""
    number = LAUGHTER.phonemes.index
    phoneme = np.array([number("silence"), number("a"), number("nasal"), number("silence")])
    frames = np.random.default_rng(2).normal(0, 50, (40, CHANNELS))
    item = Recording("laugh", phoneme, np.full(4, 0.2), np.full(4, 10), np.arange(5, 40, 10), frames)
    floor, contact = floors([item], LAUGHTER, 50)
    held = np.isin(FAP_NUMBERS, HELD["nose"])
    for label in LAUGHTER.phonemes:
        assert contact[number(label)].tolist() == (held if label in ("ne", "nasal") else ~held & held).tolist()
    least = np.tile(floor[0], (len(floor), 1))
    np.testing.assert_array_equal(floor, np.where(contact, -np.inf, least))
