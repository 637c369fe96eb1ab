"""Stretches in which something holds: where they are, and how they are told."""

from __future__ import annotations

from itertools import groupby

import numpy as np

from labial.files.frames import spans, spans_told


def test_spans_are_the_stretches() -> None:
    """Would catch a stretch at either end that is lost, and one that is a frame too long: against itertools."""
    rng = np.random.default_rng(1)
    for _ in range(300):
        holds = rng.random(rng.integers(0, 12)) < rng.random()
        expected = [list(group) for held, group in groupby(range(len(holds)), key=lambda t: bool(holds[t])) if held]
        assert spans(holds) == [(group[0], group[-1] + 1) for group in expected]


def test_spans_are_told_by_the_times_of_their_frames() -> None:
    """Would catch a stretch that is told until the frame after it, and stretches that are left out without a word."""
    times = np.arange(8) / 10
    holds = np.array([1, 1, 0, 1, 0, 0, 1, 1], dtype=bool)
    assert spans_told(times, holds, 3) == "0.00 to 0.10, 0.30 to 0.30, 0.60 to 0.70 s"
    assert spans_told(times, holds, 1) == "0.00 to 0.10 s and 2 times more"
