"""States to motion: equation 3 of the paper, with anchors, and the joining of units (``lib/trajectory.c``)."""

from __future__ import annotations

from typing import Sequence

import numpy as np

from labial.reference.tables import Equation
from labial.reference.units import Piece


def solve(terms: Equation) -> np.ndarray:
    """(T, 13) trajectories m that solve (W' U^-1 W + A) m = W' U^-1 mu + A x, per channel.

    W stacks the static, delta ((m[t+1] - m[t-1]) / 2) and delta-delta (m[t+1] - 2 m[t] + m[t-1]) rows of every frame;
    those whose window would leave the piece are dropped. The matrix is pentadiagonal; it is factored as L D L'.
    """
    weight, mean = terms.weight.copy(), terms.mean
    frames = len(weight)
    weight[0, :, 1:] = 0.0
    weight[-1, :, 1:] = 0.0
    static, delta, delta2 = weight[..., 0], weight[..., 1] / 4.0, weight[..., 2]
    diagonal = static + terms.anchor + 4.0 * delta2
    diagonal[1:] += delta[:-1] + delta2[:-1]
    diagonal[:-1] += delta[1:] + delta2[1:]
    first = np.zeros_like(diagonal)  # [t, t + 1]
    first[:-1] = -2.0 * (delta2[:-1] + delta2[1:])
    second = np.zeros_like(diagonal)  # [t, t + 2]
    second[:-2] = (delta2 - delta)[1:-1]
    delta_pull, delta2_pull = 2.0 * delta * mean[..., 1], delta2 * mean[..., 2]
    right = static * mean[..., 0] + terms.anchor * terms.target - 2.0 * delta2_pull
    right[1:] += delta_pull[:-1] + delta2_pull[:-1]
    right[:-1] += delta2_pull[1:] - delta_pull[1:]
    return _solve_pentadiagonal(diagonal, first, second, right) if frames else right


def _solve_pentadiagonal(diagonal: np.ndarray, first: np.ndarray, second: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solves symmetric positive definite pentadiagonal systems, one per column; all arguments are (T, K)."""
    frames = len(diagonal)
    pivot, lower1, lower2, solution = (np.zeros_like(right) for _ in range(4))
    for t in range(frames):
        pivot[t] = diagonal[t]
        above = first[t].copy()
        solution[t] = right[t]
        if t >= 1:
            pivot[t] -= lower1[t - 1] ** 2 * pivot[t - 1]
            above -= lower2[t - 1] * lower1[t - 1] * pivot[t - 1]
            solution[t] -= lower1[t - 1] * solution[t - 1]
        if t >= 2:
            pivot[t] -= lower2[t - 2] ** 2 * pivot[t - 2]
            solution[t] -= lower2[t - 2] * solution[t - 2]
        lower1[t] = above / pivot[t]
        lower2[t] = second[t] / pivot[t]
    solution /= pivot
    for t in range(frames - 2, -1, -1):
        solution[t] -= lower1[t] * solution[t + 1]
        if t + 2 < frames:
            solution[t] -= lower2[t] * solution[t + 2]
    return solution


def join(pieces: Sequence[Piece], trajectories: Sequence[np.ndarray]) -> np.ndarray:
    """(T, 13): the pieces' trajectories laid end to end, cross-faded along 3 s^2 - 2 s^3 where two
    share frames."""
    total = pieces[-1].end if pieces else 0
    result = np.zeros((total, trajectories[0].shape[1] if trajectories else 0))
    for piece, motion in zip(pieces, trajectories):
        fade = piece.fade_in
        s = (np.arange(1, fade + 1) / (fade + 1))[:, None]
        share = s * s * (3.0 - 2.0 * s)
        shared = slice(piece.begin, piece.begin + fade)
        result[shared] += (motion[:fade] - result[shared]) * share
        result[piece.begin + fade : piece.end] = motion[fade:]
    return result
