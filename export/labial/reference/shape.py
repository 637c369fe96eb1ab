"""Phonemes to targets: each phoneme's shape and, frame by frame, what its neighbours' kernels add (``lib/shape.c``)."""

from __future__ import annotations

from typing import Sequence

import numpy as np

from labial.faps import CHANNELS
from labial.reference.tables import Tables


def targets(
    tables: Tables, phonemes: Sequence[int], milliseconds: Sequence[int], frames: Sequence[int]
) -> np.ndarray:
    """(T, 13) the moving target of an utterance, in the tables' positions; phonemes of no frames leave no trace,
    silence is before and after."""
    held = [i for i, count in enumerate(frames) if count]
    seen = [tables.silence] + [phonemes[i] for i in held] + [tables.silence]
    shapes = np.zeros((len(held), CHANNELS), dtype=tables.dtype)
    for j, i in enumerate(held):
        shapes[j] = tables.select(phonemes[i], min(milliseconds[i], 65535), seen[j], seen[j + 2])
    index = np.repeat(np.arange(len(held)), [frames[i] for i in held])
    labels = np.array([phonemes[i] for i in held], dtype=np.int64)[index]
    reach = int(np.abs(tables.lags).max()) if len(tables.lags) else 0
    padded = np.concatenate([np.full(reach, tables.silence), labels, np.full(reach, tables.silence)]).astype(np.int64)
    at = np.arange(len(labels))[:, None] + reach + tables.lags[None, :]
    return tables.targets(shapes[index], labels, padded[at])
