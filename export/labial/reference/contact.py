"""Contact: lips that meet in p, b, m, the lower lip at the teeth in f, v, however short these are (``lib/shape.c``).

In contact a target does not fall below its floor, and equation 3 ties the frame to it firmly. A phoneme shorter than
FRAMES borrows the frame before it and, if it has only one frame, the frame after it as well. A phoneme of LONG frames
or more includes a pause; it is in contact only in its LAST frames. In a pause the mouth comes to rest, except in the
last frames, which lead to what follows.
"""

from __future__ import annotations

from typing import Tuple

import numpy as np

#: Frames (``include/labial/model.h``).
FRAMES = 3
LONG = 15
LAST = 8
REST = 16


def raised(
    target: np.ndarray,
    labels: np.ndarray,
    length: np.ndarray,
    rest: np.ndarray,
    silence: int,
    floor: np.ndarray,
    contact: np.ndarray,
    begin: int = 0,
) -> Tuple[np.ndarray, np.ndarray]:
    """Targets (N, 13) that keep the floors, and where they are in contact, (N, 13) bool; they are those of N frames
    from frame `begin` on.

    `labels` (T,) are the phonemes of all frames, `length` (S,) the frames of each phoneme, `rest` (T,) how far the
    mouth has come to rest, of REST. `floor` (P, 13) is what a phoneme's targets do not fall below, in the unit of
    `target`; `contact` (P, 13) bool says where it is contact, or for silence where the mouth comes to rest.
    """
    frames = len(target)
    here = slice(begin, begin + frames)
    padded = np.concatenate([np.full(FRAMES, silence), labels, np.full(FRAMES, silence)])

    def label(lag: int) -> np.ndarray:
        return padded[FRAMES + lag + begin : FRAMES + lag + begin + frames]

    whole = np.repeat(length, length)[here]
    left = np.repeat(np.cumsum(length), length)[here] - np.arange(here.start, here.stop)
    labels, rest = labels[here], rest[here]
    closing = ((whole < LONG) | (left <= LAST)) & (labels != silence)
    short = (label(1) != labels) & (label(1) != silence) & ~((label(1) == label(2)) & (label(2) == label(3)))
    single = (label(-1) != labels) & (label(-1) != silence) & (label(-1) != label(-2))
    own = contact[labels] & closing[:, None]
    before = contact[label(1)] & short[:, None]
    after = contact[label(-1)] & single[:, None]
    target = np.where(contact[labels] & ~own, target, np.maximum(target, floor[labels]))
    target = np.where(contact[silence] & (rest > 0)[:, None], _part_of_way(target, floor[silence], rest), target)
    target = np.where(before, np.maximum(target, floor[label(1)]), target)
    target = np.where(after, np.maximum(target, floor[label(-1)]), target)
    return target, own | before | after


def _part_of_way(target: np.ndarray, pose: np.ndarray, rest: np.ndarray) -> np.ndarray:
    """(T, 13) `rest` (T,) of REST of the way from targets (T, 13) to a pose (13,); integers are divided as in C."""
    with np.errstate(invalid="ignore"):
        way = (pose - target) * rest[:, None]
    if np.issubdtype(target.dtype, np.integer):
        return target + np.sign(way) * (np.abs(way) // REST)
    return target + way / REST
