"""Contacts: where they are, how long, and what they do to the targets and to equation 3, worked by hand."""

from __future__ import annotations

from typing import List, Tuple

import numpy as np
import pytest

from labial.reference.contact import raised
from labial.reference.stream import aims
from labial.reference.tables import ExportedTables, FloatTables
from labial.reference.units import rest, segments
from labial.tables.quantise import quantise
from models import random_model, streams

SIL, OPEN, LIPS = 0, 1, 2
FLOOR = np.array([[-np.inf, -np.inf], [-50.0, -np.inf], [40.0, 10.0]])  # lips meet in the first of two channels
CONTACT = np.array([[False, False], [False, False], [True, False]])


def shut(*spans: Tuple[int, int]) -> Tuple[List[int], List[int], List[bool]]:
    """The two channels' targets, 0 without floors, and where the first is in contact, of phonemes and their frames."""
    labels = np.repeat([phoneme for phoneme, _ in spans], [frames for _, frames in spans])
    length = np.array([frames for _, frames in spans])
    target, contact = raised(np.zeros((len(labels), 2)), labels, length, 0 * labels, SIL, FLOOR, CONTACT,
                             parted=np.array([55, 0]))
    assert not contact[:, 1].any()
    return target[:, 0].tolist(), target[:, 1].tolist(), contact[:, 0].tolist()


def test_contact_lasts_three_frames_at_least() -> None:
    """Three frames are a phoneme's own; two borrow the one before; one borrows that behind it too."""
    assert shut((OPEN, 3), (LIPS, 3), (OPEN, 2))[2] == [False] * 3 + [True] * 3 + [False] * 2
    assert shut((OPEN, 3), (LIPS, 2), (OPEN, 3))[2] == [False] * 2 + [True] * 3 + [False] * 3
    assert shut((OPEN, 3), (LIPS, 1), (OPEN, 3))[2] == [False] * 2 + [True] * 3 + [False] * 2
    assert shut((LIPS, 1), (OPEN, 2))[2] == [True, True, False]  # nothing lies before the first frame
    assert shut((OPEN, 2), (LIPS, 1))[2] == [False, True, True]


def test_floors_hold_where_contact_is() -> None:
    """Borrowed frames take the floor of the phoneme that borrows them; other floors stay with their own phoneme."""
    first, second, _ = shut((OPEN, 3), (LIPS, 1), (OPEN, 2))
    assert first == [0.0, 0.0, 40.0, 40.0, 40.0, 0.0]
    assert second[3] == 10.0 and second[0] == 0.0
    deep = raised(np.full((2, 2), -80.0), np.array([OPEN, OPEN]), np.array([2]), np.zeros(2, dtype=int), SIL, FLOOR,
                  CONTACT, parted=np.zeros(2))[0]
    assert deep.tolist() == [[-50.0, -80.0]] * 2


def test_a_long_closure_holds_its_last_frames_alone() -> None:
    """Fifteen frames have swallowed a pause: the lips meet for the last eight. Fourteen are held throughout."""
    first, second, contact = shut((LIPS, 15))
    assert contact == [False] * 7 + [True] * 8 and first == [0.0] * 7 + [40.0] * 8
    assert second == [10.0] * 15  # what is no contact stays
    assert shut((LIPS, 14))[2] == [False] * 3 + [True] * 7 + [False] * 4  # of fourteen the middle half


def test_a_longer_closure_holds_its_middle() -> None:
    """Half of the frames, but three; an odd one is left at the end."""
    first, second, contact = shut((LIPS, 4))
    assert contact == [True] * 3 + [False] and first == [40.0] * 3 + [0.0] and second == [10.0] * 4
    assert shut((LIPS, 5))[2] == [False] + [True] * 3 + [False]
    assert shut((LIPS, 7))[2] == [False] + [True] * 4 + [False] * 2


