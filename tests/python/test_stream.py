"""Streams begin and end at rest: the reference's way there, worked by hand, and the library's, which is the same; what
a clock and a list of frames show of it. How far the mouth moves: articulation."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, List, Tuple

import numpy as np
import pytest

import labial
from labial.__main__ import main
from labial.files.frames import opening
from labial.reference import fade, published
from labial.reference import stream as steps
from labial.reference.stream import synthesise
from labial.reference.synthesis import delivered as delivered_by
from labial.reference.synthesis import synthesise as by_method
from labial.reference.tables import ExportedTables, FloatTables
from labial.reference.units import frame_counts
from labial.tables.model import load
from labial.tables.phones import drawn_streams, read_stream
from labial.tables.quantise import quantise
from models import lab
from packages import needs_runtime

Timings = List[Tuple[Any, float]]


# ---- The reference


def test_the_ways_by_hand() -> None:
    """Frame j of 8 of a beginning has s = j / 9, frame j of 12 of the way to rest s = j / 12: 3 s^2 - 2 s^3 of it."""
    held, fresh = np.full(13, 100.0), np.full((20, 13), 40.0)
    found = fade.faded(held, np.zeros(13), fresh)
    for j in range(1, 21):
        s = min(j / 9, 1)
        assert np.allclose(found[j - 1], 100 - 60 * (3 * s**2 - 2 * s**3))
    moving = fade.faded(held, np.full(13, 32.0), np.full((3, 13), 132.0))
    assert np.allclose(moving[0], 116 + (132 - 116) * 25 / 729) and moving[2].max() < 132
    closed = fade.faded(held, np.zeros(13), fresh, closing=3)
    lips = [0, 3, 4, 7, 8, 9, 10]
    assert np.allclose(closed[0, lips], 100 - 60 * 7 / 27) and np.allclose(closed[1, lips], 100 - 60 * 20 / 27)
    assert np.allclose(closed[2:, lips], 40) and np.allclose(closed[:, [1, 2, 5, 6, 11, 12]], found[:, :6])
    way = fade.eased(held)
    assert len(way) == 12 and not way[-1].any() and np.allclose(way[5], 50) and np.allclose(way[2], 100 * (1 - 10 / 64))


@pytest.mark.parametrize("opening, touching, closing", [
    (24.4, [0, 1], 9), (24.6, [0, 1], 2), (-90.0, [0], 9), (90.0, [3, 4, 6], 5), (100.0, [6], 8), (100.0, [7], 9),
    (100.0, [8], 9), (100.0, [], 9),
])
def test_a_contact_hurries_lips(opening: float, touching: List[int], closing: int) -> None:
    """Lips that are apart are where the motion is with the second frame of the first contact."""
    held, contact = np.full(13, 50.0), np.zeros(12, dtype=bool)
    held[3], held[4], contact[touching] = 0.0, -opening, True
    assert fade.closing_steps(held, contact) == closing


def test_what_is_delivered_does_not_depend_on_the_parts() -> None:
    """Would catch a fade that begins anew with each part, and an end after each."""
    rng = np.random.default_rng(3)
    motion = rng.normal(0, 100, (40, 13))
    whole = fade.delivered(motion)
    assert len(whole) == 52 and np.array_equal(whole[:40], fade.delivered(motion, exact=True))
    assert np.array_equal(whole[8:40], motion[8:])
    for cuts in ([1, 2, 3, 7, 8, 9], [0, 20, 20, 39], list(range(40))):
        parts = list(fade.delivered_in_parts(np.split(motion, cuts)))
        assert np.array_equal(np.concatenate(parts), whole)
    assert list(fade.delivered_in_parts([])) == []


def test_a_face_at_rest_needs_no_way_there() -> None:
    """If it rounds to the neutral one, in any channel and either direction."""
    pose = np.zeros((1, 13))
    for k, sign in ((0, 1), (12, -1)):
        motion = np.tile(pose, (20, 1))
        motion[-1, k] = 0.46 * sign
        assert len(fade.delivered(motion)) == 20
        motion[-1, k] = 0.54 * sign
        assert len(fade.delivered(motion)) == 32


# ---- The library


@needs_runtime
@pytest.mark.parametrize("seed", [0, 1, *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(2, 6))])
def test_the_library_delivers_what_the_reference_does(seed: int) -> None:
    """All frames of random utterances, which end open, with their beginning and their end: a unit apart at most."""
    model = load("speech_en")
    tables = ExportedTables(quantise(model, "x"))
    for stream in drawn_streams(model, 4, 12, seed):
        found, wanted = np.array(labial.render(stream)), fade.delivered(synthesise(tables, stream))
        assert found.shape == wanted.shape and np.abs(found - np.floor(wanted + 0.5)).max() <= 1


@needs_runtime
def test_no_step_at_an_edge_is_larger_than_those_of_speech() -> None:
    """A servo that follows speech follows the beginnings and the ends, too."""
    speech, edges = [], []
    for stream in drawn_streams(load("speech_en"), 40, 12, 7):
        frames, count = np.array(labial.render(stream)), len(labial.render(stream, exact=True))
        steps = np.abs(np.diff(np.concatenate([np.zeros((1, 13)), frames]), axis=0))
        edges.append(np.concatenate([steps[:9], steps[count:]]).max(axis=0))
        speech.append(steps[9:count].max(axis=0))
    assert len(edges) == 40 and (np.max(edges, axis=0) <= 1.1 * np.max(speech, axis=0)).all()


@needs_runtime
def test_the_clock_shows_a_late_phoneme_on_its_way_to_rest() -> None:
    """Would catch a frame that is shown under a number that is not its own, and an answer that hides that phonemes are
    late. tests/c/test_stream_rest.c has the way itself."""
    answers, starved = [], []
    with labial.Stream() as stream:
        stream.push("AA", 200)
        stream.push("IY", 200)
        for tick in range(100):
            if tick == 50:
                stream.push("M", 200)
                stream.end()
            answers.append(stream.tick())
            starved.append(stream.starved)
    late = starved.index(True)
    assert not any(starved[:late]) and all(starved[late:50]) and not any(starved[50:])
    assert answers[late : late + 5] == [None] * 5 and answers[late + 17 : 50] == [None] * (33 - late)
    missing = answers[late - 1].number + 1
    assert [frame.number for frame in answers[late + 5 : late + 17]] == [missing] * 12
    assert not any(answers[late + 16].faps) and any(answers[late + 15].faps)
    after = [frame for frame in answers[50:] if frame]
    assert [frame.number for frame in after] == list(range(missing, 30 + 12))


@needs_runtime
def test_asking_for_more_frames_than_there_are_moves_nothing() -> None:
    """Iterating and draining follow no clock: however often a program asks, the frames are the same."""
    timings: Timings = [("AA", 200), ("B", 80), ("IY", 200), ("M", 100)]
    with labial.Stream() as stream:
        found: List[Any] = []
        for phoneme, length in timings:
            stream.push(phoneme, length)
            for _ in range(40):
                found += [frame.faps for frame in stream]
                assert len(stream.drain()) == 0
        stream.end()
        found += [frame.faps for frame in stream]
    assert found == labial.render(timings)


# ---- Commands


def test_synth_ends_at_rest_unless_told_otherwise(tmp_path: Any) -> None:
    """And the number of frames that some formats tell first is the one that follows."""
    model = load("speech_en")
    hello = [("HH", 70), ("AH", 60), ("L", 80), ("OW", 230)]
    (tmp_path / "a.lab").write_text(lab(hello))
    numbers = [(model.phonemes.index(label), length) for label, length in hello]
    for option, exact in (([], False), (["--exact"], True)):
        assert main(["synth", "speech_en", str(tmp_path / "a.lab"), "-o", str(tmp_path / "a.csv"), *option]) == 0
        rows = np.loadtxt(tmp_path / "a.csv", delimiter=",", skiprows=1)
        assert np.allclose(rows[:, 1:], np.concatenate(list(delivered_by(model, numbers, exact=exact))), atol=0.00501)
        assert main(["synth", "speech_en", str(tmp_path / "a.lab"), "--to", "fap", "-o", str(tmp_path / "a.fap"),
                     *option]) == 0
        head, *lines = (tmp_path / "a.fap").read_text().splitlines()
        assert head.split()[-1] == str(len(rows)) == str(len(lines) // 2) == str(22 if exact else 34)


# ---- Articulation ----------------------------------------------------------------------------------------------------


#: Follows from the corners by a table, and so is not in proportion.
FAP_17 = 2
#: From so many FAP units of opening on lips look parted (docs/experiments.md).
PARTED = 80
Pairs = List[Tuple[int, int]]


@pytest.fixture(scope="module")
def voice() -> ExportedTables:
    return ExportedTables(quantise(load("speech_en"), "x"))


@pytest.fixture(scope="module")
def said(tmp_path_factory: pytest.TempPathFactory) -> List[Pairs]:
    """Phonemes of eight sentences."""
    path = tmp_path_factory.mktemp("said") / "line.flite"
    lines = Path(__file__).with_name("sentences.flite").read_text(encoding="ascii").splitlines()
    found = []
    for line in lines[:8]:
        path.write_text(line + "\n", encoding="ascii")
        found.append(read_stream(str(path), load("speech_en")))
    return found


def closures(tables: ExportedTables, phonemes: Pairs, motion: np.ndarray) -> List[float]:
    """The least opening in each p, b, m and a frame to either side."""
    ends = np.cumsum(frame_counts([length for _, length in phonemes], tables.fps))
    lips = {tables.phonemes.index(label) for label in "PBM"}
    return [opening(motion)[max(begin - 1, 0) : end + 1].min()
            for (phoneme, _), begin, end in zip(phonemes, [0, *ends], ends) if phoneme in lips and end > begin]


@pytest.mark.parametrize("percent", [0, 50, 80, 100])
def test_up_to_100_all_motion_is_in_proportion(voice: ExportedTables, said: List[Pairs], percent: int) -> None:
    gain = np.floor(2.56 * percent + 0.5) / 256.0
    for phonemes in said[:2]:
        whole = steps.synthesise(voice, phonemes)
        apart = np.abs(steps.synthesise(voice, phonemes, articulation=percent) - gain * whole)
        assert np.delete(apart, FAP_17, axis=1).max() < 1e-9


@pytest.mark.parametrize("percent, least, most", [(130, 1.25, 1.4), (200, 1.9, 2.25)])
def test_beyond_100_the_mouth_goes_farther_and_still_closes(
    voice: ExportedTables, said: List[Pairs], percent: int, least: float, most: float
) -> None:
    """What is beside contact is a little farther from it in proportion; what has none is in proportion."""
    plain = [steps.synthesise(voice, phonemes) for phonemes in said]
    wide = [steps.synthesise(voice, phonemes, articulation=percent) for phonemes in said]
    ratio = np.concatenate([opening(one) for one in wide]).std() / np.concatenate([opening(one) for one in plain]).std()
    assert least < ratio < most
    gain = np.floor(2.56 * percent + 0.5) / 256.0
    without = [0, 1, 5, 6, 11, 12]  # channels that make no contact: jaw, lower lip's protrusion, corners
    assert max(np.abs(one - gain * other)[:, without].max() for one, other in zip(wide, plain)) < 1e-9
    found = [value for phonemes, one in zip(said, wide) for value in closures(voice, phonemes, one)]
    assert len(found) > 30 and max(found) <= PARTED
    assert max(value for phonemes, one in zip(said, plain)
               for value in closures(voice, phonemes, gain * one)) > max(found)  # which scaling alone opens farther


@pytest.mark.parametrize("before, after", [(50, 130), (130, 50), (100, 50)])
def test_a_change_is_no_jolt(voice: ExportedTables, said: List[Pairs], before: int, after: int) -> None:
    """The third differences around a change, against the largest ones where the larger articulation holds throughout;
    without a step from frame to frame they are up to three times as large."""
    worst = 0.0
    for phonemes in said[:2]:
        loud = steps.synthesise(voice, phonemes, articulation=max(before, after))
        limit = np.abs(np.diff(loud, 3, axis=0)).max(axis=0)
        for at in range(25, len(loud) - 20, 40):
            told = np.where(np.arange(len(loud)) < at, before, after)
            motion = steps.synthesise(voice, phonemes, articulation=told)
            jolt = np.abs(np.diff(motion, 3, axis=0)).max(axis=0) / limit
            worst = max(worst, np.delete(jolt, FAP_17).max())
    assert worst < 1.5


def test_parts_and_the_published_method_have_it_as_well(said: List[Pairs]) -> None:
    model = load("speech_en")
    tables = FloatTables(model)
    whole = steps.synthesise(tables, said[0], articulation=130)
    assert np.array_equal(np.concatenate(list(steps.in_parts(tables, said[0], 50, 130))), whole)
    assert np.array_equal(by_method(model, said[0], articulation=130), whole)
    plain = published.synthesise(tables, said[0])
    assert np.allclose(by_method(replace(model, method="paper"), said[0], articulation=50), 0.5 * plain)
