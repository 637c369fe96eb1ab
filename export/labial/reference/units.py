"""Phonemes to pieces: the stretches that are decoded at once (section 3 of the method; ``lib/units.c``)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import List, Sequence

#: The library's default limits (``include/labial/labial.h``), frames.
WINDOW = 40
PIECE = 16
OVERLAP = 8


@dataclass(frozen=True)
class Piece:
    """Frames begin .. end - 1, of which the first `fade_in` are shared with the piece before and the last `fade_out`
    with the piece after."""

    begin: int
    end: int
    fade_in: int
    fade_out: int


def whole(frames: Sequence[int]) -> List[Piece]:
    """One piece for the whole utterance."""
    total = sum(frames)
    return [Piece(0, total, 0, 0)] if total else []


def pieces(frames: Sequence[int], boundary: Sequence[bool], window: int = WINDOW) -> List[Piece]:
    """Cuts phonemes of the given frames into pieces.

    A unit is what lies from one boundary phoneme to the next inclusive; a piece holds as many units as it takes to
    have PIECE frames, or as fit the `window`. Neighbours share the boundary phoneme, its last OVERLAP frames if it is
    longer. A unit that does not fit the window is cut, and the parts share OVERLAP frames. Phonemes of no frames are
    left out. The last phoneme always ends a unit.
    """
    spans = []
    start = 0
    for count, is_boundary in zip(frames, boundary):
        if count:
            spans.append((start, start + count, is_boundary))
            start += count
    result: List[Piece] = []
    begin = fade_in = 0
    while begin < start:
        limit = begin + window
        end, fade_out = limit, OVERLAP
        for from_frame, to_frame, is_boundary in spans[:-1]:
            if is_boundary and from_frame >= begin + fade_in and from_frame > begin and to_frame <= limit:
                end, fade_out = to_frame, min(to_frame - from_frame, (to_frame - begin) // 2, OVERLAP)
                if end - begin >= PIECE:
                    break
        else:
            if start <= limit:
                end, fade_out = start, 0
        result.append(Piece(begin, end, fade_in, fade_out))
        if not fade_out:
            break
        begin, fade_in = end - fade_out, fade_out
    return result
