"""Frames files: ``time,fap3,fap16,...``, seconds and FAP units."""

from __future__ import annotations

import math
from typing import TextIO, Tuple

import numpy as np

from labial.faps import FAP_COLUMNS

#: Frames, or ten times those that a file has, that are put between uneven times at most.
_MOST_FRAMES = 100000
#: A frame may be this far from its place on an even grid, seconds: times in files are rounded to milliseconds.
_ROUNDING = 0.0015


def write_csv(out: TextIO, frames: np.ndarray, fps: float, start: float = 0.0) -> None:
    """Writes (T, 13) frames from `start` seconds, whose times are those of their beginnings, with two decimals."""
    out.write(",".join(("time", *FAP_COLUMNS)) + "\n")
    for t, frame in enumerate(frames):
        out.write(f"{start + t / fps:.3f}," + ",".join(f"{value:.2f}" for value in frame) + "\n")


def even(times: np.ndarray, frames: np.ndarray) -> Tuple[float, np.ndarray]:
    """Frames per second and (N, K) frames at even steps from the first of `times` (T,), seconds, interpolated linearly
    where these are uneven. A single frame counts as 25 per second. Raises ValueError for times so uneven that the grid
    would hardly have anything to do with the frames."""
    if len(times) < 2:
        return 25.0, frames
    span, steps = float(times[-1] - times[0]), len(times) - 1
    grid = times[0] + np.arange(steps + 1) * (span / steps)
    if np.abs(grid - times).max() <= _ROUNDING:
        rate = steps / span
        # Rounded times leave the rate uncertain by this much; whole rates are the rule.
        whole = abs(rate - round(rate)) <= rate * 2 * _ROUNDING / span
        return (float(round(rate)) if whole and round(rate) > 0 else rate), frames
    rate = 1.0 / float(np.median(np.diff(times)))
    if span * rate > max(_MOST_FRAMES, 10 * len(times)):
        raise ValueError(f"its times are too uneven: {len(times)} frames, {1 / rate:g} s apart, within {span:g} s")
    grid = times[0] + np.arange(math.floor(span * rate + 1e-6) + 1) / rate
    return rate, np.stack([np.interp(grid, times, channel) for channel in frames.T], axis=1)
