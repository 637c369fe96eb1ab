"""LBG codebook and its counts: against SPTK's lbg, and by hand."""

from __future__ import annotations

import subprocess

import numpy as np

from labial.train.codebook import (
    INITIAL_COUNT,
    NEIGHBOUR_COUNT,
    _Nearest,
    assign,
    features,
    initials,
    lbg,
    train_channel,
    transitions,
)
from oracles import sptk


def motion(seed: int, frames: int = 3000) -> np.ndarray:
    """(frames,) a smooth wandering channel in FAP."""
    noise = np.random.default_rng(seed).normal(0, 1, frames)
    window = np.hanning(15)
    return 100 * np.convolve(np.cumsum(noise) * 0.05 + noise, window / window.sum(), "same")


def scaled(seed: int) -> np.ndarray:
    points = features(motion(seed))
    return points / points.std(axis=0)


def test_features_by_hand():
    # Catches a delta of two frames' difference without the half, or a shifted window.
    found = features(np.array([1.0, 2.0, 5.0, 4.0]))
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
        theirs = assign(points.astype(np.float64), centres)[1].mean()
        _, _, ours = lbg(points.astype(np.float64), size)
        assert ours < 1.03 * theirs


def test_sizes_between_powers_of_two():
    # Catches a last round that splits too many cells or leaves some empty, and a distortion of another codebook.
    points = scaled(4)
    distortions = []
    for size in (32, 50, 64):
        centres, cell, distortion = lbg(points, size)
        assert centres.shape == (size, 3) and (np.bincount(cell, minlength=size) > 0).all()
        np.testing.assert_allclose(((points - centres[cell]) ** 2).sum(axis=1).mean(), distortion)
        distortions.append(distortion)
    assert distortions[0] > distortions[1] > distortions[2]


def test_finds_separate_clusters():
    # Catches a split that never leaves a large cluster for a small one.
    rng = np.random.default_rng(5)
    centres = np.array([[0, 0, 0], [9, 0, 0], [0, 9, 0], [0, 0, 9], [9, 9, 9.0]])
    points = np.repeat(centres, [4000, 20, 30, 40, 50], axis=0)
    found, _, distortion = lbg(points + rng.normal(0, 0.1, points.shape), 5)
    assert distortion < 0.04
    assert assign(centres, found)[1].max() < 0.05


def test_fewer_values_than_states():
    # Catches an endless loop, NaN or a state at no place that was seen, where a channel hardly moves.
    still = [np.zeros(50), np.repeat([0.0, 40.0], 25)]
    book = train_channel(still, [np.array([0]), np.array([0, 25])], 50)
    for table in (book.mean, book.variance, book.log_initial):
        assert np.isfinite(table).all()
    assert set(np.round(book.mean[:, 0])) <= {0.0, 40.0}
    assert (book.variance > 0).all() and np.isfinite(book.log_transition).any(axis=0).all()


def test_transition_counts_by_hand():
    # Catches [to, from], counts across the ends of sequences, and rows that do not sum to 1.
    paths = [np.array([0, 0, 3, 3, 0]), np.array([1, 2])]
    near = NEIGHBOUR_COUNT
    expected = np.array(
        [
            [1 + near, near, 0, 1],
            [near, near, 1 + near, 0],
            [0, near, near, near],
            [1, 0, near, 1 + near],
        ]
    )
    found = np.exp(transitions(paths, 4))
    np.testing.assert_allclose(found, expected / expected.sum(axis=1, keepdims=True), atol=1e-12)


def test_initial_counts_by_hand():
    # Catches starts that are read from the wrong frame, and a state that no unit could start in.
    found = np.exp(initials([np.array([0, 2, 2, 1])], [np.array([1, 3])], 4))
    spread = INITIAL_COUNT * np.array([2, 2, 3, 1]) / 8
    expected = (np.array([0, 1, 1, 0]) + spread) / (2 + INITIAL_COUNT)
    np.testing.assert_allclose(found, expected)


def test_states_are_sorted_and_repeatable():
    # Catches an order or a codebook that changes from run to run, and statistics of other frames than the state's.
    starts = [np.array([0, 40])]
    first, second = (train_channel([motion(6)], starts, 20) for _ in range(2))
    assert (np.diff(first.mean[:, 0]) >= 0).all() and first.count.sum() == 3000
    np.testing.assert_array_equal(first.mean, second.mean)
    np.testing.assert_allclose(first.count @ first.mean[:, 0] / 3000, motion(6).mean())


def test_nearest_centres_are_the_trees_to_the_last_bit():
    """Catches a point that is not looked at although another centre has come nearer, and a distance that is rounded
    otherwise; with points that are the same, centres that are, ones that are as far, and ones that move alone."""
    rng = np.random.default_rng(4)
    for points in (scaled(2), np.round(scaled(3)), rng.normal(size=(500, 3))):
        nearest = _Nearest(points)
        centres = np.round(points[rng.choice(len(points), 24, replace=False)], 1)
        centres[5] = centres[6]
        for step in range(12):
            cell, squared = nearest(centres)
            expected = assign(points, centres)
            assert np.array_equal(cell, expected[0]) and np.array_equal(squared, expected[1])
            centres = centres + rng.normal(size=centres.shape) * 0.3 * 0.3**step
            if step > 6:  # one comes from afar
                centres[step] = centres[20] + 0.1
