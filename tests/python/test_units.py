"""Phonemes to frames, pauses and the ends of units, worked by hand, and their invariants over many streams."""

from __future__ import annotations

import numpy as np
import pytest

from labial.reference.stream import aims, synthesise
from labial.reference.tables import ExportedTables, FloatTables
from labial.reference.units import Segment, frame_counts, segments, unit_ends
from labial.tables.quantise import quantise
from models import random_model, streams

SIL, VOWEL, REST = 0, 1, 2
BOUNDARY = np.array([False, True, False])


@pytest.mark.parametrize("fps", [25, 50, 60, 100])
def test_frames_amount_to_the_rounded_sum(fps: int) -> None:
    """Rounding each duration by itself would drift: 300 phonemes of 1 ms are 15 frames at 50 per second, not none."""
    rng = np.random.default_rng(fps)
    for durations in ([1] * 300, [0, 0, 3], [3_600_000, 1], list(rng.integers(0, 400, 500))):
        total = sum(int(d) for d in durations) * fps
        assert sum(frame_counts(durations, fps)) == (total + 500) // 1000


def test_a_pause_is_cut_where_the_kernels_begin_to_see_what_ends_it() -> None:
    """500 ms are 25 frames; the last six, 120 ms, may depend on the vowel behind, the others must not wait for it."""
    found = segments([(VOWEL, 100), (SIL, 500), (VOWEL, 60)], SIL, 6, 50)
    parts = [Segment(SIL, 380, 19, 0), Segment(SIL, 120, 6, 1, 19)]
    assert found == [Segment(VOWEL, 100, 5), *parts, Segment(VOWEL, 60, 3)]


def test_what_is_not_cut() -> None:
    """A pause that the kernels span, phonemes that are no pause, and everything where nothing looks ahead."""
    stream = [(SIL, 125), (VOWEL, 500), (SIL, 140)]
    assert [item.frames for item in segments(stream, SIL, 6, 50)] == [6, 25, 1, 6]
    assert [item.milliseconds for item in segments(stream, SIL, 6, 50)] == [125, 500, 20, 120]
    assert [item.frames for item in segments(stream, SIL, 0, 50)] == [6, 25, 7]


def test_the_parts_of_a_pause_that_no_millisecond_fits() -> None:
    """At 60 frames a second five frames are 83.3 ms: the tail has 83, the head the rest, frames are what they were."""
    assert segments([(SIL, 200)], SIL, 5, 60) == [Segment(SIL, 117, 7, 0), Segment(SIL, 83, 5, 1, 7)]


def test_milliseconds_are_capped_before_the_cut() -> None:
    """The device keeps them in 16 bits; a head of 65,535 ms less its tail is what it sees of an hour."""
    assert segments([(SIL, 3_600_000)], SIL, 6, 50) == [Segment(SIL, 65415, 179994, 0), Segment(SIL, 120, 6, 1, 179994)]
    assert segments([(VOWEL, 70_000)], SIL, 6, 50) == [Segment(VOWEL, 65535, 3500)]


def test_phonemes_without_frames_leave_no_trace_but_their_time() -> None:
    """9 ms are no frame, but with 11 more they are one."""
    assert segments([(VOWEL, 9), (REST, 11), (VOWEL, 0)], SIL, 6, 50) == [Segment(REST, 11, 1)]
    assert segments([(VOWEL, 0)], SIL, 6, 50) == []


def test_a_unit_ends_with_its_boundary_phoneme_and_with_the_stream() -> None:
    """The boundary phoneme's last frame, not its first, and no frame of what follows."""
    held = [Segment(REST, 40, 2), Segment(VOWEL, 60, 3), Segment(SIL, 20, 1), Segment(SIL, 20, 1), Segment(REST, 40, 2)]
    assert np.flatnonzero(unit_ends(held, BOUNDARY)).tolist() == [4, 8]
    assert unit_ends([], BOUNDARY).shape == (0,)


@pytest.mark.parametrize("seed", [0, 1, *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(2, 6))])
def test_every_frame_of_every_stream_has_a_target_and_a_unit(seed: int) -> None:
    """Whatever is pushed: as many frames as its time, no more and no fewer, and a unit's end at the last one."""
    model = random_model(seed)
    for tables in (FloatTables(model), ExportedTables(quantise(model, "model"))):
        for stream in streams(len(model.phonemes), model.boundary, seed).values():
            total = (50 * sum(ms for _, ms in stream) + 500) // 1000
            target, contact, ends = aims(tables, stream)
            assert target.shape == contact.shape == (total, 13) and ends.shape == (total,)
            assert not total or ends[-1]


@pytest.mark.parametrize("seed", range(3))
def test_the_head_of_a_pause_does_not_depend_on_what_ends_it(seed: int) -> None:
    """What the cut is for: all but the last frames of a pause are the same whichever phonemes follow."""
    model = random_model(seed)
    tables = ExportedTables(quantise(model, "model"))
    assert tables.ahead == 6
    one, other = ([(3, 100), (0, 1000), (p, 200), (5, 90)] for p in (4, 7))
    first, second = aims(tables, one)[0], aims(tables, other)[0]
    assert (first[: 5 + 44] == second[: 5 + 44]).all() and (first[5 + 44 :] != second[5 + 44 :]).any()


def test_nothing_in_is_nothing_out() -> None:
    """A stream may end before it began."""
    tables = FloatTables(random_model(1))
    for stream in ([], [(1, 0)], [(1, 9)]):
        assert synthesise(tables, stream).shape == (0, 13)