def test_lips_part_between_two_close_contacts() -> None:
    """Up to three frames between contacts are 55 below the floor, but for those that a contact borrows."""
    assert shut((LIPS, 3), (OPEN, 2), (LIPS, 3))[::2] == (
        [40.0] * 3 + [-15.0] * 2 + [40.0] * 3, [True] * 3 + [False] * 2 + [True] * 3)
    assert shut((LIPS, 3), (OPEN, 4), (LIPS, 3))[2] == [True] * 3 + [False] * 4 + [True] * 3
    assert shut((LIPS, 3), (OPEN, 1), (SIL, 1), (LIPS, 3))[0] == [40.0] * 3 + [0.0] * 2 + [40.0] * 3
    assert shut((LIPS, 3), (OPEN, 2), (LIPS, 2))[0] == [40.0] * 3 + [-15.0] + [40.0] * 3
    assert shut((LIPS, 3), (OPEN, 1), (LIPS, 2))[0] == [40.0] * 6


def test_a_mouth_comes_to_rest_in_pauses() -> None:
    """In the head of a pause that was cut, from the first frame on by a sixteenth more, where silence says so; in its
    tail too where nothing follows, but not where it leads on, nor in a pause that was not cut, whatever stands beside
    it. It is no contact, which would be held."""
    def shares(*pushed: Tuple[int, int]) -> List[int]:
        return rest(segments(pushed, SIL, 6, 50)).tolist()

    assert shares((OPEN, 20), (SIL, 520), (OPEN, 20)) == [0, *range(1, 17), 16, 16, 16, 16, *[0] * 6, 0]
    assert shares((OPEN, 20), (SIL, 200)) == [0, *range(1, 11)]
    assert shares((SIL, 100), (SIL, 120), (OPEN, 20)) == [0] * 12
    assert shares((SIL, 200), (OPEN, 20)) == [*[16] * 4, *[0] * 7]  # nothing leads to where it rests
    assert shares((SIL, 120)) == [0] * 6
    floor = np.array([[-160.0, 32.0], [-np.inf, -np.inf]])
    resting = np.array([[True, False], [False, False]])
    labels, length, step = np.array([OPEN] + [SIL] * 20), np.array([1, 20]), np.minimum(np.arange(21), 16)
    target, contact = raised(np.full((21, 2), 64.0), labels, length, step, SIL, floor, resting, parted=np.zeros(2))
    assert not contact.any() and (target[:, 1] == 64.0).all()
    np.testing.assert_allclose(target[:, 0], 64.0 - 224.0 * step / 16)


def test_whole_numbers_come_to_rest_as_c_divides() -> None:
    """Towards zero: 7 positions on the way to 0, and -7, lose as much."""
    floor, resting = np.array([[0, 0]]), np.array([[True, True]])
    aim, step = np.repeat([[7, -7]], 20, axis=0), np.minimum(np.arange(1, 21), 16)
    found = raised(aim, np.zeros(20, dtype=int), np.array([20]), step, SIL, floor, resting, parted=np.zeros(2))[0]
    assert found[:4].tolist() == [[7, -7], [7, -7], [6, -6], [6, -6]] and not found[15:].any()


@pytest.mark.parametrize("seed", range(4))
def test_frames_in_contact_are_held_by_their_target_alone(seed: int) -> None:
    """In contact equation 3 has no static mean to be drawn to, and the anchor is what the state holds with, or the
    model's firmness where that is more; all other frames are as without contacts."""
    model = random_model(seed)
    for tables, firm in ((FloatTables(model), model.firm), (ExportedTables(quantise(model, "model")), None)):
        target, contact, ends = aims(tables, streams(9, model.boundary, seed)["ordinary"])
        path = tables.search(target, ends)
        free, held = tables.equation(path, target), tables.equation(path, target, contact)
        hold = free.weight[..., 0] + free.anchor
        assert contact.any() and not contact.all()
        assert not held.weight[contact][:, 0].any() and (held.anchor[contact] >= hold[contact]).all()
        assert (held.anchor[contact] > hold[contact]).any()
        if firm is not None:
            np.testing.assert_array_equal(held.anchor[contact], np.maximum(hold, firm)[contact])
        for name in ("weight", "anchor"):
            np.testing.assert_array_equal(getattr(held, name)[~contact], getattr(free, name)[~contact])
        np.testing.assert_array_equal(held.weight[..., 1:], free.weight[..., 1:])
