"""The whole reference: phonemes and durations in, motion out (``lib/stream.c``). How a stream's frames begin and end at
rest is in :mod:`labial.reference.fade`; what is measured and trained on is motion that is under way."""

from __future__ import annotations

from typing import Iterator, Optional, Sequence, Tuple, Union

import numpy as np

from labial.core.library import ARTICULATION_MAX, DURATION_MAX
from labial.errors import LabialError
from labial.files.faps import CHANNELS
from labial.reference import trajectory
from labial.reference.contact import FRAMES, raised
from labial.reference.shape import knot_shares, neighbours, tapped
from labial.reference.tables import Tables
from labial.reference.trajectory import WINDOW
from labial.reference.units import MILLISECONDS_MAX, frame_counts, rest, segments, unit_ends
from labial.reference.viterbi import LAG, Decode
from labial.tables.fixed import SEARCHED

#: Frames that are computed at once, some 10 KB each.
PART = 3000
#: Percent by which the articulation changes from frame to frame, at most.
SLEW = 10


def check(tables: Tables, phonemes: Sequence[Tuple[int, int]]) -> None:
    """Raises LabialError for phonemes that the model does not have and durations out of range."""
    for number, milliseconds in phonemes:
        if not 0 <= number < len(tables.phonemes):
            raise LabialError(f"phoneme {number}: the model has {len(tables.phonemes)}")
        if not 0 <= milliseconds <= DURATION_MAX:
            raise LabialError(f"phoneme {tables.phonemes[number]}: {milliseconds} ms is not within 0 .. {DURATION_MAX}")


def synthesise(tables: Tables, phonemes: Sequence[Tuple[int, int]], *, articulation: Union[int, Sequence[int]] = 100,
               whole: bool = False, window: int = WINDOW, lag: int = LAG, searched: int = SEARCHED) -> np.ndarray:
    """(T, 13) float64, FAP units: the motion of `phonemes`, pairs of phoneme number and milliseconds. `articulation` is
    what the stream is told, in percent, throughout or when each of T frames is taken in. `window` is how many frames
    beyond those delivered the solution knows, or with `whole` all of them; `lag` how many frames later the search
    decides; `searched` how many states its steps look at."""
    target, contact, ends = aims(tables, phonemes)
    gain = gains(np.broadcast_to(articulation, len(target)), tables.stride, lag, len(tables.solved))
    return solution(tables, target, contact, ends, gain, whole=whole, window=window, lag=lag, searched=searched)


def gains(articulation: np.ndarray, stride: int, lag: int = LAG, channels: int = CHANNELS) -> np.ndarray:
    """(T, C) by how much the channels of a stream's frames are articulated, 1 for 100 percent, when the stream is told
    `articulation` (T,), percent, with each of T frames that it takes in. From the first frame's on it follows by SLEW a
    frame, and is taken in 256ths. A channel solves its frames in its turn, all with the articulation of the latest
    frame of the stream."""
    wanted = np.clip(articulation, 0, ARTICULATION_MAX).astype(np.int64)
    reached = wanted.copy()
    for t in range(1, len(wanted)):
        reached[t] = reached[t - 1] + np.clip(wanted[t] - reached[t - 1], -SLEW, SLEW)
    known = np.arange(len(wanted))[:, None] + lag
    turn = known + (np.arange(channels) - known) % stride
    return (np.floor(reached * 2.56 + 0.5) / 256.0)[np.minimum(turn, len(wanted) - 1)]


def in_parts(tables: Tables, phonemes: Sequence[Tuple[int, int]], part: int = PART,
             articulation: int = 100) -> Iterator[np.ndarray]:
    """The motion of :func:`synthesise`, bit for bit, some `part` frames (n, 13) at a time: memory does not grow with
    the stream."""
    channels = len(tables.solved)
    gain = gains(np.array([articulation]), 1, channels=channels)
    search, solve = Decode(tables.chains, tables.stride), trajectory.Solve(tables.stride)
    waiting = [np.zeros((0, channels), dtype=dtype) for dtype in (tables.dtype, bool)]  # targets and where in contact
    for target, contact, ends, last in aims_in_parts(tables, phonemes, part):
        path = search.take(target, ends, last)
        known = [np.concatenate(pair) for pair in zip(waiting, (target, contact))]
        waiting = [values[len(path) :] for values in known]
        if len(path):
            target, contact = (values[: len(path)] for values in known)
            terms = trajectory.articulated(tables.equation(path, target, contact), contact, gain)
            yield tables.complete(solve.take(terms, last))


