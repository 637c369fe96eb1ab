"""Which channels of a frame a model solves, and how the others follow (``lib/followers.c``; docs/method.md).

A model's `source` (13,) names for each channel of a frame the one whose motion it has: itself where it is solved, the
other side of the mouth where it mirrors that, or FROM_CORNERS where it is FAP 17, computed of the corners.
"""

from __future__ import annotations

from typing import Callable, Tuple

import numpy as np

from labial.files.faps import CHANNELS, FAP_NUMBERS, SIDES
from labial.tables.fixed import POSITION_SCALE

#: Values of the table of FAP 17.
VALUES = 17
#: In `source`: the channel is computed of the corners. In the library's tables it is LABIAL_FROM_CORNERS.
FROM_CORNERS = -1
IN_TABLES = 255
#: Places in a frame of FAP 17 and of both corners.
FAP_17 = FAP_NUMBERS.index(17)
CORNERS = tuple(map(FAP_NUMBERS.index, (53, 54)))


def every() -> np.ndarray:
    """(13,) int64: the `source` of a model that solves all channels."""
    return np.arange(CHANNELS)


def mirrored() -> np.ndarray:
    """(13,) int64: the `source` of a model whose right side moves as its left one."""
    source = every()
    for left, right in SIDES:
        source[right] = left
    return source


def is_symmetric(source: np.ndarray) -> bool:
    """Whether both sides of the mouth move alike."""
    return all(source[left] == source[right] for left, right in SIDES)


def solved(source: np.ndarray) -> np.ndarray:
    """(C,) int64: the channels of a frame that are searched and solved, in the order of the tables."""
    return np.flatnonzero(source == np.arange(CHANNELS))


def columns(source: np.ndarray) -> np.ndarray:
    """(13,) int64: the place among those that are solved of each channel's source; FROM_CORNERS as it is."""
    return np.where(source == FROM_CORNERS, FROM_CORNERS, np.searchsorted(solved(source), source))


def integer_range(ends: np.ndarray) -> Tuple[int, int]:
    """`low` and `gain` of ``labial_protrusion_t`` for a range (2,) of the corners' mean, FAP."""
    low, high = (int(end) for end in np.rint(POSITION_SCALE * np.asarray(ends)))
    return low, round(2**24 / (2 * (high - low)))


def complete(motion: np.ndarray, source: np.ndarray, computed: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """(T, 13) FAP: frames of the motion (T, C) of the channels that are solved, with a model's `source` (13,);
    `computed` gives FAP 17 (T,) of both corners (T, 2), FAP."""
    column = columns(source)
    frames = np.empty((len(motion), CHANNELS))
    frames[:] = motion[:, np.maximum(column, 0)]
    if column[FAP_17] == FROM_CORNERS:
        frames[:, FAP_17] = computed(frames[:, CORNERS])
    return frames


def interpolated(corners: np.ndarray, ends: np.ndarray, values: np.ndarray) -> np.ndarray:
    """(T,) FAP 17 of both corners (T, 2): the `values` (17,) lie at even distances over the range `ends` (2,) of their
    mean, and are constant beyond; all FAP."""
    return np.interp(corners.mean(axis=1), np.linspace(ends[0], ends[1], len(values)), values)


def in_integers(corners: np.ndarray, low: int, gain: int, values: np.ndarray) -> np.ndarray:
    """(T,) FAP 17 of both corners (T, 2), all Q4 FAP, by the tables of ``labial_protrusion_t``."""
    at = (np.clip(corners.sum(axis=1) - 2 * low, 0, 65535) * gain) >> 12
    index = np.minimum(at >> 8, VALUES - 2)
    share = np.minimum(at - 256 * index, 256)
    return values[index] + (((values[index + 1] - values[index]) * share + 128) >> 8)
