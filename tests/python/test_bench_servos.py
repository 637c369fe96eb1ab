"""What bench/closures.py and bench/heads.py count, in cases by hand."""

from __future__ import annotations

import closures
import numpy as np
import pytest

import heads
from labial.fit.sentences import Motion
from packages import SOURCE
from runtime import needs_runtime

TESTS = SOURCE / "tests" / "python"


def test_shares_of_closures() -> None:
    """Two p, b, m: one that a slow jaw reaches only if it looks ahead, and one after a rest."""
    frames = np.zeros((60, 13), dtype=np.int64)
    frames[5:30, 4] = frames[40:55, 4] = -480  # 400 us open
    said = [closures.Said(frames, [(31, 33), (56, 58)])]
    assert closures.measure(said, closures.jaw(None, None), 1) == (1.0, 1.0)
    assert closures.measure(said, closures.jaw(50, None), 1)[0] == 0.0
    assert closures.measure(said, closures.jaw(50, None), 2)[0] == 0.0
    for limits in ((50, None), (60, 20)):
        assert closures.measure(said, closures.jaw(*limits), 32)[0] == 1.0


@needs_runtime
def test_timings_become_motion() -> None:
    """A closure is where its phoneme is, a frame wider; blanks are silence, and stress marks are no other sound."""
    said = closures.moving([("", 100.0), ("m", 80.0), ("ˈɑː", 200.0), ("b", 60.0), ("", 200.0)])
    assert said.closures == [(4, 11), (18, 24)] and len(said.frames) == 32
    assert all((said.frames[begin:end, 3] + said.frames[begin:end, 4]).max() > -72 for begin, end in said.closures)


def test_motions_are_joined() -> None:
    """Phonemes keep their frames."""
    frames = np.arange(26.0).reshape(2, 13)
    joined = heads.joined([Motion(frames, [("m", 0, 1)]), Motion(frames + 1, [("aa", 1, 2)])])
    assert joined.phonemes == [("m", 0, 1), ("aa", 3, 4)] and joined.frames[3, 0] == frames[1, 0] + 1


@needs_runtime
def test_rows_of_a_head() -> None:
    """ICT's head with the built-in rig, to what docs/avatar.md says."""
    from labial.fit.head import read_table
    from labial.fit.sentences import read_sentences

    head, motion = read_table(TESTS / "heads" / "ict_lips.csv"), read_sentences(TESTS / "sentences.flite")
    assert heads.built_in(head, "oculus", motion) == {}
    cells = heads.row("ict", head, heads.built_in(head, "arkit", motion), motion).split(" | ")
    assert float(cells[1]) == pytest.approx(0.89, abs=0.02) and float(cells[6]) == 1.0 and float(cells[9]) < 0.85
