"""Which channels a model's tables have, where they hold FAP 17 as a function of the corners (``lib/protrusion.h``)."""

from __future__ import annotations

from typing import Tuple

import numpy as np

from labial.files.faps import CHANNELS, FAP_NUMBERS
from labial.tables.fixed import POSITION_SCALE

#: Values of a table.
VALUES = 17


def solved(computed: bool) -> np.ndarray:
    """(C,) int64: the channels of a frame that are searched and solved, in the order of the tables. Where FAP 17 is
    `computed`, FAP 60, the last one, is in its place, so that the others keep theirs, and their turns."""
    order = np.arange(CHANNELS)
    if computed:
        order = order[:-1]
        order[FAP_NUMBERS.index(17)] = CHANNELS - 1
    return order


def integer_range(ends: np.ndarray) -> Tuple[int, int]:
    """`low` and `gain` of ``labial_protrusion_t`` for a range (2,) of the corners' mean, FAP."""
    low, high = (int(end) for end in np.rint(POSITION_SCALE * np.asarray(ends)))
    return low, round(2**24 / (2 * (high - low)))
