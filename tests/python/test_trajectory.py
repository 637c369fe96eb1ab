"""Equation 3 against a dense solution of its definition and against SPTK's mlpg; its window; the published joins."""

from __future__ import annotations

import os
import subprocess

import numpy as np
import pytest

from labial.reference import published
from labial.reference.tables import Equation
from labial.reference.trajectory import forward, solve, solve_whole, starts
from packages import sptk


def terms(rng: np.random.Generator, frames: int, channels: int = 2, anchors: bool = True) -> Equation:
    shape = (frames, channels)
    mean = np.stack([rng.normal(0, 50, shape), rng.normal(0, 3, shape), rng.normal(0, 1, shape)], axis=-1)
    weight = np.stack([rng.uniform(0.5, 2, shape), rng.uniform(1, 8, shape), rng.uniform(1, 40, shape)], axis=-1)
    anchor = rng.uniform(0, 3, shape) if anchors else np.zeros(shape)
    return Equation(weight, mean, anchor, rng.normal(0, 50, shape))


def dense(item: Equation, channel: int, kept: int = 0) -> np.ndarray:
    """The same solution from W written out row by row. With `kept` that of the first `kept` frames' equations alone, in
    which all frames beyond stand for the last of these."""
    frames = len(item.weight)
    rows, precision, mean = [], [], []
    for t in range(frames):
        windows = [{t: 1.0}]
        if 0 < t < frames - 1:
            windows += [{t - 1: -0.5, t + 1: 0.5}, {t - 1: 1.0, t: -2.0, t + 1: 1.0}]
        for i, window in enumerate(windows):
            rows.append([window.get(s, 0.0) for s in range(frames)])
            precision.append(item.weight[t, channel, i])
            mean.append(item.mean[t, channel, i])
        rows.append([1.0 if s == t else 0.0 for s in range(frames)])
        precision.append(item.anchor[t, channel])
        mean.append(item.target[t, channel])
    w, u = np.array(rows), np.diag(precision)
    matrix, right = w.T @ u @ w, w.T @ u @ np.array(mean)
    if not kept:
        return np.linalg.solve(matrix, right)
    tied = np.eye(frames)[:, :kept]
    tied[kept:, -1] = 1.0
    return np.linalg.solve(matrix[:kept] @ tied, right[:kept])


@pytest.mark.parametrize("frames", [1, 2, 3, 4, 7, 40])
def test_solves_equation_3_as_it_is_defined(frames: int) -> None:
    """A wrong term of the running factorisation, or a delta row that is kept at an edge, shows against the matrix."""
    item = terms(np.random.default_rng(frames), frames)
    last = np.full((frames, 2), frames - 1)
    for channel in range(2):
        expected = dense(item, channel)
        for found in (solve_whole(item), solve(item, last), published.solve(item)):
            assert np.allclose(found[:, channel], expected, atol=1e-8)


@pytest.mark.parametrize("stiffness", [0.01, 1.0, 300.0])
def test_stays_exact_where_frames_are_hardly_held(stiffness: float) -> None:
    """Moving weights of 300 times what holds a frame, ten times what exported models may have, over a long stream: the
    factorisation by row sums has no small difference of large numbers to lose."""
    item = terms(np.random.default_rng(9), 300)
    item.weight[..., 1:] *= stiffness
    for channel in range(2):
        assert np.allclose(solve_whole(item)[:, channel], dense(item, channel), atol=1e-6)


def test_agrees_with_sptk() -> None:
    """An independent implementation of the published equation, without anchors."""
    program = sptk("mlpg")
    item = terms(np.random.default_rng(7), 120, channels=1, anchors=False)
    weight = item.weight.copy()
    weight[0, :, 1:] = weight[-1, :, 1:] = 0.0
    data = np.concatenate([item.mean[:, 0], weight[:, 0]], axis=1).astype("<f4").tobytes()
    command = [*program, "-l", "1", "-d", "-0.5", "0", "0.5", "-d", "1", "-2", "1", "-i", "1", "-s", "60"]
    done = subprocess.run(command, input=data, capture_output=True, check=True, env=os.environ)
    assert np.allclose(np.frombuffer(done.stdout, "<f4"), solve_whole(item)[:, 0], atol=1e-3)


def test_anchor_pulls_to_the_target() -> None:
    """With an overwhelming anchor the motion is the target; a sign or index error would leave it elsewhere."""
    item = terms(np.random.default_rng(3), 30)
    strong = Equation(item.weight, item.mean, np.full_like(item.anchor, 1e9), item.target)
    assert np.allclose(solve_whole(strong), item.target, atol=1e-3)


