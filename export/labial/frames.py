"""Frames files, ``time,fap3,fap16,...`` in seconds and FAP units, and frames at other rates."""

from __future__ import annotations

import math
from typing import TextIO, Tuple

import numpy as np

from labial.faps import FAP_COLUMNS

#: Frames, or ten times those that a file has, that are put between uneven times at most.
_MOST_FRAMES = 100000
#: Samples that are averaged over a frame's duration where the motion has a higher rate.
_OVERSAMPLING = 16
#: A frame may be this far from its place on an even grid, seconds: times in files are rounded to milliseconds.
_ROUNDING = 0.0015


def write_csv(out: TextIO, frames: np.ndarray, fps: float, start: float = 0.0) -> None:
    """Writes (T, 13) frames from `start` seconds, whose times are those of their beginnings, with two decimals."""
    out.write(",".join(("time", *FAP_COLUMNS)) + "\n")
    for t, frame in enumerate(frames):
        out.write(f"{start + t / fps:.3f}," + ",".join(f"{value:.2f}" for value in frame) + "\n")


def sampled(times: np.ndarray, frames: np.ndarray, fps: float, count: int, origin: float = 0.0) -> np.ndarray:
    """(count, K) frames at `fps` per second, the first of which begins at `origin`, seconds, of frames (T, K) whose
    `times` are (T,).

    Motion is interpolated linearly at the centre of each frame, and held before and after the times. Motion of a higher
    rate is averaged over each frame's duration instead, so that what is faster than the new rate does not fold back
    into it.
    """
    steps = np.diff(times)
    dense = len(steps) > 0 and np.median(steps) < 0.99 / fps
    points = _OVERSAMPLING if dense else 1
    moments = origin + (np.arange(count * points) + 0.5) / (fps * points)
    samples = [np.interp(moments, times, channel) for channel in frames.T]
    return np.stack(samples, axis=1).reshape(count, points, -1).mean(axis=1)


def at_rate(frames: np.ndarray, fps: float, wanted: float) -> np.ndarray:
    """(N, K) frames at `wanted` per second of frames (T, K) at `fps`, resampled by :func:`sampled`. Both begin at the
    same time, and N is as near to the same duration as a whole number of frames can be."""
    if fps == wanted or not len(frames):
        return frames
    count = max(math.floor(len(frames) * wanted / fps + 0.5), 1)
    return sampled((np.arange(len(frames)) + 0.5) / fps, frames, wanted, count)


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
