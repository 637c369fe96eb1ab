"""Phonemes to targets: each phoneme's shape and, frame by frame, what its neighbours' kernels add (``lib/shape.c``)."""

from __future__ import annotations

from typing import Optional, Sequence, Tuple

import numpy as np

from labial.faps import CHANNELS
from labial.reference.contact import raised
from labial.reference.tables import Tables


def knot_shares(length: np.ndarray, knots: int) -> np.ndarray:
    """(T, K) the shares of K knots in each frame of phonemes of `length` (S,) frames: all of the one knot there is, or
    of the first of two 1 - w, of the second w = (2 j + 1) / (2 n) in frame j of n, which is linear in time."""
    if knots == 1:
        return np.ones((int(np.sum(length)), 1))
    frame = np.arange(int(np.sum(length))) - np.repeat(np.cumsum(length) - length, length)
    share = (2 * frame + 1) / (2 * np.repeat(length, length))
    return np.stack([1.0 - share, share], axis=1)


def targets(
    tables: Tables, phonemes: Sequence[int], milliseconds: Sequence[int], frames: Sequence[int]
) -> np.ndarray:
    """(T, 13) the moving target of an utterance, in the tables' positions; phonemes of no frames leave no trace,
    silence is before and after."""
    return targets_and_contact(tables, phonemes, milliseconds, frames)[0]


def targets_and_contact(
    tables: Tables,
    phonemes: Sequence[int],
    milliseconds: Sequence[int],
    frames: Sequence[int],
    rest: Optional[np.ndarray] = None,
) -> Tuple[np.ndarray, np.ndarray]:
    """The targets (T, 13) of :func:`targets`, and where they are in contact, (T, 13) bool; `rest` (T,) is how far the
    mouth has come to rest in pauses."""
    held = [i for i, count in enumerate(frames) if count]
    seen = [tables.silence] + [phonemes[i] for i in held] + [tables.silence]
    length = np.array([frames[i] for i in held], dtype=np.int64)
    shapes = np.zeros((len(held), tables.knots, CHANNELS), dtype=tables.dtype)
    for j, i in enumerate(held):
        shapes[j] = tables.select(phonemes[i], min(milliseconds[i], 65535), seen[j], seen[j + 2])
    index = np.repeat(np.arange(len(held)), length)
    labels = np.array([phonemes[i] for i in held], dtype=np.int64)[index]
    reach = int(np.abs(tables.lags).max()) if len(tables.lags) else 0
    padded = np.concatenate([np.full(reach, tables.silence), labels, np.full(reach, tables.silence)]).astype(np.int64)
    at = np.arange(len(labels))[:, None] + reach + tables.lags[None, :]
    moving = tables.targets(tables.interpolated(shapes[index], knot_shares(length, tables.knots)), padded[at])
    rest = np.zeros(len(labels), dtype=np.int64) if rest is None else rest
    return raised(moving, labels, length, rest, tables.silence, tables.floor, tables.contact)
