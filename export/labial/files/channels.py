"""Channels that cancel each other, as those of a recording with one of two plugs the wrong way round."""

from __future__ import annotations

import os
import warnings
from typing import Union

import numpy as np

#: The mean of channels that cancel each other has less than this share of their energy. Nothing is said until they have
#: that of a faint sound: 10 ms of 16 kHz at 80 of 32,768.
_SHARE, _FAINT = 0.01, 1e6


class Phase:
    """Finds out whether the mean of a sound's channels is nearly silent while they are not; then it warns once."""

    def __init__(self, path: Union[str, os.PathLike[str]]) -> None:
        self._path = os.fspath(path)
        self._each = self._mean = 0.0
        self._warned = False

    def cancels(self, samples: np.ndarray, full_scale: float = 32768.0) -> bool:
        """Whether the sound up to and with these samples (N, C) is one whose channels cancel each other, so that the
        first is to be taken alone."""
        numbers = samples.astype(np.float64) * (32768.0 / full_scale)
        self._each += float((numbers**2).sum()) / max(1, samples.shape[1])
        self._mean += float((numbers.mean(axis=1) ** 2).sum())
        found = self._each >= _FAINT and self._mean < _SHARE * self._each
        if found and not self._warned:
            self._warned = True
            number = "two" if samples.shape[1] == 2 else str(samples.shape[1])
            warnings.warn(f"{self._path}: its {number} channels cancel each other, so the first one is heard alone",
                          stacklevel=3)
        return found
