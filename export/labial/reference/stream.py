"""The whole reference: phonemes and durations in, frames out (``lib/stream.c``)."""

from __future__ import annotations

from typing import Iterator, Optional, Sequence, Tuple

import numpy as np

from labial.errors import LabialError
from labial.faps import CHANNELS
from labial.fixed import SEARCHED
from labial.reference import trajectory
from labial.reference.contact import FRAMES
from labial.reference.shape import targets_and_contact
from labial.reference.tables import Tables
from labial.reference.trajectory import WINDOW
from labial.reference.units import frame_counts, rest, segments, unit_ends
from labial.reference.viterbi import LAG, Decode
from labial.runtime.library import DURATION_MAX

#: Frames that are worked on at once, some 10 KB each.
PART = 3000


def check(tables: Tables, phonemes: Sequence[Tuple[int, int]]) -> None:
    """Raises LabialError for phonemes that the model does not have and durations that no phoneme has."""
    for number, milliseconds in phonemes:
        if not 0 <= number < len(tables.phonemes):
            raise LabialError(f"phoneme {number}: the model has {len(tables.phonemes)}")
        if not 0 <= milliseconds <= DURATION_MAX:
            raise LabialError(f"phoneme {tables.phonemes[number]}: {milliseconds} ms is not within 0 .. {DURATION_MAX}")


def synthesise(
    tables: Tables,
    phonemes: Sequence[Tuple[int, int]],
    *,
    whole: bool = False,
    window: int = WINDOW,
    lag: int = LAG,
    searched: int = SEARCHED,
) -> np.ndarray:
    """(T, 13) float64, FAP units: the motion of `phonemes`, pairs of phoneme number and milliseconds.

    `window` is how many frames beyond those delivered the solution knows, or with `whole` all of them; `lag` how many
    frames later the search decides; `searched` how many states its steps look at.
    """
    target, contact, ends = aims(tables, phonemes)
    return solution(tables, target, contact, ends, whole=whole, window=window, lag=lag, searched=searched)


def in_parts(tables: Tables, phonemes: Sequence[Tuple[int, int]], part: int = PART) -> Iterator[np.ndarray]:
    """The motion of :func:`synthesise`, to the last bit, some `part` frames (n, 13) at a time: memory does not grow
    with the stream."""
    search, solve = Decode(tables.chains, tables.stride), trajectory.Solve(tables.stride)
    waiting = [np.zeros((0, CHANNELS), dtype=dtype) for dtype in (tables.dtype, bool)]  # targets and where in contact
    for target, contact, ends, last in aims_in_parts(tables, phonemes, part):
        path = search.take(target, ends, last)
        known = [np.concatenate(pair) for pair in zip(waiting, (target, contact))]
        waiting = [values[len(path) :] for values in known]
        if len(path):
            target, contact = (values[: len(path)] for values in known)
            yield solve.take(tables.equation(path, target, contact), last)


def aims_in_parts(
    tables: Tables, phonemes: Sequence[Tuple[int, int]], part: int
) -> Iterator[Tuple[np.ndarray, np.ndarray, np.ndarray, bool]]:
    """What :func:`aims` returns, some `part` frames at a time, and whether these are the last.

    A part is made of some phonemes and of those around them that its targets depend on.
    """
    check(tables, phonemes)
    counts = frame_counts([milliseconds for _, milliseconds in phonemes], tables.fps)
    reach = max([FRAMES, *np.abs(tables.lags).tolist()])
    left, begin = sum(counts), 0
    while left:
        end, frames = _until(counts, begin, part)
        first = origin = 0
        for first in range(begin, -1, -1):
            if (origin := sum(counts[first:begin])) >= reach:
                break
        around = slice(first, _until(counts, end, reach)[0])
        held = segments(phonemes[around], tables.silence, tables.ahead, tables.fps, counts[around])
        given = [item.phoneme for item in held], [item.milliseconds for item in held], [item.frames for item in held]
        resting, ends = rest(held), unit_ends(held, tables.boundary)
        for moment in range(origin, origin + frames, part):  # of a pause as well, which may last an hour
            here = slice(moment, min(moment + part, origin + frames))
            left -= here.stop - here.start
            yield (*targets_and_contact(tables, *given, resting, here), ends[here], not left)
        begin = end


def _until(counts: Sequence[int], begin: int, least: int) -> Tuple[int, int]:
    """Behind which phoneme those from `begin` on have `least` frames, or the last one; and how many they have."""
    end, frames = begin, 0
    while end < len(counts) and frames < least:
        frames += counts[end]
        end += 1
    return end, frames


def aims(
    tables: Tables, phonemes: Sequence[Tuple[int, int]], counts: Optional[Sequence[int]] = None
) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Targets (T, 13) in the tables' positions, where they are in contact (T, 13), and the frames (T,) that end units,
    of pairs of phoneme number and milliseconds; `counts` as in :func:`labial.reference.units.segments`."""
    check(tables, phonemes)
    held = segments(phonemes, tables.silence, tables.ahead, tables.fps, counts)
    target, contact = targets_and_contact(tables, [item.phoneme for item in held],
                                          [item.milliseconds for item in held], [item.frames for item in held],
                                          rest(held))
    return target, contact, unit_ends(held, tables.boundary)


def solution(
    tables: Tables,
    target: np.ndarray,
    contact: np.ndarray,
    ends: np.ndarray,
    *,
    whole: bool = False,
    window: int = WINDOW,
    lag: int = LAG,
    begin: int = 0,
    searched: int = SEARCHED,
) -> np.ndarray:
    """(T, 13) float64, FAP units: the motion for targets (T, 13) in the tables' positions, some of them in `contact`
    (T, 13); `ends` (T,) are the frames that end a unit, the last one among them. The first is frame `begin` of a
    stream, whose channels have their turns counted from its own first."""
    if not len(target):
        return np.zeros((0, CHANNELS))
    terms = tables.equation(tables.search(target, ends, lag, begin, searched), target, contact)
    if whole:
        return trajectory.solve_whole(terms)
    return trajectory.solve(terms, trajectory.starts(len(target), tables.stride, window, lag, begin))
