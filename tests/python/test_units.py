"""Segmentation into units, worked by hand, and its invariants over many streams."""

from __future__ import annotations

import numpy as np
import pytest

from labial.reference.stream import frame_counts
from labial.reference.units import OVERLAP, PIECE, Piece, pieces, whole
from models import random_model, streams


def test_units_run_from_boundary_to_boundary_inclusive() -> None:
    """V-C-V: each vowel belongs to the unit that it ends and to the one that it begins."""
    assert pieces([4, 9, 5, 2, 6], [True, False, True, False, True]) == [Piece(0, 18, 0, 5), Piece(13, 26, 5, 0)]


def test_short_units_are_decoded_together() -> None:
    """A piece ends with the first unit that gives it PIECE frames; every unit by itself would join twice as often."""
    assert PIECE == 16
    found = pieces([4, 3, 4, 3, 4, 3, 5, 20], [True, False] * 4)
    assert found == [Piece(0, 18, 0, 4), Piece(14, 46, 4, 0)]


def test_a_piece_ends_with_the_last_unit_that_fits() -> None:
    """Eleven frames are few, but with the next unit it would be more than the window, and that one would be cut."""
    found = pieces([4, 3, 4, 35, 5], [True, False, True, False, True])
    assert found[0] == Piece(0, 11, 0, 4) and found[1].begin == 7


def test_all_that_is_left_is_one_piece() -> None:
    """The end of the stream ends the piece, not a short unit before it."""
    assert pieces([4, 3, 4, 3, 2], [True, False, True, False, False]) == [Piece(0, 16, 0, 0)]


def test_consonant_clusters_stay_in_one_unit() -> None:
    """V-CC-V is one unit; cutting at every consonant would give three."""
    assert pieces([4, 3, 3, 5], [True, False, False, True]) == [Piece(0, 15, 0, 0)]


def test_first_and_last_phoneme_are_boundaries() -> None:
    """A stream of consonants is one unit, whatever it begins and ends with."""
    assert pieces([4, 3, 3], [False, False, False]) == [Piece(0, 10, 0, 0)]


def test_a_long_pause_is_cut_into_chained_pieces() -> None:
    """Nothing is dropped: the pieces cover the pause and share OVERLAP frames."""
    found = pieces([100], [False])
    assert found == [Piece(0, 40, 0, 8), Piece(32, 72, 8, 8), Piece(64, 100, 8, 0)]


def test_a_long_boundary_phoneme_is_shared_in_its_last_frames_only() -> None:
    """Sharing all of it would leave frames that belong to three pieces."""
    assert pieces([2, 30, 4, 5], [False, True, False, True])[0] == Piece(0, 32, 0, OVERLAP)


def test_phonemes_without_frames_leave_no_trace() -> None:
    """A unit boundary of no length would be an empty piece."""
    assert pieces([4, 0, 3, 0], [False, True, False, True]) == [Piece(0, 7, 0, 0)]
    assert pieces([0, 0], [True, True]) == [] and whole([0]) == []


@pytest.mark.parametrize("seed", range(8))
def test_pieces_cover_every_frame_once_or_twice(seed: int) -> None:
    """For any stream: no gap, no frame in three pieces, no piece beyond the window, shared frames agree."""
    model = random_model(seed)
    for stream in streams(len(model.phonemes), model.boundary, seed).values():
        counts = frame_counts([ms for _, ms in stream], 50)
        cut = pieces(counts, [bool(model.boundary[p]) for p, _ in stream])
        cover = np.zeros(sum(counts), dtype=int)
        for before, after in zip([None, *cut], cut):
            cover[after.begin : after.end] += 1
            assert 0 < after.end - after.begin <= 40
            assert after.fade_in + after.fade_out <= after.end - after.begin
            assert after.fade_in == (before.end - after.begin if before else 0)
            assert after.fade_in == (before.fade_out if before else 0) <= OVERLAP
        assert cover.size == 0 or (cover.min() >= 1 and cover.max() <= 2)


@pytest.mark.parametrize("fps", [25, 50, 60, 100])
def test_frames_amount_to_the_rounded_sum(fps: int) -> None:
    """Rounding each duration by itself would drift: 300 phonemes of 1 ms are 15 frames at 50 per second, not none."""
    rng = np.random.default_rng(fps)
    for durations in ([1] * 300, [0, 0, 3], [3_600_000, 1], list(rng.integers(0, 400, 500))):
        total = sum(int(d) for d in durations) * fps
        assert sum(frame_counts(durations, fps)) == (total + 500) // 1000
