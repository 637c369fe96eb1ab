"""Frames files, ``time,fap3,fap16,...`` in seconds and FAP units; frames at other rates; stretches of frames."""

from __future__ import annotations

import math
from array import array
from typing import List, TextIO, Tuple

import numpy as np

from labial.files.faps import FAP_COLUMNS, FAP_NUMBERS, TOUCHING

#: Most frames of a grid for uneven times: this many, or ten times those of the file.
_MOST_FRAMES = 100000
#: Samples that are averaged over a frame's duration if the motion has a higher rate.
_OVERSAMPLING = 16
#: Tolerance of a frame's time on an even grid, seconds: times in files are rounded to milliseconds.
_ROUNDING = 0.0015
#: Columns of a frame: how far the upper lip is lowered, and the lower one raised.
_UPPER, _LOWER = FAP_NUMBERS.index(51), FAP_NUMBERS.index(52)
#: The first line of a frames file.
CSV_HEAD = ",".join(("time", *FAP_COLUMNS)) + "\n"


def write_csv(out: TextIO, frames: np.ndarray, fps: float, start: float = 0.0) -> None:
    """Writes (T, 13) frames from `start` seconds on; times are those of the frames' beginnings, with two decimals."""
    out.write(CSV_HEAD)
    write_csv_rows(out, frames, 0, fps, start)


def write_csv_rows(out: TextIO, frames: np.ndarray, first: int, fps: float, start: float = 0.0) -> None:
    """The lines of :func:`write_csv` of frames that begin with number `first`."""
    for t, frame in enumerate(frames, first):
        out.write(f"{start + t / fps:.3f}," + ",".join(f"{value:.2f}" for value in frame) + "\n")


def whole_faps(frames: np.ndarray) -> array[int]:
    """Frames (T, 13) in whole FAP units as the library takes them: 13 T numbers of 16 bits."""
    return array("h", np.clip(np.floor(frames + 0.5), -32768, 32767).astype(np.int16).tobytes())


def whole_shares(shares: np.ndarray) -> bytes:
    """Shares of sounds (T, 15), 0 .. 1, as the library takes them: 15 T bytes, LABIAL_VISEME_ONE for 1."""
    return bytes(np.rint(128 * np.clip(shares, 0, 1)).astype(np.uint8))


def opening(frames: np.ndarray) -> np.ndarray:
    """(..., T) the distance of the outer lips' middles in frames (..., T, 13 or more), FAP units."""
    return -(frames[..., _UPPER] + frames[..., _LOWER])


def sampled(times: np.ndarray, frames: np.ndarray, fps: float, count: int, origin: float = 0.0) -> np.ndarray:
    """(count, K) frames at `fps` per second, the first of which begins at `origin`, seconds, of frames (T, K) whose
    `times` are (T,). Motion is interpolated linearly at the centre of each frame, and held before and after the times.
    Motion of a higher rate is averaged over each frame's duration instead, which avoids aliasing."""
    steps = np.diff(times)
    points = _OVERSAMPLING if len(steps) > 0 and np.median(steps) < 0.99 / fps else 1
    moments = origin + (np.arange(count * points) + 0.5) / (fps * points)
    samples = [np.interp(moments, times, channel) for channel in frames.T]
    return np.stack(samples, axis=1).reshape(count, points, -1).mean(axis=1)


def at_rate(frames: np.ndarray, fps: float, wanted: float) -> np.ndarray:
    """(N, K) frames at `wanted` per second of motion (T, K) at `fps` that was made, for at least as long. They are
    :func:`sampled`, but for what averages would hide: the last one is the motion's last, and one within which the lips
    touch has the pose in which they are nearest."""
    if fps == wanted or not len(frames):
        return frames
    count = math.ceil(len(frames) * wanted / fps - 1e-9)
    result = sampled((np.arange(len(frames)) + 0.5) / fps, frames, wanted, count)
    apart = opening(frames)
    for number in range(count if wanted < fps else 0):
        first, end = math.floor(number * fps / wanted + 1e-9), math.ceil((number + 1) * fps / wanted - 1e-9)
        nearest = first + int(np.argmin(apart[first:end]))
        if apart[nearest] <= TOUCHING:
            result[number] = frames[nearest]
    result[-1] = frames[-1]
    return result


def even(times: np.ndarray, frames: np.ndarray) -> Tuple[float, np.ndarray]:
    """Frames per second and (N, K) frames at even steps from the first of `times` (T,), seconds, interpolated linearly
    where these are uneven. A single frame counts as 25 per second. Raises ValueError for times that are too uneven for
    a grid."""
    if len(times) < 2:
        return 25.0, frames
    span, steps = float(times[-1] - times[0]), len(times) - 1
    grid = times[0] + np.arange(steps + 1) * (span / steps)
    if np.abs(grid - times).max() <= _ROUNDING:
        rate = steps / span
        # The uncertainty of the rate from rounded times; most rates are integers.
        whole = abs(rate - round(rate)) <= rate * 2 * _ROUNDING / span
        return (float(round(rate)) if whole and round(rate) > 0 else rate), frames
    rate = 1.0 / float(np.median(np.diff(times)))
    if span * rate > max(_MOST_FRAMES, 10 * len(times)):
        raise ValueError(f"its times are too uneven: {len(times)} frames, {1 / rate:g} s apart, within {span:g} s")
    grid = times[0] + np.arange(math.floor(span * rate + 1e-6) + 1) / rate
    return rate, np.stack([np.interp(grid, times, channel) for channel in frames.T], axis=1)


def spans(holds: np.ndarray) -> List[Tuple[int, int]]:
    """The first frame of each stretch in which `holds` (T,) is true, and the frame after its last."""
    changes = np.flatnonzero(np.diff(holds.astype(np.int8), prepend=0, append=0)).tolist()
    return list(zip(changes[::2], changes[1::2]))


def spans_told(times: np.ndarray, holds: np.ndarray, most: int) -> str:
    """The times at which `holds` (T,) is true, such as "0.10 to 0.32, 1.00 to 1.20 s and 3 times more": the first
    `most` stretches, each from the time of its first frame to that of its last; `times` (T,) are in seconds."""
    every = [f"{times[first]:.2f} to {times[end - 1]:.2f}" for first, end in spans(holds)]
    more = f" and {len(every) - most} times more" if len(every) > most else ""
    return f"{', '.join(every[:most])} s{more}"
