"""The whole reference: phonemes and durations in, frames out (``lib/stream.c``)."""

from __future__ import annotations

from typing import List, Sequence, Tuple

import numpy as np

from labial.errors import LabialError
from labial.faps import CHANNELS
from labial.reference import units
from labial.reference.shape import targets
from labial.reference.tables import Tables
from labial.reference.trajectory import join, solve

#: Longest duration of one phoneme, milliseconds.
DURATION_MAX = 3_600_000


def frame_counts(milliseconds: Sequence[int], fps: int) -> List[int]:
    """Frames of each phoneme; what one leaves over goes to the next, so that they amount to the rounded sum."""
    counts = []
    remainder = 500
    for duration in milliseconds:
        thousandths = int(duration) * fps + remainder
        counts.append(thousandths // 1000)
        remainder = thousandths % 1000
    return counts


def synthesise(tables: Tables, phonemes: Sequence[Tuple[int, int]], *, whole: bool = False,
               window: int = units.WINDOW) -> np.ndarray:
    """(T, 13) float64, FAP units: the motion of `phonemes`, pairs of phoneme number and milliseconds.

    Decodes piece by piece, as the library does, or with `whole` the utterance at once.
    """
    for number, milliseconds in phonemes:
        if not 0 <= number < len(tables.phonemes):
            raise LabialError(f"phoneme {number}: the model has {len(tables.phonemes)}")
        if not 0 <= milliseconds <= DURATION_MAX:
            raise LabialError(f"phoneme {tables.phonemes[number]}: {milliseconds} ms is not within 0 .. {DURATION_MAX}")
    numbers = [number for number, _ in phonemes]
    durations = [milliseconds for _, milliseconds in phonemes]
    frames = frame_counts(durations, tables.fps)
    if not sum(frames):
        return np.zeros((0, CHANNELS))
    boundary = [bool(tables.boundary[number]) for number in numbers]
    cut = units.whole(frames) if whole else units.pieces(frames, boundary, window)
    target = targets(tables, numbers, durations, frames)
    motion = []
    for piece in cut:
        positions = target[piece.begin : piece.end]
        path = tables.search(positions)
        motion.append(solve(tables.equation(path, positions)))
    return join(cut, motion)
