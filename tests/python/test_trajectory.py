"""Equation 3 against a dense solution of its definition and against SPTK's mlpg; the joining of units."""

from __future__ import annotations

import os
import subprocess

import numpy as np
import pytest

from labial.reference.tables import Equation
from labial.reference.trajectory import join, solve
from labial.reference.units import Piece
from oracles import sptk


def terms(rng: np.random.Generator, frames: int, channels: int = 2, anchors: bool = True) -> Equation:
    shape = (frames, channels)
    mean = np.stack([rng.normal(0, 50, shape), rng.normal(0, 3, shape), rng.normal(0, 1, shape)], axis=-1)
    weight = np.stack([rng.uniform(0.5, 2, shape), rng.uniform(1, 8, shape), rng.uniform(1, 40, shape)], axis=-1)
    anchor = rng.uniform(0, 3, shape) if anchors else np.zeros(shape)
    return Equation(weight, mean, anchor, rng.normal(0, 50, shape))


def dense(item: Equation, channel: int) -> np.ndarray:
    """The same solution from W written out row by row."""
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
    return np.linalg.solve(w.T @ u @ w, w.T @ u @ np.array(mean))


@pytest.mark.parametrize("frames", [1, 2, 3, 4, 7, 40])
def test_solves_equation_3_as_it_is_defined(frames: int) -> None:
    """A wrong band element, or a delta row that is kept at an edge, shows against the dense matrix."""
    item = terms(np.random.default_rng(frames), frames)
    found = solve(item)
    for channel in range(2):
        assert np.allclose(found[:, channel], dense(item, channel), atol=1e-8)


def test_agrees_with_sptk() -> None:
    """An independent implementation of the published equation, without anchors."""
    program = sptk("mlpg")
    item = terms(np.random.default_rng(7), 120, channels=1, anchors=False)
    weight = item.weight.copy()
    weight[0, :, 1:] = weight[-1, :, 1:] = 0.0
    data = np.concatenate([item.mean[:, 0], weight[:, 0]], axis=1).astype("<f4").tobytes()
    command = [*program, "-l", "1", "-d", "-0.5", "0", "0.5", "-d", "1", "-2", "1", "-i", "1", "-s", "60"]
    done = subprocess.run(command, input=data, capture_output=True, check=True, env=os.environ)
    assert np.allclose(np.frombuffer(done.stdout, "<f4"), solve(item)[:, 0], atol=1e-3)


def test_anchor_pulls_to_the_target() -> None:
    """With an overwhelming anchor the motion is the target; a sign or index error would leave it elsewhere."""
    item = terms(np.random.default_rng(3), 30)
    strong = Equation(item.weight, item.mean, np.full_like(item.anchor, 1e9), item.target)
    assert np.allclose(solve(strong), item.target, atol=1e-3)


def test_join_crosses_shared_frames_smoothly() -> None:
    """Frames of one piece are its own; shared ones go from the old to the new along 3 s^2 - 2 s^3."""
    pieces = [Piece(0, 6, 0, 3), Piece(3, 9, 3, 0)]
    joined = join(pieces, [np.zeros((6, 1)), np.full((6, 1), 4.0)])
    assert joined[:, 0].tolist() == [0, 0, 0, 0.625, 2, 3.375, 4, 4, 4]
