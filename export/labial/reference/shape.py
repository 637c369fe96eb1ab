"""Phonemes to targets: each phoneme's shape and, frame by frame, what its neighbours' kernels add (``lib/shape.c``)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Sequence

import numpy as np

from labial.faps import CHANNELS
from labial.reference.tables import Tables


@dataclass(frozen=True)
class Targets:
    """Per frame of the utterance: `position` (T, 13) in the tables' positions; `component` and `frames` (T,), the best
    component of the frame's phoneme and the phoneme's length."""

    position: np.ndarray
    component: np.ndarray
    frames: np.ndarray


def targets(tables: Tables, phonemes: Sequence[int], milliseconds: Sequence[int], frames: Sequence[int]) -> Targets:
    """The moving target of an utterance; phonemes of no frames leave no trace, silence is before and after."""
    held = [i for i, count in enumerate(frames) if count]
    seen = [tables.silence] + [phonemes[i] for i in held] + [tables.silence]
    shapes = np.zeros((len(held), CHANNELS), dtype=tables.dtype)
    components = np.zeros(len(held), dtype=np.int64)
    for j, i in enumerate(held):
        shapes[j], components[j] = tables.select(
            phonemes[i], min(milliseconds[i], 65535), seen[j], seen[j + 2]
        )
    counts = np.array([frames[i] for i in held], dtype=np.int64)
    index = np.repeat(np.arange(len(held)), counts)
    labels = np.array([phonemes[i] for i in held], dtype=np.int64)[index]
    reach = int(np.abs(tables.lags).max()) if len(tables.lags) else 0
    padded = np.concatenate([np.full(reach, tables.silence), labels, np.full(reach, tables.silence)]).astype(np.int64)
    at = np.arange(len(labels))[:, None] + reach + tables.lags[None, :]
    return Targets(tables.targets(shapes[index], labels, padded[at]), components[index], counts[index])
