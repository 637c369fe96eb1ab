"""FAP 17, protrusion of the top lip, as a function of the corners (``lib/protrusion.c``; docs/method.md, Protrusion).

A model with a table of it has no states for FAP 17. The channels that are searched and solved are then those of a frame
in their order, but the last one, FAP 60, in the place of FAP 17.
"""

from __future__ import annotations

from typing import Callable

import numpy as np

from labial.files.faps import CHANNELS, FAP_NUMBERS
from labial.tables.protrusion import VALUES, solved

_FAP_17 = FAP_NUMBERS.index(17)
#: The corners' channels.
CORNERS = tuple(map(FAP_NUMBERS.index, (53, 54)))


def complete(motion: np.ndarray, computed: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """(T, 13) FAP: frames of the motion (T, 12) of the channels that are solved; `computed` gives FAP 17 (T,) of both
    corners (T, 2), FAP."""
    frames = np.empty((len(motion), CHANNELS))
    frames[:, solved(True)] = motion
    frames[:, _FAP_17] = computed(frames[:, CORNERS])
    return frames


def interpolated(corners: np.ndarray, ends: np.ndarray, values: np.ndarray) -> np.ndarray:
    """(T,) FAP 17 of both corners (T, 2): the `values` (17,) lie at even distances over the range `ends` (2,) of their
    mean, and are constant beyond; all FAP."""
    result: np.ndarray = np.interp(corners.mean(axis=1), np.linspace(ends[0], ends[1], len(values)), values)
    return result


def in_integers(corners: np.ndarray, low: int, gain: int, values: np.ndarray) -> np.ndarray:
    """(T,) FAP 17 of both corners (T, 2), all Q4 FAP, by the tables of ``labial_protrusion_t``."""
    at = (np.clip(corners.sum(axis=1) - 2 * low, 0, 65535) * gain) >> 12
    index = np.minimum(at >> 8, VALUES - 2)
    share = np.minimum(at - 256 * index, 256)
    result: np.ndarray = values[index] + (((values[index + 1] - values[index]) * share + 128) >> 8)
    return result
