"""Phonemes to frames, pauses cut in two, and where units end (docs/method.md, Units and search; ``lib/units.c``)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import List, Optional, Sequence, Tuple

import numpy as np

from labial.reference.contact import REST

#: Milliseconds of a phoneme that the shapes tell apart at most.
MILLISECONDS_MAX = 65535


@dataclass(frozen=True)
class Segment:
    """A phoneme as the steps behind see it: its number, milliseconds (capped) and frames; which part it is of a pause
    that was cut, 0 for the head, and frames of that pause before it."""

    phoneme: int
    milliseconds: int
    frames: int
    part: Optional[int] = None
    before: int = 0


def frame_counts(milliseconds: Sequence[int], fps: int) -> List[int]:
    """Frames of each phoneme; what one leaves over goes to the next, so that they amount to the rounded sum."""
    counts = []
    remainder = 500
    for duration in milliseconds:
        thousandths = int(duration) * fps + remainder
        counts.append(thousandths // 1000)
        remainder = thousandths % 1000
    return counts


def pause_cut(frames: int, milliseconds: int, ahead: int, fps: int) -> List[Tuple[int, int]]:
    """Frames and milliseconds of the parts of a pause: a head and a tail of `ahead` frames, where it has more. The
    kernels reach `ahead` frames into what follows, so that nothing in the head needs to know what ends the pause."""
    if not 0 < ahead < frames:
        return [(frames, milliseconds)]
    tail = ahead * 1000 // fps
    return [(frames - ahead, milliseconds - tail), (ahead, tail)]


def segments(phonemes: Sequence[Tuple[int, int]], silence: int, ahead: int, fps: int,
             counts: Optional[Sequence[int]] = None) -> List[Segment]:
    """The phonemes, pairs of number and milliseconds, that have frames; pauses are cut by :func:`pause_cut`. `counts`
    are their frames where they follow others, which leave something over."""
    result = []
    counts = frame_counts([ms for _, ms in phonemes], fps) if counts is None else counts
    for (phoneme, milliseconds), frames in zip(phonemes, counts):
        capped = min(milliseconds, MILLISECONDS_MAX)
        parts = pause_cut(frames, capped, ahead, fps) if phoneme == silence else [(frames, capped)]
        if len(parts) > 1:
            (head, head_ms), (tail, tail_ms) = parts
            result += [Segment(phoneme, head_ms, head, 0), Segment(phoneme, tail_ms, tail, 1, head)]
        elif frames:
            result.append(Segment(phoneme, capped, frames))
    return result


def rest(held: Sequence[Segment]) -> np.ndarray:
    """(T,) int64: how far the mouth has come to rest in each frame, of REST: in the head of a pause, and in its tail
    too where nothing follows."""
    frames = [np.zeros(0, dtype=np.int64)]
    for i, item in enumerate(held):
        resting = item.part == 0 or (item.part == 1 and i + 1 == len(held))
        first = i == (item.part or 0)  # the pause that the stream begins with: at rest at once
        count = np.full(item.frames, REST) if first else np.minimum(item.before + np.arange(1, item.frames + 1), REST)
        frames.append(count if resting else np.zeros(item.frames, dtype=np.int64))
    return np.concatenate(frames)


def unit_ends(held: Sequence[Segment], boundary: np.ndarray) -> np.ndarray:
    """(T,) bool: the frames that end a unit, the last ones of boundary phonemes, (P,) `boundary`, and of the stream."""
    ends = np.zeros(sum(item.frames for item in held), dtype=bool)
    ends[-1:] = True
    last = -1
    for item in held:
        last += item.frames
        ends[last] |= bool(boundary[item.phoneme])
    return ends
