"""Which face is the talker's, and heads that are turned too far: made-up tracks, whose truth is known."""

from __future__ import annotations

from typing import List, Optional

import numpy as np
import pytest

from labial.capture.faces import talker
from labial.capture.head import head_angles
from labial.capture.landmarks import USED, Given
from labial.capture.record import record
from labial.corpus.phonesets import SPEECH
from labial.errors import DataError
from test_record import FACE, FRAMES, LAB, seen, talking, write

TIMES = np.arange(100) / 50


def face(x: float, height: float = 100.0, wobble: float = 0.0) -> np.ndarray:
    """(478, 3) landmarks of a face around (x, 200)."""
    points = np.zeros((478, 3), np.float32)
    for number, place in FACE.items():
        points[number] = place
    points[[n for n in range(478) if n not in FACE]] = (0, -28, 20)
    return points * (height / 180) + np.array([x + wobble, 200, 0], np.float32)


def tracked(seen: List[List[np.ndarray]], which: Optional[str] = None) -> np.ndarray:
    """(T,) where the face is that was taken, NaN without one."""
    points = talker("v.mp4", TIMES, seen, which)
    assert points.shape == (100, 478, 3)
    return np.asarray(points[:, 4, 0])


def test_one_face_is_taken_and_its_absence_kept() -> None:
    there = [[face(100 + t)] if not 40 <= t < 50 else [] for t in range(100)]
    places = tracked(there)
    assert np.isnan(places[40:50]).all() and np.isfinite(np.delete(places, range(40, 50))).all()


def test_two_faces_are_an_error_that_names_the_time_and_the_option() -> None:
    """Catches a mouth that changes its owner in the middle of a sentence."""
    two = [[face(100)] + ([face(400)] if t >= 30 else []) for t in range(100)]
    with pytest.raises(DataError, match=r"v.mp4: two faces, the second from 0.60 to 1.98 s: say with --face"):
        tracked(two)


@pytest.mark.parametrize(("which", "place"), [("left", 100), ("right", 400), ("largest", 400)])
def test_the_face_that_was_asked_for_stays_itself(which: str, place: float) -> None:
    """In whatever order the tracker has them, and where one of them is lost for a while."""
    frames = []
    for t in range(100):
        faces = [face(100, 100), face(400, 120)]
        if 20 <= t < 25 or 60 <= t < 95:  # longer than a track lasts
            faces = faces[1:] if place == 100 else faces[:1]
        frames.append(faces[:: 1 if t % 2 else -1])
    places = tracked(frames, which)
    lost = np.isnan(places)
    assert lost[20:25].all() and lost[60:95].all() and lost.sum() == 40
    assert np.allclose(places[~lost], place, atol=1)


def test_background_and_glimpses_are_no_second_face() -> None:
    people = [[face(100), face(400, 40)] + ([face(300)] if t in (3, 4) else []) for t in range(100)]
    assert np.allclose(tracked(people), 100, atol=1)


def test_one_face_found_twice_is_one() -> None:
    assert np.allclose(tracked([[face(100), face(104)] for _ in range(100)]), 100, atol=5)


def test_a_cut_to_somebody_else_is_two_faces() -> None:
    """Catches a voice that is trained on two people."""
    with pytest.raises(DataError, match="two faces"):
        tracked([[face(100 if t < 60 else 400)] for t in range(100)])


def test_no_face_at_all() -> None:
    with pytest.raises(DataError, match="v.mp4: no face is found in any frame"):
        tracked([[] for _ in range(100)])


# ---- Turned heads --------------------------------------------------------------------------------------------------


def shaken(points: np.ndarray, yaw: np.ndarray, pitch: np.ndarray) -> np.ndarray:
    result = np.empty_like(points)
    for t, (a, b) in enumerate(np.radians(np.stack([yaw, pitch], axis=1))):
        about_y = np.array([[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]])
        about_x = np.array([[1, 0, 0], [0, np.cos(b), -np.sin(b)], [0, np.sin(b), np.cos(b)]])
        result[t] = points[t] @ (about_x @ about_y).T
    return result


def test_turns_are_those_of_the_head() -> None:
    """Catches axes that are exchanged: yaw turns x into z, pitch y into z; the face has no pitch of its own."""
    points = seen(np.zeros((3, 13)))
    found = head_angles(shaken(points, np.array([0, 25.0, 0]), np.array([0, 0, -15.0]))[:, list(USED)])
    assert np.allclose(abs(found[:, 0]), [0, 25, 0], atol=0.1) and np.allclose(abs(found[:, 1]), [0, 0, 15], atol=2)


def test_a_glance_aside_is_bridged_and_told_a_long_one_left_out(tmp_path) -> None:
    """Catches lips that are learnt from a profile: frames beyond the limit count as lost, those within do not."""
    points, faps = talking()
    flat = np.zeros(FRAMES)
    aside, away, nodding = flat.copy(), flat.copy(), flat.copy()
    aside[20:26] = 35.0
    away[20:60] = -35.0
    nodding[20:60] = 15.0
    write(tmp_path / "in", "a", LAB, landmarks=shaken(points, aside, nodding))
    write(tmp_path / "in", "b", LAB, landmarks=shaken(points, away, flat))
    with pytest.warns(UserWarning) as caught:
        said = record([tmp_path / "in"], tmp_path / "corpus", SPEECH, Given(), 0.0)
    texts = [str(item.message) for item in caught]
    assert any("a.npz: the head is turned too far from 0.40 to 0.50 s: by up to 3" in text for text in texts)
    assert any("b.npz: left out" in text for text in texts) and "1 left out" in said
    assert [file.name for file in sorted((tmp_path / "corpus").glob("*.csv"))] == ["a.csv"]
