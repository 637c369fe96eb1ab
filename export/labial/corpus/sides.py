"""Mouths whose two sides move alike: both follow the mean of what was recorded of them.

Phonemes ask the same of both sides of a mouth. What a talker's sides do differently is his own, and twice as much is
learnt of their mean as of either.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Iterable, List

from labial.corpus.episode import Episode
from labial.files.faps import SIDES

if TYPE_CHECKING:
    import numpy as np


def with_even_sides(corpus: Iterable[Episode]) -> List[Episode]:
    """The episodes with the channels of both sides at their mean. Where only one side is learnt from, both are it."""
    return [_even(item) for item in corpus]


def _even(item: Episode) -> Episode:
    frames, left_out = item.frames.copy(), item.source.left_out
    for left, right in SIDES:
        own = [side for side in (left, right) if side not in left_out] or [left, right]
        mean: np.ndarray = frames[:, own].mean(axis=1)
        frames[:, left] = frames[:, right] = mean
        if len(own) == 1:
            left_out = left_out - {left, right}
    return replace(item, frames=frames, source=replace(item.source, left_out=left_out))