def aims_in_parts(tables: Tables, phonemes: Sequence[Tuple[int, int]],
                  part: int) -> Iterator[Tuple[np.ndarray, np.ndarray, np.ndarray, bool]]:
    """The result of :func:`aims`, some `part` frames at a time, and whether these are the last. A part is made of some
    phonemes and of those around them that its targets depend on."""
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
        for moment in range(origin, origin + frames, part):  # also of a pause, which may last an hour
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


def targets(tables: Tables, phonemes: Sequence[int], milliseconds: Sequence[int], frames: Sequence[int]) -> np.ndarray:
    """(T, 13) the moving target of an utterance, in the tables' positions; phonemes without frames have no effect,
    silence is before and after."""
    return targets_and_contact(tables, phonemes, milliseconds, frames)[0]


def targets_and_contact(tables: Tables, phonemes: Sequence[int], milliseconds: Sequence[int], frames: Sequence[int],
                        rest: Optional[np.ndarray] = None,
                        here: Optional[slice] = None) -> Tuple[np.ndarray, np.ndarray]:
    """The targets (T, 13) of :func:`targets`, and where they are in contact, (T, 13) bool; `rest` (T,) is how far the
    mouth has come to rest in pauses. Of all T frames, or of those `here` alone."""
    length = np.asarray(frames, dtype=np.int64)
    has_frames = length > 0
    phoneme, length = np.asarray(phonemes, dtype=np.int64)[has_frames], length[has_frames]
    duration = np.minimum(np.asarray(milliseconds, dtype=np.int64)[has_frames], MILLISECONDS_MAX)
    selected = tables.select(phoneme, duration, *neighbours(phoneme, tables.silence))
    index = np.repeat(np.arange(len(phoneme)), length)
    labels = phoneme[index]
    here = slice(0, len(labels)) if here is None else here
    shape_at = tables.interpolated(selected[index[here]], knot_shares(length, tables.knots)[here])
    moving = tables.targets(shape_at, tapped(labels, tables.lags, tables.silence, here))
    rest = np.zeros(len(labels), dtype=np.int64) if rest is None else rest
    return raised(moving, labels, length, rest, tables.silence, tables.floor, tables.contact, here.start, tables.parted)


def aims(tables: Tables, phonemes: Sequence[Tuple[int, int]],
         counts: Optional[Sequence[int]] = None) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Targets (T, C) in the tables' positions, where they are in contact (T, C), and the frames (T,) that end units,
    of pairs of phoneme number and milliseconds; `counts` as in :func:`labial.reference.units.segments`."""
    check(tables, phonemes)
    held = segments(phonemes, tables.silence, tables.ahead, tables.fps, counts)
    target, contact = targets_and_contact(tables, [item.phoneme for item in held],
                                          [item.milliseconds for item in held], [item.frames for item in held],
                                          rest(held))
    return target, contact, unit_ends(held, tables.boundary)


def solution(tables: Tables, target: np.ndarray, contact: np.ndarray, ends: np.ndarray,
             gain: Optional[np.ndarray] = None, *, whole: bool = False, window: int = WINDOW, lag: int = LAG,
             begin: int = 0, searched: int = SEARCHED) -> np.ndarray:
    """(T, 13) float64, FAP units: the motion for targets (T, C) in the tables' positions, some of them in `contact` (T,
    C); `ends` (T,) are the frames that end a unit, the last one among them; `gain` (T, C) is their articulation, 1
    without it. The first is frame `begin` of a stream, whose channels have their turns counted from its own first."""
    if not len(target):
        return np.zeros((0, CHANNELS))
    terms = tables.equation(tables.search(target, ends, lag, begin, searched), target, contact)
    if gain is not None:
        terms = trajectory.articulated(terms, contact, gain)
    if whole:
        return tables.complete(trajectory.solve_whole(terms))
    start = trajectory.starts(len(target), tables.stride, window, lag, begin, len(tables.solved))
    return tables.complete(trajectory.solve(terms, start))
