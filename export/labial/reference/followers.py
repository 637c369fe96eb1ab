"""All channels of a frame, from those that are solved (``lib/followers.c``; docs/method.md, Channels that follow)."""

from __future__ import annotations

from typing import Callable

import numpy as np

from labial.files.faps import CHANNELS
from labial.tables.followers import CORNERS, FAP_17, FROM_CORNERS, VALUES, columns


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
    result: np.ndarray = np.interp(corners.mean(axis=1), np.linspace(ends[0], ends[1], len(values)), values)
    return result


def in_integers(corners: np.ndarray, low: int, gain: int, values: np.ndarray) -> np.ndarray:
    """(T,) FAP 17 of both corners (T, 2), all Q4 FAP, by the tables of ``labial_protrusion_t``."""
    at = (np.clip(corners.sum(axis=1) - 2 * low, 0, 65535) * gain) >> 12
    index = np.minimum(at >> 8, VALUES - 2)
    share = np.minimum(at - 256 * index, 256)
    result: np.ndarray = values[index] + (((values[index + 1] - values[index]) * share + 128) >> 8)
    return result
