"""The timeline of a voice in milliseconds, by cases worked out by hand."""

from __future__ import annotations

from typing import List, Tuple

import pytest

from labial.runtime import timeline
from labial.runtime.timeline import Item


@pytest.mark.parametrize(("items", "previous", "expected"), [
    ([Item(101, 200, "a")], 100, [(100, 200)]), ([Item(99, 200, "a")], 100, [(100, 200)]),
    ([Item(102, 200, "a")], 100, [(102, 200)]), ([Item(98, 200, "a")], 100, [(98, 200)]),
    ([Item(0, 100, "a", 50), Item(150, 200, "b")], 0, [(0, 150), (150, 200)]),
    ([Item(0, 100, "a", 50), Item(151, 200, "b")], 0, [(0, 100), (151, 200)]),
    ([Item(0, 120, "a"), Item(100, 200, "b")], 0, [(0, 100), (100, 200)]),
    ([Item(0, 101, "a"), Item(100, 200, "b")], 0, [(0, 101), (101, 200)]),
    ([Item(0, 102, "a"), Item(100, 200, "b")], 0, [(0, 100), (100, 200)]),
    ([Item(100, 100, "a")], 101, [(101, 101)]), ([Item(0, None, "a"), Item(80, 90, "b")], 0, [(0, 0), (80, 90)]),
], ids=["late", "early", "later", "earlier", "gap", "pause", "overlap", "rounded", "cut", "empty", "open"])  # fmt: skip
def test_phonemes_join(items: List[Item], previous: int, expected: List[Tuple[int, int]]) -> None:
    """Times that rounding moves by a millisecond touch, gaps up to a phoneme's own belong to it, overlaps to the later
    one, and nothing ends before it begins."""
    found = timeline._sounds(items, previous)
    assert [(start, end) for start, end, _ in found] == expected
    assert [what for *_, what in found] == [item.what for item in items]


def test_items_take_the_place_of_those_in_their_time() -> None:
    """Also those that are as short as their beginning, whose end nobody knows yet."""
    known = [Item(0, 9, "x"), Item(15, 18, "y"), Item(16, 20, "z")]
    assert timeline._put(known, [Item(10, 12, "a"), Item(15, None, "b")]) == 1
    assert [item.what for item in known] == ["x", "a", "b", "z"]
    assert timeline._put(known, []) == 4


@pytest.mark.parametrize(("limit", "left"), [(10, "abc"), (50, "abc"), (51, "bc"), (91, "c"), (1000, "c")])
def test_what_still_matters_is_not_forgotten(limit: int, left: str) -> None:
    """An item matters until the next one begins, which may fill the gap between them, and the last one always."""
    utterance = timeline._Utterance(0)
    utterance.items["phonemes"] = [Item(0, 10, "a"), Item(50, 60, "b"), Item(90, None, "c")]
    utterance.forget(limit)
    assert "".join(str(item.what) for item in utterance.items["phonemes"]) == left
