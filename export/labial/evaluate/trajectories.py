"""Measures of one trajectory against another. T frames, K channels; `mask` (T,) marks the judged frames."""

from __future__ import annotations

from typing import Sequence

import numpy as np

from labial.files.faps import FAP_NAMES

#: Names of the labial parameters of the paper's Table 1.
PARAMETERS = ("openness", "extension", "top", "bottom")

#: The channels of correlation, amplitude, jitter and seams.
JUDGED_NAMES = ("open_jaw", "raise_b_midlip_o", "stretch_l_cornerlip_o", "push_t_lip")
JUDGED = tuple(FAP_NAMES.index(name) for name in JUDGED_NAMES)


#: The measures of connected speech, which need no common scale of talkers: jaw, lips, a corner, and openness.
LIPS = ("open_jaw", "lower_t_midlip_o", "raise_b_midlip_o", "stretch_l_cornerlip_o", "openness")


def lips(frames: np.ndarray) -> np.ndarray:
    """(T, 5) the LIPS of frames (T, 13)."""
    return np.column_stack([frames[:, [FAP_NAMES.index(name) for name in LIPS[:-1]]], labial_parameters(frames)[:, 0]])


def labial_parameters(frames: np.ndarray) -> np.ndarray:
    """(T, 4) openness -(fap51 + fap52), extension fap53 + fap54, top protrusion fap17, bottom protrusion fap16."""
    channel = {name: frames[:, index] for index, name in enumerate(FAP_NAMES)}
    return np.stack(
        [
            -(channel["lower_t_midlip_o"] + channel["raise_b_midlip_o"]),
            channel["stretch_l_cornerlip_o"] + channel["stretch_r_cornerlip_o"],
            channel["push_t_lip"],
            channel["push_b_lip"],
        ],
        axis=1,
    )


def correlation(human: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """(K,) Pearson correlation over the frames (T, K); 0 where either does not move."""
    a, b = human - human.mean(axis=0), motion - motion.mean(axis=0)
    scale = np.sqrt((a**2).sum(axis=0) * (b**2).sum(axis=0))
    still = scale < 1e-9 * len(a)
    return np.where(still, 0.0, (a * b).sum(axis=0) / np.where(still, 1.0, scale))


def amplitude(human: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """(K,) standard deviation of the motion over that of the human's; NaN where that does not move."""
    spread = human.std(axis=0)
    moves = spread > 1e-9
    return np.where(moves, motion.std(axis=0) / np.where(moves, spread, 1.0), np.nan)


def differences(frames: np.ndarray, mask: np.ndarray, order: int) -> np.ndarray:
    """(n, K) differences of this order over every window of order + 1 frames that is judged throughout."""
    if len(frames) <= order:
        return np.zeros((0, frames.shape[1]))
    whole = np.lib.stride_tricks.sliding_window_view(mask, order + 1).all(axis=1)
    return np.diff(frames, n=order, axis=0)[whole]


def joins(begin: Sequence[int], fade: Sequence[int], frames: int) -> np.ndarray:
    """(T - 2,) bool: second differences, of frames t, t + 1 and t + 2, that a unit's join touches.

    A join is where a cross-fade begins (between begin - 1 and begin) and where it ends (between begin + fade - 1 and
    begin + fade); it touches the two second differences that span it.
    """
    touched = np.zeros(max(frames - 2, 0), dtype=bool)
    for first, count in zip(begin, fade):
        for edge in (first, first + count):
            for t in (edge - 2, edge - 1):
                if 0 <= t < len(touched):
                    touched[t] = True
    return touched