@pytest.mark.parametrize("start", [0, 1, 2, 5, 12])
def test_the_way_back_takes_what_lies_beyond_to_equal_its_start(start: int) -> None:
    """The equations of the frames up to there, solved as a dense system with all beyond set equal: nothing else is
    assumed, and nothing of what comes later is seen but the weights of the row beside."""
    item = terms(np.random.default_rng(start), 20)
    found = solve(item, np.maximum(np.full((20, 2), start), np.arange(20)[:, None]))
    for channel in range(2):
        expected = dense(item, channel, start + 1)
        assert np.allclose(found[: start + 1, channel], expected, atol=1e-8)


def test_nothing_is_seen_of_what_is_not_known_yet() -> None:
    """A way back that starts with frame s may depend on the states of s and of the frame behind it, and on no later."""
    item = terms(np.random.default_rng(4), 20)
    later = terms(np.random.default_rng(5), 20)
    start = np.minimum(np.arange(20)[:, None] + 6, 19).repeat(2, axis=1)
    for t in range(12):
        known = t + 6 + 2
        mixed = Equation(*(np.concatenate([getattr(item, name)[:known], getattr(later, name)[known:]])
                           for name in ("weight", "mean", "anchor", "target")))  # fmt: skip
        assert (solve(mixed, start)[: t + 1] == solve(item, start)[: t + 1]).all()


def test_starts_by_hand() -> None:
    """Stride 3, window 4. Channel 0 delivers the frames -1 .. 1 and 2 .. 4 with its blocks that end with 6 and 9: frame
    1 comes back from frame 5, frames 2 .. 4 from frame 8. With 10 frames in all the last block is the end."""
    assert starts(20, 3, 4)[:8, 0].tolist() == [5, 5, 8, 8, 8, 11, 11, 11]
    assert starts(20, 3, 4)[:8, 4].tolist() == [6, 6, 6, 9, 9, 9, 12, 12]  # its blocks end with 1, 4, 7, 10, 13
    assert starts(10, 3, 4)[:, 0].tolist() == [5, 5, 9, 9, 9, 9, 9, 9, 9, 9]
    assert starts(11, 3, 4)[:, 0].tolist() == [5, 5, 8, 8, 8, 10, 10, 10, 10, 10, 10]
    assert starts(20, 3, 4, 2)[:8, 0].tolist() == starts(20, 3, 4)[:8, 4].tolist()  # blocks that end with 3 decide 1
    assert starts(20, 1, 4)[:4, 7].tolist() == [4, 5, 6, 7] and starts(1, 3, 4).tolist() == [[0] * 13]


@pytest.mark.parametrize(("frames", "stride", "window"), [(1, 3, 4), (9, 1, 1), (40, 3, 4), (41, 8, 2), (17, 2, 40)])
def test_starts_are_as_far_ahead_as_promised(frames: int, stride: int, window: int) -> None:
    """At least the window, less than a stride more, or the end; each frame once, in blocks of the channel's grid."""
    found = starts(frames, stride, window)
    ahead = found - np.arange(frames)[:, None]
    assert ((ahead >= window) | (found == frames - 1)).all() and (ahead <= window + stride).all()
    assert ((ahead < window + stride) | (found == frames - 1)).all()
    inside = found < frames - 1
    channel = np.broadcast_to(np.arange(13), found.shape)
    assert ((found + 1 - channel)[inside] % stride == 0).all()


def test_a_longer_window_comes_nearer_to_the_whole() -> None:
    """The default loses little; 12 frames more lose a hundredth of it. A start taken from a wrong frame would not."""
    item = terms(np.random.default_rng(8), 200, channels=13)
    whole = solve_whole(item)
    error = [np.sqrt(((solve(item, starts(200, 3, window)) - whole) ** 2).mean()) for window in (1, 4, 16)]
    assert error[0] > 2 * error[1] and error[1] > 100 * error[2]


def test_rows_sum_to_what_holds_them() -> None:
    """rho and kappa by their meaning: where hardly any but the first frame is held, it draws all."""
    item = terms(np.random.default_rng(2), 25, anchors=False)
    item.weight[1:, :, 0] = 1e-12
    item.mean[..., 1:] = 0.0
    settled, rho, kappa = forward(item)
    assert np.allclose(settled, item.mean[0, :, 0]) and np.allclose(solve_whole(item), item.mean[0, :, 0])
    assert np.allclose(rho[-1], 1.0) and not kappa[-2:].any()  # nothing lies beyond the last frame
