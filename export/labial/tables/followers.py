"""Which channels of a frame a model solves, and how the others follow (``lib/followers.h``).

A model's `source` (13,) names for each channel of a frame the one whose motion it has: itself where it is solved, the
other side of the mouth where it mirrors that, or FROM_CORNERS where it is FAP 17, computed of the corners.
"""

from __future__ import annotations

from typing import Tuple

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
